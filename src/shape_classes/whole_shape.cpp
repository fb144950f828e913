#include "ostraka/shape_classes/whole_shape.h"
#include "ostraka/core/angles.h"

#include "ostraka/core/error.h"
#include "ostraka/fields/curvature.h"
#include "ostraka/fields/thickness.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/geodesic.h"
#include "ostraka/geom/laplace_spectrum.h"
#include "ostraka/measure/solid.h"
#include "ostraka/remesh/simplify.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ostraka {

namespace {

constexpr std::uint64_t vertices = 1500, thickness_vertices = 600;
constexpr int sources = 8, rays = 16;

Mesh simplified_to(const Mesh& mesh, std::uint64_t count) {
    Mesh small = mesh;
    if (mesh.number_of_vertices() <= count) return small;
    SimplifyOptions options;
    options.vertices = count;
    static_cast<void>(simplify(small, options));
    return small;
}

/// Quantile by area: the value below which the area share `share` lies. `values` are sorted.
double area_quantile(const std::vector<std::pair<double, double>>& values, double area, double share) {
    double sum = 0;
    for (const auto& [value, weight] : values)
        if ((sum += weight) >= share * area) return value;
    return values.back().first;
}

void measure_thickness(const Mesh& small, WholeShape& shape) {
    ThicknessOptions options;
    options.rays = rays;
    const std::vector<double> values = thickness(small, options);
    std::vector<std::pair<double, double>> known;
    double sum = 0, area = 0;
    for (const Face face : small.faces()) {
        const double a = face_area(small, face);
        if (!std::isfinite(values[face]) || !(a > 0)) continue;
        known.emplace_back(values[face], a);
        area += a;
        sum += a * values[face];
    }
    const double whole = surface_area(small);
    if (!(area > 0.9 * whole) || !(sum > 0)) return;
    std::sort(known.begin(), known.end());
    const double mean = sum / area;
    shape.thickness_mean = mean / std::sqrt(whole);
    shape.thickness_median = area_quantile(known, area, 0.5) / mean;
    shape.thickness_most = area_quantile(known, area, 0.9) / mean;
}

double compactness_of(double volume, double area) { return 6 * std::sqrt(pi) * volume / std::pow(area, 1.5); }

/// None if the surface is open or inside out.
std::optional<double> volume_of(const Mesh& mesh) {
    for (const Halfedge h : mesh.halfedges())
        if (mesh.is_border(h)) return {};
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Point& p : mesh.points()) middle += eigen(p) / static_cast<double>(mesh.number_of_vertices());
    double volume = 0;
    for (const Face face : mesh.faces()) {
        const auto c = corners(mesh, face);
        const Eigen::Vector3d x = eigen(mesh.point(c[0])) - middle, y = eigen(mesh.point(c[1])) - middle,
                              z = eigen(mesh.point(c[2])) - middle;
        volume += x.dot(y.cross(z)) / 6;
    }
    if (!(volume > 0)) return {};
    return volume;
}

void measure_solid(const Mesh& mesh, const Mesh& small, double area, WholeShape& shape) {
    const std::optional<double> volume = volume_of(mesh);
    if (!volume) return;
    shape.compactness = compactness_of(*volume, area);
    const HullSize hull = hull_size({mesh.points().begin(), mesh.points().end()});
    if (hull.volume > 0) {
        shape.hull_share = std::min(1.0, *volume / hull.volume);
        shape.hull_compactness = compactness_of(hull.volume, hull.area);
    }
    const CurvatureIntegrals integrals = curvature_integrals(small);
    double sum = 0, absolute = 0, concave = 0, gaussian = 0;
    for (const Face face : small.faces()) {
        const double mean = integrals.mean[face];
        sum += mean;
        absolute += std::abs(mean);
        concave += std::max(0.0, -mean);
        gaussian += std::abs(integrals.gaussian[face]);
    }
    shape.curvature = sum / std::sqrt(area);
    if (absolute > 0) shape.concave = concave / absolute;
    shape.saddles = gaussian / (4 * pi);
}

}  // namespace

WholeShape measure_whole_shape(const Mesh& mesh) {
    const double area = surface_area(mesh);
    if (!(area > 0)) fail_input("mesh", "has no area", "is it the right file?");
    WholeShape shape;
    const Mesh small = simplified_to(mesh, vertices);
    measure_solid(mesh, small, area, shape);
    shape.spectrum = laplace_spectrum(small, WholeShape::spectrum_size);
    measure_thickness(simplified_to(small, thickness_vertices), shape);
    std::vector<double> weights(small.number_of_vertices(), 0);
    for (const Face face : small.faces())
        for (const Vertex v : corners(small, face)) weights[v] += face_area(small, face) / 3;
    // The first source is the vertex farthest from the centre; each further source is the farthest from all before it.
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Vertex v : small.vertices()) middle += weights[v] * eigen(small.point(v));
    middle /= surface_area(small);
    std::vector<double> nearest(small.number_of_vertices(), -1);
    for (const Vertex v : small.vertices())
        if (weights[v] > 0) nearest[v] = (eigen(small.point(v)) - middle).norm();
    double sum = 0, squares = 0, weight = 0, maximum = 0;
    const double size = std::sqrt(area);
    for (int s = 0; s < sources; ++s) {
        const auto at = std::max_element(nearest.begin(), nearest.end());
        if (!(*at > 0)) break;
        if (s == 1) shape.second_point = *at / size;
        if (s == 3) shape.fourth_point = *at / size;
        if (s == 5) shape.sixth_point = *at / size;
        const auto distances = geodesic_distances(small, {static_cast<Index>(at - nearest.begin())});
        for (std::size_t v = 0; v < distances.size(); ++v) {
            if (!std::isfinite(distances[v])) continue;
            nearest[v] = s == 0 ? distances[v] : std::min(nearest[v], distances[v]);
            sum += weights[v] * distances[v];
            squares += weights[v] * distances[v] * distances[v];
            weight += weights[v];
            maximum = std::max(maximum, distances[v]);
        }
        // Unreachable vertices are in other components: sources stay in the first component.
        for (std::size_t v = 0; v < distances.size(); ++v)
            if (!std::isfinite(distances[v])) nearest[v] = -1;
    }
    if (!(weight > 0) || !(sum > 0)) return shape;
    const double mean = sum / weight;
    shape.geodesic_mean = mean / size;
    shape.geodesic_max = maximum / size;
    shape.geodesic_variation = std::sqrt(std::max(0.0, squares / weight - mean * mean)) / mean;
    return shape;
}

}  // namespace ostraka
