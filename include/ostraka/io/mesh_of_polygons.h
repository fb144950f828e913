// Conversion of polygons to a manifold mesh.
#pragma once

#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// Triangulates and checks polygons as `read_mesh` does. `name`: file name for error messages.
MeshFile mesh_of_polygons(PolygonSoup polygons, const std::string& name);

/// The notes which tell that a surface was cut or turned over to be an oriented manifold.
std::vector<std::string> manifold_notes(const MeshFile& mesh);

}  // namespace ostraka
