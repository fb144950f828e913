#include "ostraka/shape_classes/whole_shape.h"
#include "ostraka/core/angles.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/geodesic.h"
#include "ostraka/remesh/simplify.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

constexpr std::uint64_t vertices = 1500;
constexpr int sources = 8;

std::optional<double> compactness_of(const Mesh& mesh, double area) {
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
    return 6 * std::sqrt(pi) * volume / std::pow(area, 1.5);
}

}  // namespace

WholeShape measure_whole_shape(const Mesh& mesh) {
    const double area = surface_area(mesh);
    if (!(area > 0)) fail_input("mesh", "has no area", "is it the right file?");
    WholeShape shape;
    shape.compactness = compactness_of(mesh, area);
    Mesh small = mesh;
    if (mesh.number_of_vertices() > vertices) {
        SimplifyOptions options;
        options.vertices = vertices;
        static_cast<void>(simplify(small, options));
    }
    std::vector<double> weights(small.number_of_vertices(), 0);
    for (const Face face : small.faces())
        for (const Vertex v : corners(small, face)) weights[v] += face_area(small, face) / 3;
    // The first source is the vertex farthest from the middle, the next ones are farthest from all before.
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const Vertex v : small.vertices()) middle += weights[v] * eigen(small.point(v));
    middle /= surface_area(small);
    std::vector<double> nearest(small.number_of_vertices(), -1);
    for (const Vertex v : small.vertices())
        if (weights[v] > 0) nearest[v] = (eigen(small.point(v)) - middle).norm();
    double sum = 0, squares = 0, weight = 0, maximum = 0;
    for (int s = 0; s < sources; ++s) {
        const auto at = std::max_element(nearest.begin(), nearest.end());
        if (!(*at > 0)) break;
        const auto distances = geodesic_distances(small, {static_cast<Index>(at - nearest.begin())});
        for (std::size_t v = 0; v < distances.size(); ++v) {
            if (!std::isfinite(distances[v])) continue;
            nearest[v] = s == 0 ? distances[v] : std::min(nearest[v], distances[v]);
            sum += weights[v] * distances[v];
            squares += weights[v] * distances[v] * distances[v];
            weight += weights[v];
            maximum = std::max(maximum, distances[v]);
        }
        // Other components are not reached: sources stay in the first one.
        for (std::size_t v = 0; v < distances.size(); ++v)
            if (!std::isfinite(distances[v])) nearest[v] = -1;
    }
    if (!(weight > 0) || !(sum > 0)) return shape;
    const double mean = sum / weight, size = std::sqrt(area);
    shape.geodesic_mean = mean / size;
    shape.geodesic_max = maximum / size;
    shape.geodesic_variation = std::sqrt(std::max(0.0, squares / weight - mean * mean)) / mean;
    return shape;
}

}  // namespace ostraka
