// Local barycentric coordinates (Zhang, Deng, Liu, Patanè, Bouaziz, Hormann and Liu 2014): the weights of minimum total
// variation among all weights that are non-negative, sum to one, reproduce their point and are linear on the cage.
#include "coords/interior_weights.h"
#include "coords/kinds.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

namespace ostraka::coords {

namespace {

/// Largest number of cage vertices that may have a weight at a node: those of largest harmonic weight.
constexpr std::size_t max_candidates = 32;

/// State of the iteration for one cage vertex: the nodes where its weight may be non-zero, and their values.
struct Column {
    std::vector<Index> nodes;           ///< nodes in the interior, ascending
    std::vector<double> w, z, y, last;  ///< the weight, its copy that satisfies the constraints, the scaled dual; the last copy
    std::vector<Index> cells;           ///< tetrahedra that touch one of the nodes
    std::vector<std::array<int, 4>> place;  ///< index of their corners in `nodes`; -1: fixed
    std::vector<Vector3d> fixed;            ///< gradient of the fixed corners
    std::vector<Vector3d> x, u;             ///< copy of the gradient, and its scaled dual
    std::vector<double> variation;          ///< factor of the gradient's length in the total variation
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor;
    std::vector<double> coupling;  ///< coupling of the nodes with fixed values
    double change = 0, gap = 0;    ///< sums of squares: last change of the copies, and difference between weights and copies
    double total = 0;              ///< weighted total variation
};

/// Lengths of the shortest paths from a node along the edges of the tetrahedra, divided by the largest.
std::vector<double> distances_from(const std::vector<std::vector<std::pair<Index, double>>>& edges, Index start) {
    std::vector<double> distance(edges.size(), std::numeric_limits<double>::infinity());
    std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, std::greater<>> queue;
    queue.emplace(distance[start] = 0, start);
    CancelCheck check;
    while (!queue.empty()) {
        check();
        const auto [path_length, v] = queue.top();
        queue.pop();
        if (path_length > distance[v]) continue;
        for (const auto& [other, length] : edges[v])
            if (path_length + length < distance[other]) queue.emplace(distance[other] = path_length + length, other);
    }
    double largest = 0;
    for (const double d : distance)
        if (std::isfinite(d)) largest = std::max(largest, d);
    for (double& d : distance) d = largest > 0 ? std::min(d / largest, 1.0) : 0;
    return distance;
}

std::vector<std::vector<std::pair<Index, double>>> edges_of(const CageInterior& inside) {
    std::vector<std::vector<std::pair<Index, double>>> edges(inside.nodes().size());
    for (const auto& cell : inside.cells())
        for (const Index a : cell)
            for (const Index b : cell)
                if (a != b) edges[a].emplace_back(b, (inside.nodes()[a] - inside.nodes()[b]).norm());
    for (auto& neighbours : edges) {
        std::sort(neighbours.begin(), neighbours.end());
        neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    }
    return edges;
}

/// The candidates of an interior node: the columns in which it has a weight, and its index in them.
struct NodeRow {
    std::vector<Index> column;
    std::vector<std::size_t> index_in_column;
};

class LocalWeights {
public:
    LocalWeights(const CageInterior& inside, const UnitCage& cage)
        : inside_(inside), cage_(cage), gradients_(gradients_of(inside)), weights_(harmonic_weights(inside, cage)) {
        choose_candidates();
        set_up();
    }

