#include "semantic/verdict.h"

#include "ostraka/core/angles.h"
#include "ostraka/io/diagnose.h"

#include <algorithm>

namespace ostraka::semantic {

std::vector<bool> edited_vertices(const HandleSpace& space, const EditState& last, const Points& displacements) {
    if (space.cage == nullptr) return last.touched;
    std::vector<bool> flags = last.is_referenced;
    if (!last.by_handles || flags.empty()) return flags;
    const Eigen::VectorXd wanted = displacements.colwise().norm();
    const double half = wanted.maxCoeff() / 2;
    for (std::size_t i = 0; i < flags.size(); ++i)
        flags[i] = flags[i] || (half > 0 && wanted[static_cast<Eigen::Index>(i)] >= half);
    return flags;
}

EditFollowed followed_edit(const HandleSpace& space, const EditState& last, const std::vector<bool>& asked, const Points& rest,
                           const Points& edited, const Points& now) {
    EditFollowed result;
    const Eigen::VectorXd wanted = (edited - rest).colwise().norm(), off = (now - edited).colwise().norm();
    double square_wanted = 0, square_off = 0;
    for (std::size_t i = 0; i < asked.size(); ++i) {
        const auto v = static_cast<Eigen::Index>(i);
        if (!asked[i]) continue;
        ++result.vertices;
        square_wanted += wanted[v] * wanted[v];
        square_off += off[v] * off[v];
        result.mean += off[v];
        result.largest = std::max(result.largest, off[v]);
    }
    if (result.vertices > 0) result.mean /= static_cast<double>(result.vertices);
    if (square_wanted > 0) result.share = std::max(0.0, 1 - std::sqrt(square_off / square_wanted));
    const double diagonal = box_diagonal(space.mesh);
    for (const Annotation& annotation : space.annotations.annotations) {
        double sum = 0, largest = 0;
        std::size_t all = 0, others = 0;
        for (const Index v : vertices_of(space.mesh, annotation)) {
            ++all;
            if (asked[v]) continue;
            ++others;
            // Handles of a cage do not tell which parts the edit is meant to move; count only changes after the edit.
            const double way = last.by_handles ? off[v] : (now.col(v) - rest.col(v)).norm();
            sum += way;
            largest = std::max(largest, way / diagonal);
        }
        // Skip annotations that contain all vertices the edit moves, such as the whole object.
        if (2 * others <= all || (result.vertices > 0 && all - others == result.vertices)) continue;
        const double share = sum / (static_cast<double>(others) * diagonal);
        if (share > 1e-3 || largest > 5e-3) result.others.push_back({annotation.id, annotation.tag, share, largest});
    }
    std::stable_sort(result.others.begin(), result.others.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
    return result;
}

SurfaceChange surface_change(const Mesh& rest, const Mesh& edited, const Mesh& now) {
    SurfaceChange change;
    const auto crossings = [](const Mesh& mesh) { return self_intersections(to_soup(mesh)).pairs; };
    const auto pairs_now = crossings(now), pairs_before = crossings(rest);  // sorted
    change.crossings = pairs_now.size();
    change.crossings_before = pairs_before.size();
    change.crossings_new = static_cast<std::size_t>(std::count_if(pairs_now.begin(), pairs_now.end(), [&](const auto& pair) {
        return !std::binary_search(pairs_before.begin(), pairs_before.end(), pair);
    }));
    const auto bend = [](const Mesh& mesh, Halfedge h) {
        const Vector a = area_vector(mesh, mesh.face(h)), b = area_vector(mesh, mesh.face(mesh.opposite(h)));
        const double cross = std::sqrt(CGAL::cross_product(a, b).squared_length());
        return std::atan2(cross, a * b) * 180 / pi;
    };
    for (const Edge e : now.edges()) {
        if (now.is_border(e)) continue;
        const Halfedge h = now.halfedge(e);
        const double after = bend(now, h);
        if (after > 150 && after > bend(rest, h) + 30) ++change.folds;
        else if (after > 90 && after > std::max(bend(rest, h), bend(edited, h)) + 60) ++change.kinks;
    }
    return change;
}

}  // namespace ostraka::semantic
