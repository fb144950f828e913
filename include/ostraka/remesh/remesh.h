// A new mesh of the same surface whose vertices have nothing to do with the old ones.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"

#include <cstdint>

namespace ostraka {

struct RemeshOptions {
    std::uint64_t vertices = 0;  ///< wanted number of vertices
    int iterations = 3;          ///< rounds of splitting, collapsing, flipping, smoothing and projecting
    double feature_angle = 0;    ///< degrees; edges between faces that turn by more stay; 0 = none

    void describe(OptionList& visit);
};

struct RemeshResult {
    Mesh mesh;
    double target_edge_length = 0;  ///< in the mesh's unit
    std::size_t remeshed = 0;       ///< number of vertices before the adjustment
    bool reached = false;           ///< the wanted number was met exactly
    double deviation = 0;           ///< largest distance from the new vertices to the old surface, in the mesh's unit
};

/// Isotropic remeshing (Botsch and Kobbelt, "A remeshing approach to multiresolution modeling", 2004; the CGAL implementation) to
/// edges of equal length, projected onto the old surface, then a few collapses or halved edges to meet the number, and a last
/// projection. No property, annotation or index is carried over. Isolated vertices are dropped. Deterministic. Throws Error
/// (input) for a mesh without area or of needles so thin that cutting them up would never end, Error (usage) for an impossible
/// number.
RemeshResult remesh(const Mesh& mesh, const RemeshOptions& options);

}  // namespace ostraka
