// Post-processing of joined contours.
#pragma once

#include "ostraka/geom/circle.h"
#include "ostraka/slicing/slice.h"

namespace ostraka::detail {

/// Sorts and nests the contours of each slice, finds intersections, reverses contours whose orientation contradicts their
/// nesting, and sets the completeness of each slice. `is_whole_mesh`: no part of the mesh was left out. Returns whether all
/// contours were reversed because the mesh is closed and inside out. O(n log n), except for sorting the edges with overlapping
/// boxes; in parallel.
bool classify_contours(std::vector<Slice>& slices, const Mesh& mesh, bool is_whole_mesh);

/// Sets parent and depth of the closed contours, which come first, sorted by decreasing absolute area (nesting.cpp). Exact for
/// the given points, also where contours touch. O(n log n) for contours of similar size: a horizontal line through a point is
/// compared only with the edges of one thin strip.
void nest(std::vector<Contour>& contours);

struct Crossings {
    double doubtful = 0;          ///< as in Completeness
    std::vector<bool> cancelled;  ///< for each contour: it coincides with another contour of opposite orientation
};
/// Sets `crosses` of the closed contours, which come first (crossings.cpp). Contours that only touch (within `tolerance`, a
/// length) do not cross; two contours that coincide with the same orientation do. Edges are compared with those edges of their
/// strip (strips.h) whose boxes overlap theirs.
Crossings find_crossings(std::vector<Contour>& contours, double tolerance);

/// The circle of the open contours, if they are longer than the longest closed outer contour; otherwise none.
struct OpenArc {
    ArcFit fit;
    /// Fitted to contours that run counter-clockwise around their own circle; false if there are only others.
    bool outside = false;
};
OpenArc open_arc(const std::vector<Contour>& contours);

/// Completeness of a slice with these contours, except `doubtful` (completeness.cpp).
Completeness completeness(const std::vector<Contour>& contours);

/// Throws Error (input) for a mesh without faces, Error (usage) for a face that is not in it.
void check_faces(const Mesh& mesh, const std::vector<Index>& faces);

}  // namespace ostraka::detail
