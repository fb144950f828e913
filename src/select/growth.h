// Growing and shrinking of selections, and discs painted with a brush.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// Adds all faces that share a vertex with the selection, `rings` times. `faces`: for each face, whether it is selected. The
/// border of an open mesh does not bound a selection: a selection of the whole mesh stays unchanged, and shrinking does not start
/// from the border.
std::vector<bool> grow(const Mesh& mesh, std::vector<bool> faces, int rings);
/// Removes the faces that the complement of the selection gains when the complement grows by `rings` rings.
std::vector<bool> shrink(const Mesh& mesh, std::vector<bool> faces, int rings);

/// Exact geodesic distance of each vertex from the nearest source, at least for all vertices that share a face with a vertex
/// within `limit` of a source; infinite for other vertices beyond the limit and for vertices that are not connected to a source.
std::vector<double> distances_within(const Mesh& mesh, const std::vector<Index>& sources, double limit);

/// Adds the faces whose corners have a mean exact geodesic distance of at most `distance` from the border of the selection.
std::vector<bool> grow_by(const Mesh& mesh, std::vector<bool> faces, double distance);
/// Removes the faces that the complement of the selection gains when the complement grows by `distance`.
std::vector<bool> shrink_by(const Mesh& mesh, std::vector<bool> faces, double distance);

/// Adds the neighbours of the vertices, `rings` times; returns vertices in ascending order.
std::vector<Index> grow_vertices(const Mesh& mesh, const std::vector<Index>& vertices, int rings);
/// Removes the vertices that the complement gains when the complement grows by `rings` rings; returns vertices in ascending
/// order.
std::vector<Index> shrink_vertices(const Mesh& mesh, const std::vector<Index>& vertices, int rings);

/// For each face, whether a brush of this radius, placed on the centre vertices, selects the face: its corners have a mean exact
/// geodesic distance of at most the radius from a centre.
std::vector<bool> brushed_faces(const Mesh& mesh, const std::vector<Index>& centres, double radius);
/// Vertices within the exact geodesic distance `radius` of a centre vertex, ascending.
std::vector<Index> brushed_vertices(const Mesh& mesh, const std::vector<Index>& centres, double radius);

}  // namespace ostraka