    /// Alternating direction method of multipliers (Boyd et al. 2011); stops when the total variation changes by at most the
    /// share `tolerance` in ten steps.
    void iterate(int max_steps, double tolerance) {
        constexpr int check_interval = 10;
        Progress progress("local coordinates", static_cast<std::size_t>(max_steps));
        double previous_variation = std::numeric_limits<double>::infinity();
        for (int step = 1; step <= max_steps; ++step) {
            parallel_for(columns_.size(), 1, [&](std::size_t i) { update_column(columns_[i]); });
            parallel_for(inner_.size(), 64, [&](std::size_t k) { update_node(k); });
            progress.advance();
            if (step % check_interval != 0) continue;
            double gap = 0, change = 0, variation = 0;
            for (const Column& column : columns_) gap += column.gap, change += column.change, variation += column.total;
            if (std::abs(previous_variation - variation) <= tolerance * variation) break;
            previous_variation = variation;
            // With a suitable penalty both residuals fall at the same rate (Boyd et al., 3.4.1).
            if (step > max_steps / 2) continue;
            if (gap > 100 * change) scale_penalty(2);
            else if (change > 100 * gap) scale_penalty(0.5);
        }
        // The result: the smooth weights, projected to the constraints.
        parallel_for(inner_.size(), 64, [&](std::size_t k) { project_node(k); });
        for (std::size_t c = 0; c < columns_.size(); ++c)
            for (std::size_t k = 0; k < columns_[c].nodes.size(); ++k)
                weights_(static_cast<Eigen::Index>(columns_[c].nodes[k]), static_cast<Eigen::Index>(c)) = columns_[c].z[k];
    }
    [[nodiscard]] const WeightMatrix& weights() const { return weights_; }

private:
    static double square(double x) { return x * x; }

    /// Selects for each node the cage vertices of largest harmonic weight that can reproduce its position.
    void choose_candidates() {
        columns_ = std::vector<Column>(cage_.corners.size());
        for (Index v = 0; v < inside_.nodes().size(); ++v)
            if (inside_.is_within(v)) inner_.push_back(v);
        rows_.resize(inner_.size());
        std::vector<std::vector<double>> start(inner_.size());
        parallel_for(inner_.size(), 64, [&](std::size_t k) {
            const double* row = weights_.row(static_cast<Eigen::Index>(inner_[k])).data();
            std::vector<Index> order(cage_.corners.size());
            std::iota(order.begin(), order.end(), Index{0});
            for (std::size_t count = max_candidates;; count *= 2) {
                count = std::min(count, order.size());
                std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                                  [&](Index a, Index b) { return row[a] != row[b] ? row[a] > row[b] : a < b; });
                rows_[k].column.assign(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
                std::sort(rows_[k].column.begin(), rows_[k].column.end());
                start[k].clear();
                std::vector<Vector3d> corners;
                for (const Index c : rows_[k].column) {
                    start[k].push_back(std::max(row[c], 0.0));
                    corners.push_back(cage_.corners[c]);
                }
                if (project_row(start[k], corners, inside_.nodes()[inner_[k]]) || count == order.size()) break;
            }
        });
        for (std::size_t k = 0; k < inner_.size(); ++k)
            for (std::size_t j = 0; j < rows_[k].column.size(); ++j) {
                Column& column = columns_[rows_[k].column[j]];
                rows_[k].index_in_column.push_back(column.nodes.size());
                column.nodes.push_back(inner_[k]);
                column.z.push_back(start[k][j]);
            }
        for (const Index v : inner_) weights_.row(static_cast<Eigen::Index>(v)).setZero();
    }

    void set_up() {
        std::vector<std::vector<Index>> cells_of(inside_.nodes().size());
        for (Index t = 0; t < inside_.cells().size(); ++t)
            for (const Index v : inside_.cells()[t]) cells_of[v].push_back(t);
        const auto edges = edges_of(inside_);
        mass_.assign(inside_.nodes().size(), 0);
        double edge = 0;
        std::size_t edge_count = 0;
        for (std::size_t t = 0; t < inside_.cells().size(); ++t)
            for (const Index v : inside_.cells()[t]) mass_[v] += gradients_.volume[t] / 4;
        for (const auto& neighbours : edges)
            for (const auto& [other, length] : neighbours) edge += length, ++edge_count;
        edge /= static_cast<double>(std::max<std::size_t>(edge_count, 1));
        stiffness_ = 1 / square(3 * edge);
        // A weight falls from one to zero over about the length of a cage edge.
        double cage_edge_length = 0;
        for (const Edge e : cage_.mesh.edges())
            cage_edge_length += (cage_.corners[cage_.mesh.vertex(e, 0)] - cage_.corners[cage_.mesh.vertex(e, 1)]).norm();
        cage_edge_length /= static_cast<double>(cage_.mesh.number_of_edges());
        step_ = 0.1 / cage_edge_length;
        parallel_for(columns_.size(), 1, [&](std::size_t i) { set_up_column(i, cells_of, edges); });
    }

