#include "ostraka/select/colour_edges.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/core/memory.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/chains.h"
#include "ostraka/measure/descriptors.h"
#include "ostraka/measure/surface_colour.h"
#include "select/texel_grid.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr double thinning = 0.1;  ///< largest distance of a point that is left out, as a share of the spacing

/// Where the colour changes most, at each node: size and direction of the gradient.
struct Gradients {
    std::vector<float> size;  ///< per spacing
    std::vector<Vector3f> direction;
    std::vector<float> slope;  ///< derivative of the size along the direction
};

/// Gradients of functions on the nodes, by least squares over the neighbours, in the plane that fits these best.
class NodeGradients {
public:
    explicit NodeGradients(const TexelGrid& grid) : grid_(grid), place_(grid.size()) {
        const CGAL::Bbox_3 box = bounding_box(grid.mesh());
        const Point centre((box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2, (box.zmin() + box.zmax()) / 2);
        std::vector<Index> numbers;
        for (const Face face : grid.mesh().faces()) {
            grid.nodes_of(face, numbers);
            const auto corner = corners(grid.mesh(), face);
            const auto& nodes = grid.division(face).nodes;
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                Vector sum = CGAL::NULL_VECTOR;
                for (std::size_t k = 0; k < 3; ++k) sum = sum + nodes[i].weights[k] * (grid.mesh().point(corner[k]) - centre);
                sum = sum / grid.spacing();  // in units of the spacing: sizes near 1
                place_[numbers[i]] = {static_cast<float>(sum.x()), static_cast<float>(sum.y()), static_cast<float>(sum.z())};
            }
        }
    }

    [[nodiscard]] const Vector3f& place(std::size_t node) const { return place_[node]; }

    /// Gradients of three functions as rows; `read(node)`: their values.
    template <class Read>
    [[nodiscard]] Matrix3f at(std::size_t node, const Read& read) const {
        Matrix3f spread = Matrix3f::Zero(), product = Matrix3f::Zero();
        const auto [begin, end] = grid_.neighbours(node);
        const Vector3f here = read(node);
        for (const Index* next = begin; next != end; ++next) {
            const Vector3f d = place_[*next] - place_[node];
            spread += d * d.transpose();
            product += (read(*next) - here) * d.transpose();
        }
        Eigen::SelfAdjointEigenSolver<Matrix3f> solver;
        solver.computeDirect(spread);
        Matrix3f inverse = Matrix3f::Zero();
        const float largest = solver.eigenvalues()[2];
        for (const int k : {1, 2})
            if (solver.eigenvalues()[k] > 1e-4F * largest && largest > 0)
                inverse += solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose() / solver.eigenvalues()[k];
        return product * inverse;
    }

private:
    const TexelGrid& grid_;
    std::vector<Vector3f> place_;
};

Gradients gradients_of(const TexelGrid& grid, const NodeGradients& tangent, const std::vector<LabNode>& lab, float least) {
    Gradients result;
    result.size.assign(grid.size(), 0);
    result.direction.assign(grid.size(), Vector3f::Zero());
    result.slope.assign(grid.size(), 0);
    parallel_for(grid.size(), 1024, [&](std::size_t i) {
        const Matrix3f g = tangent.at(i, [&](std::size_t node) { return Vector3f(lab[node][0], lab[node][1], lab[node][2]); });
        if (!(g.squaredNorm() > least * least / 4)) return;
        Eigen::SelfAdjointEigenSolver<Matrix3f> solver;
        solver.computeDirect(g.transpose() * g);
        result.size[i] = std::sqrt(std::max(0.0F, solver.eigenvalues()[2]));
        result.direction[i] = solver.eigenvectors().col(2);
    });
    parallel_for(grid.size(), 1024, [&](std::size_t i) {
        if (!(result.size[i] > least / 2)) return;
        const Matrix3f g = tangent.at(i, [&](std::size_t node) { return Vector3f(result.size[node], 0, 0); });
        result.slope[i] = g.row(0).dot(result.direction[i]);
    });
    return result;
}

/// A crossing of a line with an edge of the grid.
struct LineCrossing {
    Index low, high;  ///< nodes of the edge
    SurfacePoint place;
    float size;  ///< of the gradient
    bool operator<(const LineCrossing& other) const { return std::tie(low, high) < std::tie(other.low, other.high); }
};

/// Traces the lines on which the size of the gradient is largest along its direction.
class EdgeTracer {
public:
    EdgeTracer(const TexelGrid& grid, const NodeGradients& tangent, const Gradients& gradients, float least)
        : grid_(grid), tangent_(tangent), gradients_(gradients), least_(least) {}

