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
    Mesh simplified = mesh;
    if (mesh.number_of_vertices() <= count) return simplified;
    SimplifyOptions options;
    options.vertices = count;
    static_cast<void>(simplify(simplified, options));
    return simplified;
}

/// Quantile by area: the value below which the area fraction `fraction` lies. `values` are sorted.
double area_quantile(const std::vector<std::pair<double, double>>& values, double area, double fraction) {
    double sum = 0;
    for (const auto& [value, weight] : values)
        if ((sum += weight) >= fraction * area) return value;
    return values.back().first;
}

void measure_thickness(const Mesh& simplified, WholeShape& shape) {
    ThicknessOptions options;
    options.rays = rays;
    const std::vector<double> values = thickness(simplified, options);
    std::vector<std::pair<double, double>> values_by_area;
    double sum = 0, area = 0;
    for (const Face face : simplified.faces()) {
        const double a = face_area(simplified, face);
        if (!std::isfinite(values[face]) || !(a > 0)) continue;
        values_by_area.emplace_back(values[face], a);
        area += a;
        sum += a * values[face];
    }
    const double total_area = surface_area(simplified);
    if (!(area > 0.9 * total_area) || !(sum > 0)) return;
    std::sort(values_by_area.begin(), values_by_area.end());
    const double mean = sum / area;
    shape.thickness_mean = mean / std::sqrt(total_area);
    shape.thickness_median = area_quantile(values_by_area, area, 0.5) / mean;
    shape.thickness_most = area_quantile(values_by_area, area, 0.9) / mean;
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

void measure_solid(const Mesh& mesh, const Mesh& simplified, double area, WholeShape& shape) {
    const std::optional<double> volume = volume_of(mesh);
    if (!volume) return;
    shape.compactness = compactness_of(*volume, area);
    const ConvexHullSize hull = convex_hull_size({mesh.points().begin(), mesh.points().end()});
    if (hull.volume > 0) {
        shape.hull_share = std::min(1.0, *volume / hull.volume);
        shape.hull_compactness = compactness_of(hull.volume, hull.area);
    }
    const CurvatureIntegrals integrals = curvature_integrals(simplified);
    double sum = 0, absolute = 0, concave = 0, gaussian = 0;
    for (const Face face : simplified.faces()) {
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
    if (!(area > 0)) fail_input("mesh", "has no area", "check that it is the right file");
    WholeShape shape;
    const Mesh simplified = simplified_to(mesh, vertices);
    measure_solid(mesh, simplified, area, shape);
    shape.spectrum = laplace_spectrum(simplified, WholeShape::spectrum_size);
    measure_thickness(simplified_to(simplified, thickness_vertices), shape);
    std::vector<double> weights(simplified.number_of_vertices(), 0);
    for (const Face face : simplified.faces())
        for (const Vertex v : corners(simplified, face)) weights[v] += face_area(simplified, face) / 3;
    // The first source is the vertex farthest from the centre; each further source is the farthest from all before it.
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Vertex v : simplified.vertices()) middle += weights[v] * eigen(simplified.point(v));
    middle /= surface_area(simplified);
    std::vector<double> nearest(simplified.number_of_vertices(), -1);
    for (const Vertex v : simplified.vertices())
        if (weights[v] > 0) nearest[v] = (eigen(simplified.point(v)) - middle).norm();
    double sum = 0, squares = 0, weight = 0, maximum = 0;
    const double size = std::sqrt(area);
    for (int s = 0; s < sources; ++s) {
        const auto at = std::max_element(nearest.begin(), nearest.end());
        if (!(*at > 0)) break;
        if (s == 1) shape.second_point = *at / size;
        if (s == 3) shape.fourth_point = *at / size;
        if (s == 5) shape.sixth_point = *at / size;
        const auto distances = geodesic_distances(simplified, {static_cast<Index>(at - nearest.begin())});
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
