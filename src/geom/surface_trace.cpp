#include "ostraka/geom/surface_trace.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/distance.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

SurfaceCurve curve_through(const Mesh& mesh, const std::vector<SurfacePoint>& points) {
    SurfaceCurve curve;
    curve.points = points;
    curve.faces.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        check_surface_point(mesh, points[i]);
        if (i == 0) continue;
        curve.faces.push_back(shared_face(mesh, points[i - 1], points[i]));
        if (curve.faces.back() == no_index)
            fail_input("a curve", fmt::format("its places {} and {} lie in no common face", i - 1, i),
                       "neighbours on a curve must share a face: add the places where it crosses edges");
    }
    return curve;
}

double SurfaceCurve::length(const Mesh& mesh) const {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) sum += distance(position(mesh, points[i]), position(mesh, points[i + 1]));
    return sum;
}

namespace {

/// The faces around a point of a trace, and the plane that it follows.
struct TracePlane {
    const Mesh& mesh;
    Point origin;
    Vector along, across;
    [[nodiscard]] double side(Vertex v) const { return (mesh.point(v) - origin) * across; }
};

/// An exit from a face: a point on its boundary that has no common edge with the point at which the trace entered the face.
struct Exit {
    SurfacePoint point;
    Face face;
    double progress = 0;
};

/// The farthest exit from the faces around the end of the curve, except the face in which it arrived.
std::optional<Exit> farthest_exit(const TracePlane& plane, const SurfaceCurve& curve, const std::vector<Face>& around,
                                  Face came_from) {
    constexpr double snap = 1e-6;
    const Mesh& mesh = plane.mesh;
    const SurfacePoint& from = curve.points.back();
    const Point start = position(mesh, from);
    const auto leads_back = [&](const SurfacePoint& p) {
        return same_point(mesh, p, from) ||
               (curve.points.size() > 1 && same_point(mesh, p, curve.points[curve.points.size() - 2]));
    };
    const auto holds_start = [&](Halfedge h) {
        const Index source = mesh.source(h), target = mesh.target(h);
        if (from.is_vertex()) return source == from.element[0] || target == from.element[0];
        return from.is_on_edge() && std::minmax(source, target) == std::minmax(from.element[0], from.element[1]);
    };
    std::optional<Exit> best;
    for (const Face f : around) {
        if (f == came_from) continue;
        for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(f), mesh)) {
            if (holds_start(h)) continue;
            const double a = plane.side(mesh.source(h)), b = plane.side(mesh.target(h));
            if ((a > 0) == (b > 0) && a != 0 && b != 0) continue;
            const double t = a == b ? 0.5 : std::clamp(a / (a - b), 0.0, 1.0);
            Exit exit{surface_point(mesh, h, t, snap), f};
            exit.progress = (position(mesh, exit.point) - start) * plane.along;
            if (!leads_back(exit.point) && (!best || exit.progress > best->progress)) best = exit;
        }
    }
    return best;
}

}  // namespace

std::optional<SurfaceCurve> trace_line(const Mesh& mesh, const SurfacePoint& from, const SurfacePoint& to, const Vector& up,
                                       double limit) {
    SurfaceCurve curve;
    curve.points.push_back(from);
    if (same_point(mesh, from, to)) return curve;
    const Point origin = position(mesh, from), goal = position(mesh, to);
    TracePlane plane{mesh, origin, goal - origin, {0, 0, 0}};
    plane.across = CGAL::cross_product(plane.along, up);
    const double length = std::sqrt(plane.across.squared_length());
    if (!(length > 0)) return std::nullopt;
    plane.across = plane.across / length;
    const std::vector<Face> goal_faces = faces_of(mesh, to);
    double travelled = 0;
    Face came_from = Mesh::null_face();
    for (int steps = 0; steps < 100000; ++steps) {
        const Point start = position(mesh, curve.points.back());
        const std::vector<Face> around = faces_of(mesh, curve.points.back());
        const auto last = std::find_first_of(around.begin(), around.end(), goal_faces.begin(), goal_faces.end());
        if (last != around.end()) {
            if (travelled + distance(start, goal) > limit) return std::nullopt;
            curve.faces.push_back(*last);
            curve.points.push_back(to);
            return curve;
        }
        const std::optional<Exit> exit = farthest_exit(plane, curve, around, came_from);
        if (!exit) return std::nullopt;
        travelled += distance(start, position(mesh, exit->point));
        if (travelled > limit) return std::nullopt;
        curve.faces.push_back(exit->face);
        curve.points.push_back(exit->point);
        // Through an edge, the trace continues in the opposite face; at a vertex, all faces around it are candidates.
        came_from = exit->point.is_vertex() ? Mesh::null_face() : exit->face;
    }
    return std::nullopt;
}

}  // namespace ostraka