    /// The pieces in the triangles, each as two crossings.
    [[nodiscard]] std::vector<std::array<LineCrossing, 2>> pieces() const {
        const std::size_t count = grid_.mesh().number_of_faces(), block = 1024;
        std::vector<std::vector<std::array<LineCrossing, 2>>> parts((count + block - 1) / block);
        parallel_blocks(count, block, [&](std::size_t begin, std::size_t end) {
            std::vector<Index> numbers;
            for (std::size_t f = begin; f < end; ++f) {
                const Face face(static_cast<Index>(f));
                grid_.nodes_of(face, numbers);
                for (const auto& triangle : grid_.division(face).triangles) add(face, triangle, numbers, parts[begin / block]);
            }
        });
        std::vector<std::array<LineCrossing, 2>> all;
        for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
        return all;
    }

private:
    void add(Face face, const std::array<Index, 3>& triangle, const std::vector<Index>& numbers,
             std::vector<std::array<LineCrossing, 2>>& found) const {
        for (const Index node : triangle)
            if (!(gradients_.size[numbers[node]] > least_ / 2)) return;
        std::vector<LineCrossing> crossings;
        for (std::size_t k = 0; k < 3; ++k) {
            Index a = triangle[k], b = triangle[(k + 1) % 3];
            if (numbers[a] > numbers[b]) std::swap(a, b);
            const Index i = numbers[a], j = numbers[b];
            // Slopes along the direction at node i; the sign of a direction is arbitrary.
            const float turn = gradients_.direction[i].dot(gradients_.direction[j]) < 0 ? -1.0F : 1.0F;
            const float from = gradients_.slope[i], to = turn * gradients_.slope[j];
            if ((from > 0) == (to > 0)) continue;
            const Vector3f along = tangent_.place(j) - tangent_.place(i);
            if (!((to - from) * along.dot(gradients_.direction[i] + turn * gradients_.direction[j]) < 0)) continue;
            const double share = std::clamp(static_cast<double>(from) / (static_cast<double>(from) - static_cast<double>(to)),
                                            nearest_to_node, 1 - nearest_to_node);
            const auto s = static_cast<float>(share);
            crossings.push_back(
                {i, j, grid_.between(face, a, b, numbers, share), (1 - s) * gradients_.size[i] + s * gradients_.size[j]});
        }
        if (crossings.size() == 2 && crossings[0].size > least_ && crossings[1].size > least_)
            found.push_back({crossings[0], crossings[1]});
    }

    const TexelGrid& grid_;
    const NodeGradients& tangent_;
    const Gradients& gradients_;
    float least_;
};

/// Leaves out points inside a face that lie within `distance` of the line through the others (Douglas and Peucker 1973).
void thin(const std::vector<Point>& places, std::size_t begin, std::size_t end, double distance, std::vector<bool>& kept) {
    kept[begin] = kept[end] = true;
    std::size_t farthest = begin;
    double most = distance;
    const Vector along = places[end] - places[begin];
    const double length = std::sqrt(along.squared_length());
    for (std::size_t i = begin + 1; i < end; ++i) {
        const Vector d = places[i] - places[begin];
        const double away =
            length > 0 ? std::sqrt(CGAL::cross_product(d, along).squared_length()) / length : std::sqrt(d.squared_length());
        if (away > most) most = away, farthest = i;
    }
    if (farthest == begin) return;
    thin(places, begin, farthest, distance, kept);
    thin(places, farthest, end, distance, kept);
}

std::vector<SurfacePoint> thinned(const Mesh& mesh, const std::vector<SurfacePoint>& line, double distance) {
    const std::vector<Point> places = positions(mesh, line);
    std::vector<bool> kept(line.size(), false);
    kept.front() = kept.back() = true;
    for (std::size_t begin = 0; begin + 1 < line.size();) {
        std::size_t end = begin + 1;
        while (end + 1 < line.size() && line[end].is_in_face()) ++end;
        if (line[begin] == line[end]) {  // a loop inside a face
            const std::size_t middle = begin + (end - begin) / 2;
            thin(places, begin, middle, distance, kept);
            thin(places, middle, end, distance, kept);
        } else {
            thin(places, begin, end, distance, kept);
        }
        begin = end;
    }
    std::vector<SurfacePoint> result;
    for (std::size_t i = 0; i < line.size(); ++i)
        if (kept[i]) result.push_back(line[i]);
    return result;
}

}  // namespace

