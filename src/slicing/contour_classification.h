// Nests, orients and checks the joined contours of slices.
#pragma once

#include "ostraka/geom/circle.h"
#include "ostraka/slicing/slice.h"

namespace ostraka::detail {

/// Sorts and nests the contours of each slice, finds intersections, reverses contours whose orientation contradicts their
/// nesting, and sets the completeness of each slice. `is_whole_mesh`: true if all faces of the mesh were sliced. Returns whether
/// all contours were reversed because the mesh is closed and inside out. Time: O(n log n), except for sorting the edges with
/// overlapping boxes; in parallel.
bool classify_contours(std::vector<Slice>& slices, const Mesh& mesh, bool is_whole_mesh);

/// Adds the pieces of the contour: one for each face that it crosses (completeness.cpp).
void add_pieces(PlaneSegments& segments, const Contour& contour);

/// Sets parent and depth of the closed contours, which come first in `contours`, sorted by decreasing absolute area
/// (nesting.cpp). Exact for the given points, also where contours touch. Time: O(n log n) for contours of similar size: a
/// horizontal line through a point is compared only with the edges of one thin strip.
void nest(std::vector<Contour>& contours);

/// Intersections of the contours of a slice.
struct Crossings {
    double doubtful = 0;          ///< affected share of the area, as in Completeness
    std::vector<bool> cancelled;  ///< for each contour, whether it coincides with another contour of opposite orientation
};
/// Sets `crosses` of the closed contours, which come first in `contours` (crossings.cpp). Contours that only touch (within
/// `tolerance`, a length) do not cross; two contours that coincide with the same orientation do. An edge is compared with the
/// edges of the same strip (strips.h) whose boxes overlap its box.
Crossings find_crossings(std::vector<Contour>& contours, double tolerance);

/// The circle on which the open contours lie.
struct OpenArc {
    ArcFit fit;  ///< the fitted circle
    /// True: fitted to contours that run counter-clockwise around their own circle; false: there are no such contours.
    bool outside = false;
};
/// The circle of the open contours, if they are longer than the longest closed outer contour; otherwise no circle.
OpenArc open_arc(const std::vector<Contour>& contours);

/// Completeness of a slice with these contours, without `doubtful` (completeness.cpp).
Completeness completeness(const std::vector<Contour>& contours);

/// Throws Error (input) for a mesh without faces, Error (usage) for a face index that the mesh does not have.
void check_faces(const Mesh& mesh, const std::vector<Index>& faces);

}  // namespace ostraka::detail
