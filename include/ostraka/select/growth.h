// Selections made larger and smaller, and discs drawn with a brush.
#pragma once

#include "ostraka/core/mesh.h"

#include <vector>

namespace ostraka {

/// The faces and those that share a vertex with them, so many times over. The border of an open mesh is no edge of a selection:
/// what covers the mesh stays as it is, and shrinking does not eat into it from there.
std::vector<bool> grow(const Mesh& mesh, std::vector<bool> faces, int rings);
/// What is left when the rest of the mesh grows by so many rings.
std::vector<bool> shrink(const Mesh& mesh, std::vector<bool> faces, int rings);

/// Exact geodesic distances of all vertices that share a face with one within `limit` of a source; infinite for others that are
/// farther, and where no curve arrives.
std::vector<double> distances_within(const Mesh& mesh, const std::vector<Index>& sources, double limit);

/// The faces and those whose corners are on average within an exact geodesic distance of their edge.
std::vector<bool> grow_by(const Mesh& mesh, std::vector<bool> faces, double distance);
/// What is left when the rest of the mesh grows by the distance.
std::vector<bool> shrink_by(const Mesh& mesh, std::vector<bool> faces, double distance);

/// The vertices and their neighbours, so many times over, ascending; what is left when the others grow.
std::vector<Index> grow_vertices(const Mesh& mesh, const std::vector<Index>& vertices, int rings);
std::vector<Index> shrink_vertices(const Mesh& mesh, const std::vector<Index>& vertices, int rings);

/// A brush of this radius set down on vertices: the faces whose corners are on average within this exact geodesic distance of one
/// of them, and the vertices that are (ascending).
std::vector<bool> brushed_faces(const Mesh& mesh, const std::vector<Index>& centres, double radius);
std::vector<Index> brushed_vertices(const Mesh& mesh, const std::vector<Index>& centres, double radius);

}  // namespace ostraka