std::vector<ColourEdge> find_colour_edges(const Mesh& mesh, const MeshExtras& extras, const ColourEdgeOptions& options,
                                          const std::string& where) {
    if (!(options.min_contrast > 0) || !(options.texels >= 0 && options.texels <= 20) || !(options.shortest >= 0))
        fail_usage("options of colour edges out of range", "give a contrast above 0 and a smoothing of 0 to 20 texels");
    if (options.min_contrast > options.contrast)
        fail_usage("lines end at a larger contrast (--min-contrast) than they must reach (--contrast)",
                   "let --min-contrast be at most --contrast");
    if (!has_colours(extras))
        fail_input(where, "the mesh has neither an image nor colours", "give the file with its image or colours");
    if (mesh.number_of_faces() == 0) return {};
    TexelColours colours(mesh, extras, where);
    const TexelGrid& grid = colours.grid;
    require_memory(40.0 * static_cast<double>(grid.size()), "gradients of the image", "reduce the image");
    // A round of smoothing has the variance of a quarter of the squared spacing in each direction.
    const int rounds = static_cast<int>(std::lround(4 * options.texels * options.texels));
    const double width =
        std::sqrt(2 * std::acos(-1.0) * (rounds / 4.0 + 1.0 / 3));  // largest gradient of a step of one: 1 / width
    grid.blur(colours.lab, rounds);
    const NodeGradients tangent(grid);
    const auto least = static_cast<float>(options.min_contrast / width);
    const Gradients gradients = gradients_of(grid, tangent, colours.lab, least);
    const auto pieces = EdgeTracer(grid, tangent, gradients, least).pieces();
    std::vector<LineCrossing> crossings;
    for (const auto& piece : pieces) crossings.insert(crossings.end(), piece.begin(), piece.end());
    const auto same = [](const LineCrossing& a, const LineCrossing& b) { return a.low == b.low && a.high == b.high; };
    std::sort(crossings.begin(), crossings.end());
    crossings.erase(std::unique(crossings.begin(), crossings.end(), same), crossings.end());
    std::vector<std::array<std::size_t, 2>> segments;
    for (const auto& piece : pieces) {
        std::array<std::size_t, 2> ends{};
        for (std::size_t k = 0; k < 2; ++k)
            ends[k] =
                static_cast<std::size_t>(std::lower_bound(crossings.begin(), crossings.end(), piece[k]) - crossings.begin());
        segments.push_back(ends);
    }
    std::vector<ColourEdge> edges;
    const double shortest = options.shortest * box_diagonal(mesh);
    for (const auto& chain : chains_of(segments)) {
        ColourEdge edge;
        double strongest = 0, sum = 0;
        std::vector<SurfacePoint> line;
        for (const std::size_t i : chain) {
            line.push_back(crossings[i].place);
            strongest = std::max(strongest, width * static_cast<double>(crossings[i].size));
            sum += width * static_cast<double>(crossings[i].size);
        }
        if (strongest < options.contrast) continue;
        line.erase(std::unique(line.begin(), line.end()), line.end());
        if (line.size() < 2) continue;
        edge.closed = chain.size() > 3 && chain.front() == chain.back();
        edge.line = thinned(mesh, line, thinning * grid.spacing());
        if (edge.closed && edge.line.size() < 4) edge.line = line;
        const std::vector<Point> places = positions(mesh, edge.line);
        for (std::size_t i = 0; i + 1 < places.size(); ++i)
            edge.length += std::sqrt(CGAL::squared_distance(places[i], places[i + 1]));
        if (edge.length < shortest) continue;
        edge.contrast = sum / static_cast<double>(chain.size());
        edges.push_back(std::move(edge));
    }
    std::stable_sort(edges.begin(), edges.end(),
                     [](const ColourEdge& a, const ColourEdge& b) { return a.length * a.contrast > b.length * b.contrast; });
    return edges;
}

AnnotationSet annotate_colour_edges(const Mesh& mesh, const std::vector<ColourEdge>& edges, const std::string& unit) {
    static constexpr std::array<std::array<int, 3>, 6> tones{
        {{213, 94, 0}, {0, 114, 178}, {230, 159, 0}, {0, 140, 110}, {153, 27, 30}, {86, 180, 233}}};
    AnnotationSet set;
    set.unit = unit;
    for (const ColourEdge& edge : edges) {
        Annotation annotation;
        const std::size_t number = set.annotations.size();
        annotation.id = static_cast<int>(number);
        annotation.tag = "colour edge " + std::to_string(number + 1);
        annotation.colour = tones[number % tones.size()];
        annotation.type = AnnotationType::line;
        annotation.curves = {edge.line};
        compute_elements(mesh, annotation);
        store(annotation, {{"length", {edge.length}, false, 1, {}}, {"contrast", {edge.contrast}, false, 0, {}}}, unit);
        set.annotations.push_back(std::move(annotation));
    }
    return set;
}

}  // namespace ostraka
