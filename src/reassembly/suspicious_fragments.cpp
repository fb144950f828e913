#include "ostraka/reassembly/suspicious_fragments.h"

#include "ostraka/core/text.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/mesh/mesh.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

namespace {

struct Measurements {
    double area = 0, volume = 0;
    double width = 0;  ///< width of the fracture: for a sherd, its wall thickness; 0: unknown
};

/// Twice the area of the fracture divided by the length of its rim.
double fracture_width(const Fragment& fragment) {
    if (fragment.facets.empty()) return 0;
    const auto on_fracture = [&](Halfedge h) {
        const Face f = fragment.mesh.face(h);
        return f != Mesh::null_face() && fragment.facets[f] == Facet::fracture;
    };
    double area = 0, rim = 0;
    for (const Face f : fragment.mesh.faces())
        if (fragment.facets[f] == Facet::fracture) area += face_area(fragment.mesh, f);
    for (const Edge e : fragment.mesh.edges()) {
        const Halfedge h = fragment.mesh.halfedge(e);
        if (on_fracture(h) == on_fracture(fragment.mesh.opposite(h))) continue;
        rim += (eigen(fragment.mesh.point(fragment.mesh.source(h))) - eigen(fragment.mesh.point(fragment.mesh.target(h)))).norm();
    }
    return rim > 0 ? 2 * area / rim : 0;
}

Measurements measure(const Fragment& fragment) {
    const Mesh& mesh = fragment.mesh;
    Measurements result;
    result.width = fracture_width(fragment);
    if (mesh.number_of_vertices() == 0) return result;
    const Eigen::Vector3d origin = eigen(mesh.point(Vertex(0)));
    for (const Face f : mesh.faces()) {
        result.area += face_area(mesh, f);
        const auto [a, b, c] = corners(mesh, f);
        result.volume +=
            (eigen(mesh.point(a)) - origin).dot((eigen(mesh.point(b)) - origin).cross(eigen(mesh.point(c)) - origin)) / 6;
    }
    return result;
}

bool closed(const Mesh& mesh) {
    return std::none_of(mesh.halfedges().begin(), mesh.halfedges().end(), [&](Halfedge h) { return mesh.is_border(h); });
}

/// Whether the meshes have the same faces in the same order, by area.
bool have_equal_faces(const Mesh& a, const Mesh& b, double area) {
    double difference = 0;
    for (const Face f : a.faces()) difference += std::abs(face_area(a, f) - face_area(b, f));
    return difference < 1e-4 * area;
}

/// Whether a rigid motion maps the vertices onto each other; otherwise a reflection does.
bool is_rigid_copy(const Mesh& a, const Mesh& b) {
    std::vector<Eigen::Vector3d> from, to;
    const std::size_t n = a.number_of_vertices(), step = std::max<std::size_t>(1, n / 500);
    for (std::size_t k = 0; k < n; k += step) {
        from.push_back(eigen(a.point(Vertex(static_cast<Index>(k)))));
        to.push_back(eigen(b.point(Vertex(static_cast<Index>(k)))));
    }
    const Motion motion = fit_motion(from, to);
    double max_distance = 0, extent = 0;
    for (std::size_t k = 0; k < from.size(); ++k) {
        max_distance = std::max(max_distance, (motion(from[k]) - to[k]).norm());
        extent = std::max(extent, (to[k] - to[0]).norm());
    }
    return max_distance < 1e-3 * extent;
}

}  // namespace

std::vector<SuspiciousFragment> suspicious_fragments(const std::vector<Fragment>& fragments) {
    std::vector<SuspiciousFragment> result;
    std::vector<Measurements> measurements;
    std::vector<double> sizes, widths;
    for (const Fragment& fragment : fragments) {
        measurements.push_back(measure(fragment));
        if (measurements.back().area > 0) sizes.push_back(std::sqrt(measurements.back().area));
        if (measurements.back().width > 0) widths.push_back(measurements.back().width);
    }
    std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> by_size;  // by vertices and faces
    for (std::size_t k = 0; k < fragments.size(); ++k) {
        const Mesh& mesh = fragments[k].mesh;
        if (!(measurements[k].area > 0)) continue;
        if (closed(mesh) && measurements[k].volume < 0) result.push_back({k, "is inside out: its faces point inwards", false});
        auto& others = by_size[{mesh.number_of_vertices(), mesh.number_of_faces()}];
        for (const std::size_t other : others) {
            if (std::abs(measurements[k].area - measurements[other].area) > 1e-4 * measurements[k].area ||
                !have_equal_faces(mesh, fragments[other].mesh, measurements[k].area))
                continue;
            const bool moved_only = is_rigid_copy(fragments[other].mesh, mesh);
            result.push_back(
                {k, fmt::format("is a {} of {}", moved_only ? "copy" : "mirror image", fragments[other].name), true});
            break;
        }
        others.push_back(k);
    }
    if (sizes.size() < 2) return result;
    const double median_size = upper_median(sizes), median_width = widths.empty() ? 0 : upper_median(widths);
    for (std::size_t k = 0; k < fragments.size(); ++k) {
        const double ratio = std::sqrt(measurements[k].area) / median_size, times = ratio < 1 ? 1 / ratio : ratio,
                     width_ratio = measurements[k].width / median_width;
        // Fragments of one vessel may differ in size by a factor of five, but not their walls in thickness.
        const bool width_known = measurements[k].width > 0 && widths.size() > 1,
                   similar_width = !width_known || !(ratio < 1 ? width_ratio < 0.2 : width_ratio > 5);
        if (!(measurements[k].area > 0) || times < (similar_width ? 8 : 5)) continue;
        constexpr double unit_ratios[] = {10, 25.4, 100, 304.8, 1000};
        const bool is_unit_ratio = std::any_of(std::begin(unit_ratios), std::end(unit_ratios),
                                               [&](double u) { return std::abs(std::log(times / u)) < 0.7; });
        if (is_unit_ratio)
            result.push_back({k,
                              fmt::format("is {} times {} than {}: is it in another unit?", digits(times, 2),
                                          ratio < 1 ? "smaller" : "larger", sizes.size() > 2 ? "most" : "the other"),
                              false});
    }
    return result;
}

}  // namespace ostraka
