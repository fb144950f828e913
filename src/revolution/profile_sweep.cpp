#include "ostraka/core/angles.h"
#include "revolution/stages.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

AxisFrame frame_of(const Axis& axis) {
    AxisFrame frame;
    frame.foot = eigen(axis.point);
    frame.up = eigen(axis.direction);
    frame.u = frame.up.cross(std::abs(frame.up.x()) < 0.6 ? Vector3d::UnitX() : Vector3d::UnitY()).normalized();
    frame.w = frame.up.cross(frame.u);
    return frame;
}

void ProfileSweep::ring(const Vector2d& point) {
    Ring ring;
    ring.pole = point.x() < 1e-9 * edge_;
    const int count = ring.pole ? 1 : std::max(6, static_cast<int>(std::lround(2 * pi * point.x() / edge_)));
    for (int k = 0; k < count; ++k)
        ring.vertices.push_back(mesh_.add_vertex(
            point_of(frame_.foot + (lowest_ + point.y()) * frame_.up + point.x() * frame_.direction(2 * pi * k / count))));
    rings.push_back(std::move(ring));
}

void ProfileSweep::sew(std::size_t a, std::size_t b) {
    const auto &p = rings[a].vertices, &q = rings[b].vertices;
    const std::size_t n = rings[a].pole ? 0 : p.size(), m = rings[b].pole ? 0 : q.size();
    for (std::size_t i = 0, j = 0; i < n || j < m;) {
        const bool first = j >= m || (i < n && static_cast<double>(i + 1) / static_cast<double>(n) <=
                                                   static_cast<double>(j + 1) / static_cast<double>(m));
        if (first) {
            add(p[i], p[(i + 1) % n], q[j % q.size()]);
            ++i;
        } else {
            add(p[i % p.size()], q[(j + 1) % m], q[j]);
            ++j;
        }
    }
}

TriangleSoup ProfileSweep::soup() const {
    TriangleSoup result = to_soup(mesh_);
    result.triangles = triangles_;
    return result;
}

}  // namespace ostraka
