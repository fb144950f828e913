// Isotropic remeshing: a new mesh of the same surface, without correspondence to the old vertices.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <cstdint>

namespace ostraka {

struct RemeshOptions {
    std::uint64_t vertices = 0;  ///< target number of vertices
    int iterations = 3;          ///< rounds of splitting, collapsing, flipping, smoothing and projecting
    double feature_angle = 0;    ///< degrees; edges with a larger angle between their face normals are kept; 0 = none

    void describe(OptionList& visit);
};

struct RemeshResult {
    Mesh mesh;
    double target_edge_length = 0;  ///< in the mesh's unit
    std::size_t remeshed = 0;       ///< number of vertices before the adjustment
    bool reached = false;           ///< whether the target number was reached exactly
    double deviation = 0;           ///< maximum distance of the new vertices from the old surface, in the mesh's unit
};

/// Isotropic remeshing (Botsch and Kobbelt, "A remeshing approach to multiresolution modeling", 2004; the CGAL implementation)
/// to edges of equal length, projected onto the old surface, followed by a few collapses or halved edges to reach the number,
/// and a final projection. No property, annotation or index is carried over. Isolated vertices are removed. Deterministic.
/// Throws Error (input) for a mesh without area, or with triangles so thin that they would be split into too many pieces, Error
/// (usage) for an impossible number.
RemeshResult remesh(const Mesh& mesh, const RemeshOptions& options);

}  // namespace ostraka