    /// The node at a corner of the cage.
    [[nodiscard]] Index node_at(std::size_t corner) const {
        Index best = 0;
        double minimum = std::numeric_limits<double>::infinity();
        for (Index v = 0; v < inside_.nodes().size(); ++v)
            if (const double d = (inside_.nodes()[v] - cage_.corners[corner]).squaredNorm(); d < minimum) minimum = d, best = v;
        return best;
    }

    void set_up_column(std::size_t i, const std::vector<std::vector<Index>>& cells_of,
                       const std::vector<std::vector<std::pair<Index, double>>>& edges) {
        Column& column = columns_[i];
        const std::size_t n = column.nodes.size();
        column.w = column.z;
        column.y.assign(n, 0);
        column.last = column.z;
        if (n == 0) return;
        const std::vector<double> distance = distances_from(edges, node_at(i));
        const auto place_of = [&](Index v) {
            const auto node = std::lower_bound(column.nodes.begin(), column.nodes.end(), v);
            return node != column.nodes.end() && *node == v ? static_cast<int>(node - column.nodes.begin()) : -1;
        };
        for (const Index v : column.nodes) column.cells.insert(column.cells.end(), cells_of[v].begin(), cells_of[v].end());
        std::sort(column.cells.begin(), column.cells.end());
        column.cells.erase(std::unique(column.cells.begin(), column.cells.end()), column.cells.end());
        column.coupling.assign(n, 0);
        std::vector<Eigen::Triplet<double>> entries;
        for (const Index t : column.cells) {
            const auto& cell = inside_.cells()[t];
            const auto& gradient = gradients_.of_corner[t];
            std::array<int, 4> place{};
            Vector3d fixed = Vector3d::Zero();
            double mean_distance = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                place[k] = place_of(cell[k]);
                mean_distance += distance[cell[k]] / 4;
                if (place[k] < 0)
                    fixed += weights_(static_cast<Eigen::Index>(cell[k]), static_cast<Eigen::Index>(i)) * gradient[k];
            }
            for (std::size_t a = 0; a < 4; ++a) {
                if (place[a] < 0) continue;
                column.coupling[static_cast<std::size_t>(place[a])] += gradients_.volume[t] * gradient[a].dot(fixed);
                for (std::size_t b = 0; b < 4; ++b)
                    if (place[b] >= 0 && place[a] >= place[b])
                        entries.emplace_back(place[a], place[b], gradients_.volume[t] * gradient[a].dot(gradient[b]));
            }
            column.place.push_back(place);
            column.fixed.push_back(fixed);
            column.variation.push_back(mean_distance);
        }
        for (std::size_t k = 0; k < n; ++k)
            entries.emplace_back(static_cast<int>(k), static_cast<int>(k), stiffness_ * mass_[column.nodes[k]]);
        Eigen::SparseMatrix<double> matrix(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
        matrix.setFromTriplets(entries.begin(), entries.end());
        column.factor.compute(matrix);
        if (column.factor.info() != Eigen::Success)
            throw Error(ErrorKind::failure, "cage", "the local coordinates cannot be computed on the tetrahedra inside it",
                        "choose another number of nodes, or use mean-value coordinates");
        column.u.assign(column.cells.size(), Vector3d::Zero());
        for (std::size_t c = 0; c < column.cells.size(); ++c) column.x.push_back(gradient_in(column, c));
    }

    [[nodiscard]] Vector3d gradient_in(const Column& column, std::size_t c) const {
        Vector3d g = column.fixed[c];
        for (std::size_t k = 0; k < 4; ++k)
            if (column.place[c][k] >= 0)
                g += column.w[static_cast<std::size_t>(column.place[c][k])] * gradients_.of_corner[column.cells[c]][k];
        return g;
    }

