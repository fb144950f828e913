// Polygons as a manifold.
#pragma once

#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// What `read_mesh` makes of a file's polygons: triangulated, checked. `name`: of the file, for errors.
MeshFile mesh_of_polygons(PolygonSoup polygons, const std::string& name);

}  // namespace ostraka
