#include "remesh/seam_drift.h"

#include "remesh/collapse.h"

#include <algorithm>
#include <limits>

namespace ostraka {

namespace {

/// Share of the way from a to b at which a segment is nearest to p, and the squared distance.
std::pair<double, double> nearest_on(const Vector& a, const Vector& b, const Vector& p) {
    const Vector d = b - a;
    const double length = d.squared_length();
    const double share = length > 0 ? std::clamp((p - a) * d / length, 0.0, 1.0) : 0;
    return {share, (a + share * d - p).squared_length()};
}

}  // namespace

SeamDrift::SeamDrift(const Mesh& mesh, const Frame& frame, const std::vector<bool>& seams, double limit)
    : frame_(frame), seams_(seams), limit_(limit) {
    for (const Edge edge : mesh.edges()) {
        if (!seams[edge]) continue;
        const Halfedge h = mesh.halfedge(edge, 0);
        stretches_[edge] = {mesh.source(h), {frame.local(mesh.point(mesh.source(h))), frame.local(mesh.point(mesh.target(h)))}};
    }
}

std::vector<Edge> SeamDrift::seams_at(const Mesh& mesh, Vertex vertex, Edge without) const {
    std::vector<Edge> found;
    for_each_incoming(mesh, vertex, [&](Halfedge h) {
        if (const Edge edge = mesh.edge(h); edge != without && seams_[edge]) found.push_back(edge);
    });
    return found;
}

std::vector<Vector> SeamDrift::points_from(Edge edge, Vertex from) const {
    const Stretch& stretch = stretches_.at(edge);
    std::vector<Vector> points = stretch.points;
    if (Vertex(stretch.from) != from) std::reverse(points.begin(), points.end());
    return points;
}

bool SeamDrift::is_near(const std::vector<Vector>& points, const Vector& a, const Vector& b) const {
    return std::all_of(points.begin(), points.end(),
                       [&](const Vector& p) { return nearest_on(a, b, p).second <= limit_ * limit_; });
}

bool SeamDrift::keeps(const Mesh& mesh, Halfedge h, const Vector& x, bool pinned) {
    changed_.clear();
    erased_.clear();
    if (stretches_.empty()) return true;
    const Edge edge = mesh.edge(h);
    const Halfedge o = mesh.opposite(h);
    const Vertex u = mesh.source(h), v = mesh.target(h);
    const std::vector<Edge> before = seams_at(mesh, u, edge);
    if (!seams_[edge]) return before.empty() && (pinned || seams_at(mesh, v, edge).empty());
    if (before.size() != 1) return false;
    const auto far_end = [&](Edge e, Vertex end) {
        const Halfedge side = mesh.halfedge(e, 0);
        return mesh.source(side) == end ? mesh.target(side) : mesh.source(side);
    };
    const Vertex a = far_end(before[0], u);
    // The edge that joins a and v after the collapse.
    Edge kept = before[0];
    if (!mesh.is_border(h) && kept == mesh.edge(mesh.prev(h))) kept = mesh.edge(mesh.next(h));
    else if (!mesh.is_border(o) && kept == mesh.edge(mesh.next(o))) kept = mesh.edge(mesh.prev(o));
    std::vector<Vector> points = points_from(before[0], a);
    const auto append = [&](const std::vector<Vector>& more) { points.insert(points.end(), more.begin() + 1, more.end()); };
    append(points_from(edge, u));
    erased_ = {edge, before[0]};
    const Vector at_a = frame_.local(mesh.point(a));
    if (pinned) {
        if (!is_near(points, at_a, x)) return false;
        changed_.push_back({kept, {a, std::move(points)}});
        return true;
    }
    const std::vector<Edge> after = seams_at(mesh, v, edge);
    if (after.size() != 1) return false;
    append(points_from(after[0], v));
    const Vector at_b = frame_.local(mesh.point(far_end(after[0], v)));
    std::size_t split = 0;
    std::pair<double, double> nearest{0, std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        if (const auto here = nearest_on(points[i], points[i + 1], x); here.second < nearest.second) nearest = here, split = i;
    const Vector middle = points[split] + nearest.first * (points[split + 1] - points[split]);
    std::vector<Vector> first(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(split) + 1), second{middle};
    first.push_back(middle);
    second.insert(second.end(), points.begin() + static_cast<std::ptrdiff_t>(split) + 1, points.end());
    if (!is_near(first, at_a, x) || !is_near(second, x, at_b)) return false;
    changed_.push_back({kept, {a, std::move(first)}});
    changed_.push_back({after[0], {v, std::move(second)}});
    return true;
}

void SeamDrift::apply() {
    for (const Index edge : erased_) stretches_.erase(edge);
    for (auto& [edge, stretch] : changed_) stretches_[edge] = std::move(stretch);
    changed_.clear();
    erased_.clear();
}

}  // namespace ostraka