    void update_column(Column& column) const {
        const std::size_t n = column.nodes.size();
        if (n == 0) return;
        column.gap = column.change = column.total = 0;
        for (std::size_t k = 0; k < n; ++k) {
            column.gap += square(column.w[k] - column.z[k]);
            column.change += square(column.z[k] - column.last[k]);
        }
        column.last = column.z;
        Eigen::VectorXd right_hand_side(static_cast<Eigen::Index>(n));
        for (std::size_t k = 0; k < n; ++k)
            right_hand_side[static_cast<Eigen::Index>(k)] =
                stiffness_ * mass_[column.nodes[k]] * (column.z[k] - column.y[k]) - column.coupling[k];
        for (std::size_t c = 0; c < column.cells.size(); ++c) {
            const Vector3d target = gradients_.volume[column.cells[c]] * (column.x[c] - column.u[c]);
            for (std::size_t k = 0; k < 4; ++k)
                if (column.place[c][k] >= 0)
                    right_hand_side[column.place[c][k]] += gradients_.of_corner[column.cells[c]][k].dot(target);
        }
        const Eigen::VectorXd solution = column.factor.solve(right_hand_side);
        std::copy(solution.data(), solution.data() + solution.size(), column.w.begin());
        for (std::size_t c = 0; c < column.cells.size(); ++c) {
            const Vector3d gradient = gradient_in(column, c), g = gradient + column.u[c];
            column.total += column.variation[c] * gradients_.volume[column.cells[c]] * gradient.norm();
            const double length = g.norm(), threshold = step_ * column.variation[c];
            column.x[c] = length > threshold ? Vector3d((1 - threshold / length) * g) : Vector3d(Vector3d::Zero());
            column.u[c] = g - column.x[c];
        }
    }

    void update_node(std::size_t k) {
        const NodeRow& row = rows_[k];
        std::vector<double> target(row.column.size());
        for (std::size_t j = 0; j < target.size(); ++j) {
            const Column& column = columns_[row.column[j]];
            target[j] = column.w[row.index_in_column[j]] + column.y[row.index_in_column[j]];
        }
        const std::vector<double> projected = projected_weights(k, target);
        for (std::size_t j = 0; j < target.size(); ++j) {
            Column& column = columns_[row.column[j]];
            column.z[row.index_in_column[j]] = projected[j];
            column.y[row.index_in_column[j]] = target[j] - projected[j];
        }
    }

    void project_node(std::size_t k) {
        const NodeRow& row = rows_[k];
        std::vector<double> target(row.column.size());
        for (std::size_t j = 0; j < target.size(); ++j) target[j] = columns_[row.column[j]].w[row.index_in_column[j]];
        const std::vector<double> projected = projected_weights(k, target);
        for (std::size_t j = 0; j < projected.size(); ++j) columns_[row.column[j]].z[row.index_in_column[j]] = projected[j];
    }

    /// The weights of a node projected to the constraints; its current copies if the projection fails.
    [[nodiscard]] std::vector<double> projected_weights(std::size_t k, std::vector<double> weights) const {
        const NodeRow& row = rows_[k];
        std::vector<Vector3d> corners(row.column.size());
        for (std::size_t j = 0; j < corners.size(); ++j) corners[j] = cage_.corners[row.column[j]];
        if (!project_row(weights, corners, inside_.nodes()[inner_[k]]))
            for (std::size_t j = 0; j < weights.size(); ++j) weights[j] = columns_[row.column[j]].z[row.index_in_column[j]];
        return weights;
    }

    /// Multiplies the penalty by a factor, with the scaled duals and the shrinkage of the gradients.
    void scale_penalty(double factor) {
        step_ /= factor;
        for (Column& column : columns_) {
            for (double& y : column.y) y /= factor;
            for (Vector3d& u : column.u) u /= factor;
        }
    }

    const CageInterior& inside_;
    const UnitCage& cage_;
    CellGradients gradients_;
    WeightMatrix weights_;
    std::vector<Column> columns_;
    std::vector<Index> inner_;
    std::vector<NodeRow> rows_;
    std::vector<double> mass_;
    double stiffness_ = 1;  ///< penalty of the copies relative to that of the gradients: an inverse squared length
    double step_ = 1;       ///< inverse of the penalty
};

}  // namespace

Coordinates local(const Mesh& mesh, const std::vector<Point>& points, const CoordinateOptions& options) {
    return interior_coordinates("local", mesh, points, options, [&](const CageInterior& inside, const UnitCage& cage) {
        LocalWeights minimiser(inside, cage);
        minimiser.iterate(options.iterations, options.tolerance);
        return minimiser.weights();
    });
}

}  // namespace ostraka::coords
