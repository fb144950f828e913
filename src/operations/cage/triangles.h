// The triangles of a cage.
#pragma once

#include "operations/operations.h"

#include <fmt/core.h>

namespace ostraka {

/// The triangles of the cage; a note reports if its polygons were triangulated.
inline const Mesh& triangles_of_cage(const MeshInput& cage, Report& report) {
    if (!cage->polygon_of_triangle.empty())
        report.note(fmt::format("the cage's polygons were cut into {} triangles", cage->mesh.number_of_faces()));
    return cage->mesh;
}

}  // namespace ostraka
