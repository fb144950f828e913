#include "coords/bounded_rows.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"

#include <fmt/core.h>
#include <Eigen/Cholesky>

#include <algorithm>

namespace ostraka::coords {

using Eigen::Matrix4d;
using Eigen::Vector4d;

namespace {

/// Points closer than this share of the diagonal lie on the cage: the closest point is not more exact than that.
constexpr double min_snap = 1e-13;

struct DualState {
    Vector4d residual;
    Matrix4d hessian;
    double value = 0;
};

Vector4d row_of(const Vector3d& corner, const Vector3d& place) {
    const Vector3d d = corner - place;
    return {1, d.x(), d.y(), d.z()};
}

DualState dual_at(std::span<const double> weights, std::span<const Vector3d> corners, const Vector3d& place, const Vector4d& mu) {
    DualState state;
    state.residual = Vector4d(-1, 0, 0, 0);
    state.hessian.setZero();
    state.value = -mu[0];
    for (std::size_t j = 0; j < weights.size(); ++j) {
        const Vector4d a = row_of(corners[j], place);
        const double w = weights[j] + a.dot(mu);
        if (w <= 0) continue;
        state.residual += w * a;
        state.hessian += a * a.transpose();
        state.value += 0.5 * w * w;
    }
    return state;
}

}  // namespace

bool project_row(std::span<double> weights, std::span<const Vector3d> corners, const Vector3d& place) {
    constexpr int max_steps = 60;
    constexpr double converged = 4e-15, acceptable = 1e-12;
    Vector4d mu = Vector4d::Zero();
    DualState state = dual_at(weights, corners, place, mu);
    double error = state.residual.lpNorm<Eigen::Infinity>();
    for (int step = 0; step < max_steps && error > converged; ++step) {
        const double damping = 1e-15 * (1 + state.hessian.trace());
        const Vector4d direction = -(state.hessian + damping * Matrix4d::Identity()).ldlt().solve(state.residual);
        if (!direction.allFinite()) break;
        const double slope = state.residual.dot(direction);
        bool improved = false;
        for (double length = 1; length > 1e-6; length *= 0.5) {
            const Vector4d next = mu + length * direction;
            DualState candidate = dual_at(weights, corners, place, next);
            const double candidate_error = candidate.residual.lpNorm<Eigen::Infinity>();
            // Close to the optimum the differences of the dual value drown in rounding; there the residual decides.
            if (candidate.value <= state.value + 1e-4 * length * slope || candidate_error < 0.5 * error) {
                improved = candidate_error < error || candidate.value < state.value;
                mu = next, state = std::move(candidate), error = candidate_error;
                break;
            }
        }
        if (!improved) break;
    }
    if (!(error < acceptable)) return false;
    for (std::size_t j = 0; j < weights.size(); ++j) weights[j] = std::max(0.0, weights[j] + row_of(corners[j], place).dot(mu));
    return true;
}

namespace {

/// Fills one row: drops weights of the estimate up to the threshold and projects the rest; where the projection fails, retries
/// with lower thresholds.
void fill_row(std::span<const double> estimate, const std::vector<Vector3d>& corners, const Vector3d& place, double drop,
              std::vector<std::pair<int, double>>& row) {
    std::vector<double> weights;
    std::vector<Vector3d> kept_corners;
    std::vector<int> columns;
    for (const double threshold : {drop, 0.1 * drop, 1e-12, -1.0}) {
        weights.clear(), kept_corners.clear(), columns.clear();
        for (std::size_t j = 0; j < estimate.size(); ++j)
            if (estimate[j] > threshold || threshold < 0) {
                weights.push_back(std::max(estimate[j], 0.0)), kept_corners.push_back(corners[j]);
                columns.push_back(static_cast<int>(j));
            }
        if (project_row(weights, kept_corners, place)) break;
        if (threshold >= 0) continue;
        fail_input("cage", "a point has no non-negative weights: it lies outside the cage's convex hull",
                   "give a cage that contains the mesh");
    }
    for (std::size_t k = 0; k < columns.size(); ++k)
        if (weights[k] > 0) row.emplace_back(columns[k], weights[k]);
}

}  // namespace

Coordinates bounded_coordinates(const UnitCage& cage, const std::vector<Point>& points, double snap, double drop,
                                const std::string& kind, const std::function<void()>& prepare,
                                const std::function<void(const Vector3d&, std::span<double>)>& estimate) {
    const SurfaceSearch search(cage.mesh);
    std::vector<SurfaceHit> nearest(points.size());
    std::vector<char> outside(points.size(), 0), on_cage(points.size(), 0);
    parallel_for(points.size(), [&](std::size_t i) {
        const Point p = point_of(cage.unit(points[i]));
        nearest[i] = search.closest(p);
        on_cage[i] = nearest[i].distance <= std::max(snap, min_snap);
        outside[i] = !on_cage[i] && !search.inside(p);
    });
    std::string outside_indices;
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (outside[i] && ++count <= 10) outside_indices += (outside_indices.empty() ? "" : ", ") + std::to_string(i);
    if (count > 0)
        fail_input("cage", fmt::format("{} points are not inside it: {}{}", count, outside_indices, count > 10 ? " ..." : ""),
                   kind + " coordinates are defined inside the cage; give a larger cage, or use mean-value coordinates");
    if (std::find(on_cage.begin(), on_cage.end(), 0) != on_cage.end()) prepare();

    const std::size_t columns = cage.corners.size();
    std::vector<std::vector<std::pair<int, double>>> rows(points.size());
    parallel_blocks(points.size(), 64, [&](std::size_t begin, std::size_t end) {
        std::vector<double> row(columns);
        for (std::size_t i = begin; i < end; ++i) {
            if (on_cage[i]) {
                const auto corner = corners(cage.mesh, Face(nearest[i].face));
                for (std::size_t k = 0; k < 3; ++k)
                    if (nearest[i].barycentric[k] > 0)
                        rows[i].emplace_back(static_cast<int>(corner[k].idx()), nearest[i].barycentric[k]);
                std::sort(rows[i].begin(), rows[i].end());
                continue;
            }
            std::fill(row.begin(), row.end(), 0.0);
            const Vector3d place = cage.unit(points[i]);
            estimate(place, row);
            fill_row(row, cage.corners, place, drop, rows[i]);
        }
    });
    Coordinates result;
    result.vertex = WeightMatrix::Zero(static_cast<Eigen::Index>(points.size()), static_cast<Eigen::Index>(columns));
    result.sparse.resize(result.vertex.rows(), result.vertex.cols());
    std::size_t entries = 0;
    for (const auto& row : rows) entries += row.size();
    result.sparse.reserve(static_cast<Eigen::Index>(entries));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto r = static_cast<Eigen::Index>(i);
        result.sparse.startVec(r);
        for (const auto& [column, weight] : rows[i]) {
            result.sparse.insertBack(r, column) = weight;
            result.vertex(r, column) = weight;
        }
    }
    result.sparse.finalize();
    return result;
}

}  // namespace ostraka::coords
