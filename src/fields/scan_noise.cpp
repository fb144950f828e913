#include "ostraka/fields/scan_noise.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/neighbourhood.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

namespace {

constexpr double no_estimate = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t fit_min_vertices = 9, quadric_unknowns = 6;

/// A quadric fitted to the vertices around a vertex.
struct QuadricFit {
    double deviation = no_estimate, curvature = no_estimate;
    double residual = no_estimate;  ///< of the vertex itself
};

using Coefficients = Eigen::Matrix<double, 6, 1>;

/// `places` relative to the vertex, which comes first, in units of the radius; residuals are positive along `outward`.
QuadricFit fit_quadric(const std::vector<Vector3d>& places, const Vector3d& outward) {
    QuadricFit fit;
    if (places.size() < fit_min_vertices) return fit;
    Vector3d mean = Vector3d::Zero();
    for (const Vector3d& p : places) mean += p;
    mean /= static_cast<double>(places.size());
    Matrix3d spread = Matrix3d::Zero();
    for (const Vector3d& p : places) spread += (p - mean) * (p - mean).transpose();
    const SymmetricEigen3 axes(spread);
    if (!axes.succeeded() || !(axes.eigenvalues()[1] > 1e-12 * axes.eigenvalues()[2])) return fit;
    const auto row_of = [&](const Vector3d& p) {
        const Vector3d local = axes.eigenvectors().transpose() * (p - mean);
        const double x = local[2], y = local[1];
        Coefficients row;
        row << 1, x, y, x * x, x * y, y * y;
        return std::pair(row, local[0]);
    };
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    Coefficients right = Coefficients::Zero();
    for (const Vector3d& p : places) {
        const auto [row, height] = row_of(p);
        normal += row * row.transpose();
        right += height * row;
    }
    normal.diagonal().array() += 1e-12 * normal.trace();
    const Coefficients c = solve_ldlt<6>(normal, right);
    double squares = 0;
    for (const Vector3d& p : places) {
        const auto [row, height] = row_of(p);
        const double residual = height - row.dot(c);
        squares += residual * residual;
    }
    const auto [own_row, own_height] = row_of(places.front());
    fit.residual = (axes.eigenvectors().col(0).dot(outward) < 0 ? -1 : 1) * (own_height - own_row.dot(c));
    fit.deviation = std::sqrt(squares / static_cast<double>(places.size() - quadric_unknowns));
    const double mean_curvature = c[3] + c[5], half_difference = std::hypot(c[3] - c[5], c[4]);
    fit.curvature = std::abs(mean_curvature) + half_difference;
    return fit;
}

/// The fit around one vertex, in the mesh's unit.
QuadricFit fit_around(const Mesh& mesh, Vertex vertex, double radius) {
    thread_local std::vector<Vector3d> places;
    places.clear();
    if (mesh.is_isolated(vertex)) return {};
    const Vector3d centre = eigen(mesh.point(vertex));
    this_threads_neighbourhood().walk(
        mesh, vertex, radius, [&](Vertex near, double) { places.emplace_back((eigen(mesh.point(near)) - centre) / radius); });
    QuadricFit fit = fit_quadric(places, eigen(vertex_normal(mesh, vertex)));
    fit.deviation *= radius;
    fit.residual *= radius;
    fit.curvature /= radius;
    return fit;
}

}  // namespace

ScanNoise scan_noise(const Mesh& mesh, double radius) {
    if (!(radius >= 0 && std::isfinite(radius))) fail_usage("the radius of the noise is negative", "give 0 or a length");
    ScanNoise noise;
    noise.radius = radius > 0 ? radius : 3 * mean_edge_length(mesh);
    const std::size_t count = mesh.number_of_vertices();
    noise.deviation.assign(count, no_estimate);
    noise.curvature.assign(count, no_estimate);
    std::vector<double> residuals(count, no_estimate);
    if (noise.radius > 0) {
        Progress progress("noise", count);
        parallel_blocks(count, 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const QuadricFit fit = fit_around(mesh, Vertex(static_cast<Index>(i)), noise.radius);
                noise.deviation[i] = fit.deviation;
                noise.curvature[i] = fit.curvature;
                residuals[i] = fit.residual;
            }
            progress.advance(end - begin);
        });
    }
    std::vector<double> finite;
    for (const double value : noise.deviation)
        if (std::isfinite(value)) finite.push_back(value);
    noise.without = count - finite.size();
    noise.median = finite.empty() ? no_estimate : upper_median(std::move(finite));
    double product = 0, squares = 0;
    for (const Edge edge : mesh.edges()) {
        const double a = residuals[mesh.vertex(edge, 0)], b = residuals[mesh.vertex(edge, 1)];
        if (!std::isfinite(a) || !std::isfinite(b)) continue;
        product += a * b;
        squares += (a * a + b * b) / 2;
    }
    noise.correlation = squares > 0 ? product / squares : no_estimate;
    return noise;
}

PlaceNoise noise_at(const Mesh& mesh, const ScanNoise& noise, Index face, const std::array<double, 3>& weights) {
    const auto vertices = corners(mesh, Face(face));
    PlaceNoise result;
    double curvature = 0, longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        if (weights[k] == 0) continue;
        const double deviation = noise.deviation[vertices[k]];
        result.variance += weights[k] * weights[k] * deviation * deviation;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const double here = noise.curvature[vertices[k]];
        curvature = std::isnan(here) ? no_estimate : std::max(curvature, here);
        if (std::isnan(curvature)) break;
    }
    for (std::size_t k = 0; k < 3; ++k)
        longest = std::max(longest, CGAL::squared_distance(mesh.point(vertices[k]), mesh.point(vertices[(k + 1) % 3])));
    result.facet_height = longest * curvature / 6;
    return result;
}

}  // namespace ostraka
