// Growing and shrinking of selections, and discs painted with a brush.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// Adds all faces that share a vertex with the selection, `rings` times. The border of an open mesh does not bound a selection:
/// a selection of the whole mesh stays unchanged, and shrinking does not start from the border.
std::vector<bool> grow(const Mesh& mesh, std::vector<bool> faces, int rings);
/// Removes what the complement gains when it grows by `rings` rings.
std::vector<bool> shrink(const Mesh& mesh, std::vector<bool> faces, int rings);

/// Exact geodesic distances, at least of all vertices that share a face with a vertex within `limit` of a source; infinite for
/// other vertices beyond the limit and for vertices that are not connected to a source.
std::vector<double> distances_within(const Mesh& mesh, const std::vector<Index>& sources, double limit);

/// Adds the faces whose corners have an average exact geodesic distance of at most `distance` from the border of the selection.
std::vector<bool> grow_by(const Mesh& mesh, std::vector<bool> faces, double distance);
/// Removes what the complement gains when it grows by the distance.
std::vector<bool> shrink_by(const Mesh& mesh, std::vector<bool> faces, double distance);

/// Adds the neighbours of the vertices `rings` times; returns vertices in ascending order. shrink_vertices: removes what the
/// complement gains when it grows.
std::vector<Index> grow_vertices(const Mesh& mesh, const std::vector<Index>& vertices, int rings);
std::vector<Index> shrink_vertices(const Mesh& mesh, const std::vector<Index>& vertices, int rings);

/// Selects with a brush of this radius placed on the centre vertices: the faces whose corners have an average exact geodesic
/// distance of at most the radius from a centre, or the vertices within that distance (ascending).
std::vector<bool> brushed_faces(const Mesh& mesh, const std::vector<Index>& centres, double radius);
std::vector<Index> brushed_vertices(const Mesh& mesh, const std::vector<Index>& centres, double radius);

}  // namespace ostraka
