// What a mesh file says of the look of its surface.
#pragma once

#include "ostraka/io/mesh_file.h"

namespace ostraka {

/// Whether a face has a material that is seen: an image that was read, with texture coordinates, or a colour other than white.
bool has_texture(const MeshExtras& extras);
/// Whether faces or vertices have colours of their own.
bool has_own_colours(const MeshExtras& extras);

}  // namespace ostraka
