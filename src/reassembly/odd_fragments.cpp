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
};

Look look_of(const Mesh& mesh) {
    Look look;
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

/// The same faces in the same order, of the same areas.
bool alike(const Mesh& a, const Mesh& b, double area) {
    double off = 0;
    for (const Face f : a.faces()) off += std::abs(face_area(a, f) - face_area(b, f));
    return off < 1e-4 * area;
}

/// Whether a rigid motion brings the vertices onto each other; else a mirror image does.
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
    std::vector<double> sizes;
    for (const Fragment& one : fragments) {
        looks.push_back(look_of(one.mesh));
        if (looks.back().area > 0) sizes.push_back(std::sqrt(looks.back().area));
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
    if (sizes.size() < 3) return result;
    const double usual = upper_median(sizes);
    for (std::size_t k = 0; k < fragments.size(); ++k) {
        const double ratio = std::sqrt(looks[k].area) / usual, times = ratio < 1 ? 1 / ratio : ratio;
        if (!(looks[k].area > 0) || times < 8) continue;
        constexpr double units[] = {10, 25.4, 100, 304.8, 1000};
        const bool unit =
            std::any_of(std::begin(units), std::end(units), [&](double u) { return std::abs(std::log(times / u)) < 0.7; });
        if (unit)
            result.push_back({k,
                              "is " + digits(times, 2) + (ratio < 1 ? " times smaller" : " times larger") +
                                  " than most: is it in another unit?",
                              false});
    }
    return result;
}

}  // namespace ostraka
