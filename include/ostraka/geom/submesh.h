// Some faces of a mesh as a mesh of its own.
#pragma once

#include "ostraka/core/mesh.h"

#include <vector>

namespace ostraka {

struct SubMesh {
    Mesh mesh;
    std::vector<Index> vertices;  ///< of the whole mesh, for each vertex
    std::vector<Index> faces;     ///< of the whole mesh, for each face, ascending
};

/// The faces marked in `keep` (one entry a face), or of them only the piece joined over edges that has the largest area (the one
/// with the lowest face of equal ones). A vertex at which they form several fans is there once for each. Empty where none is
/// marked. Throws Error (usage) if the marks are not one a face.
SubMesh keep_faces(const Mesh& mesh, const std::vector<bool>& keep, bool largest_only = false);

}  // namespace ostraka
