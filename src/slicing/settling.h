// What is done with the contours of slices once they are joined.
#pragma once

#include "ostraka/geom/circle.h"
#include "ostraka/slicing/slice.h"

namespace ostraka::detail {

/// Sorts and nests the contours of each slice, finds those that cross, turns those around whose orientation is not that of their
/// nesting, and says how complete each slice is. `whole`: no part of the mesh was left out. Returns whether all contours were
/// turned around because the mesh is closed and inside out. O(n log n) but for a sorting of the edges whose boxes overlap; in
/// parallel.
bool settle(std::vector<Slice>& slices, const Mesh& mesh, bool whole);

/// Sets parent and depth of the closed contours, which stand in front, sorted by falling absolute area (nesting.cpp). Exact for
/// the points as given, also where contours touch. O(n log n) for contours of even size: a horizontal line through a point is
/// compared with the edges of one thin strip only.
void nest(std::vector<Contour>& contours);

struct Crossings {
    double doubtful = 0;          ///< as in Completeness
    std::vector<bool> cancelled;  ///< of each contour: it lies along another one that runs the other way round
};
/// Sets `crosses` of the closed contours, which stand in front (crossings.cpp). Contours that only touch (within `tolerance`, a
/// length) do not cross, whatever they share; two that lie along one another in the same sense count as crossing. Edges are
/// compared with those of their strip (strips.h) whose boxes overlap theirs.
Crossings find_crossings(std::vector<Contour>& contours, double tolerance);

/// The circle of the open contours, if they are longer than the longest closed outer contour; else none.
struct OpenArc {
    ArcFit fit;
    bool outside = false;  ///< of those that run counter-clockwise around their own circle; there are only others: of those
};
OpenArc open_arc(const std::vector<Contour>& contours);

/// How much of its outline a slice with these contours has: all but `doubtful` (completeness.cpp).
Completeness completeness(const std::vector<Contour>& contours);

/// Throws Error (input) for a mesh without faces, Error (usage) for a face that is not in it.
void check_faces(const Mesh& mesh, const std::vector<Index>& faces);

}  // namespace ostraka::detail
