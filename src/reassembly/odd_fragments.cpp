#include "ostraka/reassembly/odd_fragments.h"

#include "ostraka/core/mesh.h"
#include "ostraka/core/text.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

namespace {

struct Look {
    double area = 0, volume = 0;
    double width = 0;  ///< width of the fracture: for a sherd, its wall thickness; 0: unknown
};

/// Twice the area of the fracture divided by the length of its rim.
double break_width(const Fragment& fragment) {
    if (fragment.facets.empty()) return 0;
    const auto broken = [&](Halfedge h) {
        const Face f = fragment.mesh.face(h);
        return f != Mesh::null_face() && fragment.facets[f] == Facet::fracture;
    };
    double area = 0, rim = 0;
    for (const Face f : fragment.mesh.faces())
        if (fragment.facets[f] == Facet::fracture) area += face_area(fragment.mesh, f);
    for (const Edge e : fragment.mesh.edges()) {
        const Halfedge h = fragment.mesh.halfedge(e);
        if (broken(h) == broken(fragment.mesh.opposite(h))) continue;
        rim += (eigen(fragment.mesh.point(fragment.mesh.source(h))) - eigen(fragment.mesh.point(fragment.mesh.target(h)))).norm();
    }
    return rim > 0 ? 2 * area / rim : 0;
}

Look look_of(const Fragment& fragment) {
    const Mesh& mesh = fragment.mesh;
    Look look;
    look.width = break_width(fragment);
    if (mesh.number_of_vertices() == 0) return look;
    const Eigen::Vector3d origin = eigen(mesh.point(Vertex(0)));
    for (const Face f : mesh.faces()) {
        look.area += face_area(mesh, f);
        const auto [a, b, c] = corners(mesh, f);
        look.volume +=
            (eigen(mesh.point(a)) - origin).dot((eigen(mesh.point(b)) - origin).cross(eigen(mesh.point(c)) - origin)) / 6;
    }
    return look;
}

bool closed(const Mesh& mesh) {
    return std::none_of(mesh.halfedges().begin(), mesh.halfedges().end(), [&](Halfedge h) { return mesh.is_border(h); });
}

/// Whether the meshes have the same faces in the same order, by area.
bool alike(const Mesh& a, const Mesh& b, double area) {
    double off = 0;
    for (const Face f : a.faces()) off += std::abs(face_area(a, f) - face_area(b, f));
    return off < 1e-4 * area;
}

/// Whether a rigid motion maps the vertices onto each other; otherwise a reflection does.
bool by_motion(const Mesh& a, const Mesh& b) {
    std::vector<Eigen::Vector3d> from, to;
    const std::size_t n = a.number_of_vertices(), step = std::max<std::size_t>(1, n / 500);
    for (std::size_t k = 0; k < n; k += step) {
        from.push_back(eigen(a.point(Vertex(static_cast<Index>(k)))));
        to.push_back(eigen(b.point(Vertex(static_cast<Index>(k)))));
    }
    const Motion motion = fit_motion(from, to);
    double off = 0, extent = 0;
    for (std::size_t k = 0; k < from.size(); ++k) {
        off = std::max(off, (motion(from[k]) - to[k]).norm());
        extent = std::max(extent, (to[k] - to[0]).norm());
    }
    return off < 1e-3 * extent;
}

}  // namespace

std::vector<OddFragment> odd_fragments(const std::vector<Fragment>& fragments) {
    std::vector<OddFragment> result;
    std::vector<Look> looks;
    std::vector<double> sizes, widths;
    for (const Fragment& one : fragments) {
        looks.push_back(look_of(one));
        if (looks.back().area > 0) sizes.push_back(std::sqrt(looks.back().area));
        if (looks.back().width > 0) widths.push_back(looks.back().width);
    }
    std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> same;  // by vertices and faces
    for (std::size_t k = 0; k < fragments.size(); ++k) {
        const Mesh& mesh = fragments[k].mesh;
        if (!(looks[k].area > 0)) continue;
        if (closed(mesh) && looks[k].volume < 0)
            result.push_back({k, "is inside out: its faces look inwards; run 'ostraka mesh repair'", false});
        auto& others = same[{mesh.number_of_vertices(), mesh.number_of_faces()}];
        for (const std::size_t other : others) {
            if (std::abs(looks[k].area - looks[other].area) > 1e-4 * looks[k].area ||
                !alike(mesh, fragments[other].mesh, looks[k].area))
                continue;
            const bool moved_only = by_motion(fragments[other].mesh, mesh);
            result.push_back({k, (moved_only ? "is a copy of " : "is a mirror image of ") + fragments[other].name, true});
            break;
        }
        others.push_back(k);
    }
    if (sizes.size() < 2) return result;
    const double usual = upper_median(sizes), usual_width = widths.empty() ? 0 : upper_median(widths);
    for (std::size_t k = 0; k < fragments.size(); ++k) {
        const double ratio = std::sqrt(looks[k].area) / usual, times = ratio < 1 ? 1 / ratio : ratio,
                     width_ratio = looks[k].width / usual_width;
        // Fragments of one vessel may differ in size by a factor of five, but not their walls in thickness.
        const bool known = looks[k].width > 0 && widths.size() > 1,
                   as_thick = !known || !(ratio < 1 ? width_ratio < 0.2 : width_ratio > 5);
        if (!(looks[k].area > 0) || times < (as_thick ? 8 : 5)) continue;
        constexpr double units[] = {10, 25.4, 100, 304.8, 1000};
        const bool unit =
            std::any_of(std::begin(units), std::end(units), [&](double u) { return std::abs(std::log(times / u)) < 0.7; });
        if (unit)
            result.push_back({k,
                              "is " + digits(times, 2) + (ratio < 1 ? " times smaller" : " times larger") +
                                  (sizes.size() > 2 ? " than most" : " than the other") + ": is it in another unit?",
                              false});
    }
    return result;
}

}  // namespace ostraka
