#include "semantic/distortion.h"

#include "semantic/statements.h"

#include "ostraka/fields/thickness.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/semantic/edit.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace ostraka::semantic {

namespace {

/// Distances between points and their former positions after the best rigid motion.
Eigen::VectorXd off_rigid(const Points& were, const Points& are) {
    const Eigen::Matrix4d motion = Eigen::umeyama(were, are, false);
    return (are - ((motion.topLeftCorner<3, 3>() * were).colwise() + motion.topRightCorner<3, 1>())).colwise().norm();
}

/// Flags faces less than half as thick as at rest and after the edit.
std::vector<bool> thin_faces(const Mesh& rest, const Mesh& edited, const Mesh& now) {
    const ThicknessOptions few{.rays = 5, .cone = 30};
    const std::vector<double> before = thickness(rest, few), asked = thickness(edited, few), after = thickness(now, few);
    std::vector<bool> flags(after.size(), false);
    for (std::size_t f = 0; f < after.size(); ++f) flags[f] = after[f] < 0.5 * std::min(before[f], asked[f]);
    return flags;
}

/// Flags the vertices within an edge-path distance of `radius` from a flagged vertex.
std::vector<bool> around(const Mesh& mesh, const std::vector<bool>& flagged, double radius) {
    std::vector<double> distance(mesh.number_of_vertices(), std::numeric_limits<double>::infinity());
    std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, std::greater<>> queue;
    for (const Vertex v : mesh.vertices())
        if (flagged[v] && !mesh.is_isolated(v)) queue.emplace(distance[v] = 0, v.idx());
    while (!queue.empty()) {
        const auto [way, v] = queue.top();
        queue.pop();
        if (way > distance[v]) continue;
        for (const Vertex n : mesh.vertices_around_target(mesh.halfedge(Vertex(v)))) {
            const double next = way + std::sqrt(CGAL::squared_distance(mesh.point(n), mesh.point(Vertex(v))));
            if (next <= radius && next < distance[n]) queue.emplace(distance[n] = next, n.idx());
        }
    }
    std::vector<bool> near(distance.size());
    for (std::size_t v = 0; v < near.size(); ++v) near[v] = std::isfinite(distance[v]);
    return near;
}

}  // namespace

std::vector<DistortedPart> distorted_parts(AnnotatedMeshView rest, const Expected& expected, const Mesh& edited, const Mesh& now,
                                           const DeformOptions& options) {
    const Points from = columns_of(edited), to = columns_of(now);
    constexpr double most_thin = 0.05;  // at the outline of a part rays may end in another part
    const double diagonal = box_diagonal(rest.mesh), limit = options.distortion * diagonal;
    const std::vector<bool> giving = around(rest.mesh, expected.change, options.spread * diagonal);
    const auto moved = [&](const std::vector<Index>& vertices) {
        return std::any_of(vertices.begin(), vertices.end(), [&](Index v) { return (to.col(v) - from.col(v)).norm() > limit; });
    };
    std::vector<bool> thin;
    std::vector<DistortedPart> parts;
    for (const Annotation& annotation : rest.annotations.annotations) {
        if (annotation.faces.empty()) continue;
        const std::vector<Index> all = vertices_of(rest.mesh, annotation);
        if (!moved(all)) continue;
        std::vector<Index> own;
        std::size_t changed = 0, resized = 0;
        for (const Index v : all) {
            if (!giving[v]) own.push_back(v);
            changed += expected.change[v] ? 1 : 0;
            resized += expected.size[v] ? 1 : 0;
        }
        DistortedPart part{annotation.id, annotation.tag};
        if (2 * changed < all.size() && own.size() >= 4) {
            const Eigen::VectorXd off = off_rigid(columns_at(from, own), columns_at(to, own));
            part.distance = std::sqrt(off.squaredNorm() / static_cast<double>(off.size()));
            part.largest = off.maxCoeff();
        }
        if (2 * resized <= all.size()) {
            if (thin.empty()) thin = thin_faces(rest.mesh, edited, now);
            double area = 0, of_thin = 0;
            for (const Index f : annotation.faces) {
                area += face_area(now, Face(f));
                if (thin[f]) of_thin += face_area(now, Face(f));
            }
            part.thin = area > 0 ? of_thin / area : 0;
        }
        part.distorted = part.distance > limit;
        part.thinned = part.thin > most_thin;
        if (part.distorted || part.thinned) parts.push_back(part);
    }
    std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.distance > b.distance; });
    return parts;
}

}  // namespace ostraka::semantic
