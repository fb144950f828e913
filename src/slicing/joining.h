// Joins the segments in which a plane cuts faces to contours.
#pragma once

#include "ostraka/slicing/slice.h"

#include <algorithm>

namespace ostraka::detail {

/// Removes the degenerate segments of a contour (no length, or traversed back and forth), measures the contour and appends it;
/// does nothing if no segment remains.
void add_contour(std::vector<Contour>& contours, Contour contour);

/// Reverses the orientation of a contour: an outer contour becomes a hole.
void turn_around(Contour& contour);

/// Intersection of the plane at height `plane` with the edge of `h`: the end vertex on the plane, or a point between the ends.
/// `height` returns the height of a vertex.
template <class Height>
Eigen::Vector2d crossing(const Mesh& mesh, const SliceFrame& frame, Halfedge h, double plane, double tolerance,
                         const Height& height) {
    Vertex a = mesh.source(h), b = mesh.target(h);
    if (b < a) std::swap(a, b);  // both faces of the edge must give identical bits
    const double s = height(a) - plane, t = height(b) - plane;
    if (std::abs(s) <= tolerance) return frame.place(mesh.point(a));
    if (std::abs(t) <= tolerance) return frame.place(mesh.point(b));
    const Eigen::Vector2d from = frame.place(mesh.point(a)), to = frame.place(mesh.point(b));
    return from + s / (s - t) * (to - from);
}

/// The contours of one plane through the faces [begin, end), whose indices ascend and which have vertices both above and not
/// above the plane. `above` returns whether a vertex counts as above the plane, `place` the intersection of the plane with an
/// edge.
template <class Faces, class Above, class Place>
std::vector<Contour> join(const Mesh& mesh, Faces begin, Faces end, const Above& above, const Place& place) {
    const auto count = static_cast<std::size_t>(end - begin);
    // The material lies to the left of a segment that runs from the descending halfedge to the ascending one.
    std::vector<Index> next(count, no_index);
    std::vector<Halfedge> down(count), up(count);
    std::vector<bool> follows(count, false);
    for (std::size_t i = 0; i < count; ++i) {
        for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(Face(begin[static_cast<long>(i)])), mesh)) {
            const bool from = above(mesh.source(h)), to = above(mesh.target(h));
            if (from && !to) down[i] = h;
            if (to && !from) up[i] = h;
        }
        const Face other = mesh.face(mesh.opposite(up[i]));
        if (!other.is_valid()) continue;
        const auto neighbour = std::lower_bound(begin, end, other.idx());
        if (neighbour == end || *neighbour != other.idx()) continue;  // not in the selected part
        next[i] = static_cast<Index>(neighbour - begin);
        follows[next[i]] = true;
    }
    std::vector<Contour> contours;
    std::vector<bool> used(count, false);
    const auto follow = [&](std::size_t start, bool closed) {
        Contour contour;
        contour.closed = closed;
        std::size_t i = start;
        while (true) {
            used[i] = true;
            contour.points.push_back(place(down[i]));
            contour.faces.push_back(begin[static_cast<long>(i)]);
            if (next[i] == no_index || used[next[i]]) break;
            i = next[i];
        }
        if (!closed) contour.points.push_back(place(up[i]));
        add_contour(contours, std::move(contour));
    };
    for (std::size_t i = 0; i < count; ++i)
        if (!follows[i]) follow(i, false);
    for (std::size_t i = 0; i < count; ++i)
        if (!used[i]) follow(i, true);
    return contours;
}

}  // namespace ostraka::detail
