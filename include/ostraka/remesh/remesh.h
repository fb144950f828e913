// Isotropic remeshing: a new mesh of the same surface, whose vertices do not correspond to the old vertices.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <cstdint>

namespace ostraka {

struct RemeshOptions {
    std::uint64_t vertices = 0;  ///< target number of vertices
    int iterations = 3;          ///< number of rounds of splitting, collapsing, flipping, smoothing and projecting
    /// Edges whose face normals differ by more than this angle (degrees) are preserved as features; 0: no edge is a feature.
    double feature_angle = 0;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

struct RemeshResult {
    Mesh mesh;                      ///< the new mesh
    double target_edge_length = 0;  ///< target edge length, in the mesh's unit
    std::size_t remeshed = 0;       ///< number of vertices before the final adjustment to the target number
    bool reached = false;           ///< true: the mesh has exactly the target number of vertices
    double deviation = 0;           ///< max distance of the new vertices from the old surface, in the mesh's unit
};

/// Isotropic remeshing to edges of equal length, projected onto the old surface (Botsch and Kobbelt, "A remeshing approach to
/// multiresolution modeling", 2004; the CGAL implementation), followed by a few collapses or splits of edges to reach the target
/// number of vertices, and a final projection. Properties, annotations and indices of the old mesh are not transferred.
/// Isolated vertices are removed. The result is deterministic. Throws Error (input) for a mesh without area, or with triangles
/// so thin that they would be split into too many pieces, Error (usage) for an impossible number of vertices.
RemeshResult remesh(const Mesh& mesh, const RemeshOptions& options);

}  // namespace ostraka
