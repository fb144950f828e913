// Tests whether a mesh has a texture or colours.
#pragma once

#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// True if at least one face has a visible material: an image that could be read and texture coordinates, or a base colour
/// other than white.
bool has_texture(const MeshExtras& extras);
/// True if the mesh has colours of faces or vertices.
bool has_own_colours(const MeshExtras& extras);

}  // namespace ostraka
