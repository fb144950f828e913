// The two ways of cutting: every triangle into four, or one edge into two.
#pragma once

#include "ostraka/remesh/refine.h"

namespace ostraka {

/// Cuts every triangle into four in place. Edge e becomes e and E + e; face f becomes the middle one f and the corners F + 3 f +
/// k; the middle of edge e is vertex V + e. With `smooth`, points move as Loop's scheme has it. Keeps `result` up to date.
void cut_into_four(Mesh& mesh, bool smooth, RefineResult& result);

/// Halves the longest edges, the longest first, until the mesh has `vertices` vertices.
void halve_longest_edges(Mesh& mesh, std::size_t vertices, RefineResult& result);

}  // namespace ostraka
