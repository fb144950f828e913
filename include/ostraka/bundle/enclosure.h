// Does a cage enclose a mesh?
#pragma once

#include "ostraka/core/mesh.h"

namespace ostraka {

struct Enclosure {
    bool closed = false;        ///< the cage has no border; otherwise nothing else is known
    bool outward = false;       ///< its faces are counter-clockwise seen from outside
    std::size_t outside = 0;    ///< vertices of the mesh outside the cage
    std::size_t touching = 0;   ///< vertices of the mesh on the cage
    bool intersecting = false;  ///< an edge or a face of the mesh crosses the cage though all of its vertices are inside

    [[nodiscard]] bool encloses() const { return closed && outside == 0 && touching == 0 && !intersecting; }
};

/// Exact for the coordinates as given (CGAL Side_of_triangle_mesh). Vertices without a face are left out.
Enclosure enclosure(const Mesh& cage, const Mesh& mesh);

}  // namespace ostraka
