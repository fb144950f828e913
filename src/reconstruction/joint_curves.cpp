#include "reconstruction/joint_curves.h"

#include "ostraka/geom/eigen.h"

#include <algorithm>

namespace ostraka {

void JointCurves::add(int fragment, const Mesh& mesh, const std::vector<int>& labels, const std::vector<Facet>& facets,
                      const std::vector<bool>& ends, double scale) {
    const auto broken = [&](Face face) { return !facets.empty() && facets[face] == Facet::fracture; };
    for (const Edge e : mesh.edges()) {
        const Halfedge h = mesh.halfedge(e), g = mesh.opposite(h);
        if (mesh.is_border(h) || mesh.is_border(g)) continue;
        const Face a = mesh.face(h), b = mesh.face(g);
        if (labels[a] == labels[b] || broken(a) || broken(b)) continue;
        const Vertex from = mesh.source(h), to = mesh.target(h);
        const Vector3d begin = eigen(mesh.point(from)) / scale, end = eigen(mesh.point(to)) / scale;
        if (!((end - begin).squaredNorm() > 0)) continue;
        segments_[std::minmax(labels[a], labels[b])].push_back({fragment, a, begin, end, ends[from], ends[to]});
    }
}

std::optional<JointCurves::Place> JointCurves::nearest(const Vector3d& place, const std::vector<int>& labels,
                                                       double search_radius) const {
    std::optional<Place> result;
    for (std::size_t a = 0; a < labels.size(); ++a)
        for (std::size_t b = a + 1; b < labels.size(); ++b) {
            const auto entry = segments_.find({labels[a], labels[b]});
            if (entry == segments_.end()) continue;
            for (const Segment& segment : entry->second) {
                const Vector3d edge = segment.to - segment.from;
                const double t = std::clamp((place - segment.from).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
                const Vector3d point = segment.from + t * edge;
                const double distance = (point - place).norm();
                if (!(distance < search_radius)) continue;
                search_radius = distance;
                const bool at_end = (t <= 0 && segment.from_ends) || (t >= 1 && segment.to_ends);
                result = {at_end ? VertexMatch() : VertexMatch{segment.fragment, segment.face, point, distance},
                          edge.normalized()};
            }
        }
    return result;
}

}  // namespace ostraka
