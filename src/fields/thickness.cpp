#include "ostraka/fields/thickness.h"
#include "ostraka/core/angles.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/neighbourhood.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace ostraka {

namespace {

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// A ray of the cone: its direction relative to the axis and its weight.
struct ConeRay {
    double x, y, z, weight;
};

/// Directions evenly spread over the cone (Vogel's spiral on the sphere); weights fall to a quarter towards the rim.
std::vector<ConeRay> cone_rays(int count, double opening) {
    const double half = opening / 2 * pi / 180, lowest = std::cos(half);
    std::vector<ConeRay> rays;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (1 - lowest) * (i + 0.5) / count, r = std::sqrt(std::max(0.0, 1 - z * z));
        const double angle = i * pi * (3 - std::sqrt(5.0)), relative_angle = half > 0 ? std::acos(z) / half : 0;
        rays.push_back({r * std::cos(angle), r * std::sin(angle), z, std::exp2(-2 * relative_angle * relative_angle)});
    }
    return rays;
}

/// Area vectors of the faces averaged over balls, so that single faces do not tilt the cone.
std::vector<Vector> smooth_normals(const Mesh& mesh, double radius) {
    std::vector<Vector> area_vectors(mesh.number_of_faces()), result(area_vectors.size(), Vector(0, 0, 0));
    std::vector<Point> centroids(area_vectors.size());
    parallel_for(area_vectors.size(), [&](std::size_t f) {
        area_vectors[f] = area_vector(mesh, Face(static_cast<Index>(f)));
        centroids[f] = centroid(mesh, Face(static_cast<Index>(f)));
    });
    if (!(radius > 0)) return area_vectors;
    parallel_for(result.size(), 4096, [&](std::size_t f) {
        check_cancelled();  // a ball may be large
        this_threads_neighbourhood().walk(mesh, centroids, Face(static_cast<Index>(f)), radius, [&](Face face, double squared) {
            result[f] += (1 - squared / (radius * radius)) * area_vectors[face];
        });
    });
    return result;
}

/// Weighted mean of the lengths within one standard deviation of their median (Shapira, Shamir and Cohen-Or 2008, section 3).
double robust_mean(const std::vector<double>& lengths, const std::vector<double>& weights) {
    const double median = upper_median(lengths);
    double mean = 0, square = 0;
    for (const double x : lengths) mean += x / static_cast<double>(lengths.size());
    for (const double x : lengths) square += (x - mean) * (x - mean) / static_cast<double>(lengths.size());
    const double deviation = std::sqrt(square);
    double sum = 0, weight = 0;
    for (std::size_t i = 0; i < lengths.size(); ++i)
        if (std::abs(lengths[i] - median) <= deviation || lengths[i] == median) {
            sum += weights[i] * lengths[i];
            weight += weights[i];
        }
    return sum / weight;
}

}  // namespace

std::vector<double> thickness(const Mesh& mesh, const ThicknessOptions& options) {
    check_options(options, "thickness");
    std::vector<double> result(mesh.number_of_faces(), undefined);
    if (result.empty() || !(surface_area(mesh) > 0)) return result;
    const std::vector<ConeRay> rays = cone_rays(options.rays, options.cone);
    const std::vector<Vector> normals = smooth_normals(mesh, options.scale * box_diagonal(mesh));
    const SurfaceSearch search(mesh);
    parallel_for(result.size(), 64, [&](std::size_t f) {
        const Face face(static_cast<Index>(f));
        Vector axis = -normals[f];
        const double length = std::sqrt(axis.squared_length());
        if (!(length > 0)) return;
        axis = axis / length;
        const Vector perpendicular = std::abs(axis.x()) < 0.6 ? Vector(0, -axis.z(), axis.y()) : Vector(axis.z(), 0, -axis.x());
        const Vector u = perpendicular / std::sqrt(perpendicular.squared_length()), w = CGAL::cross_product(axis, u);
        std::vector<double> lengths, weights;
        const Point origin = centroid(mesh, face);
        for (const ConeRay& ray : rays) {
            const Vector direction = ray.x * u + ray.y * w + ray.z * axis;
            const auto exit = search.first_exit(origin, direction, static_cast<Index>(f), 1e-9 * search.diagonal());
            if (!exit) continue;
            lengths.push_back(exit->distance);
            weights.push_back(ray.weight);
        }
        if (2 * lengths.size() >= rays.size()) result[f] = robust_mean(lengths, weights);
    });
    return result;
}

std::vector<double> vertices_from_faces(const Mesh& mesh, const std::vector<double>& face_values) {
    if (face_values.size() != mesh.number_of_faces())
        fail_usage(fmt::format("there are {} values for {} faces", face_values.size(), mesh.number_of_faces()),
                   "give one value per face");
    std::vector<double> result(mesh.number_of_vertices(), undefined);
    parallel_for(result.size(), [&](std::size_t i) {
        const Vertex v(static_cast<Index>(i));
        if (mesh.is_isolated(v)) return;
        double sum = 0, weight = 0;
        for (const Face face : mesh.faces_around_target(mesh.halfedge(v))) {
            if (face == Mesh::null_face() || !std::isfinite(face_values[face])) continue;
            const double area = face_area(mesh, face);
            sum += area * face_values[face];
            weight += area;
        }
        if (weight > 0) result[i] = sum / weight;
    });
    return result;
}

void ThicknessOptions::declare_options(OptionList& list) {
    list("rays", rays, "number of rays sent inward from each face", Range{1, 1000});
    list("cone", cone, "opening angle of the cone in which the rays of a face lie", Range{0, 175}, "degrees");
    list("thickness-scale", scale,
         "radius over which normals are averaged for the axis of the cone; a larger radius makes the thickness less sensitive to "
         "noise",
         Range{0, 1}, "share of the box diagonal");
}

}  // namespace ostraka
