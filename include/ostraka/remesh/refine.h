// Refinement by splitting edges, with all attached data carried along.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace ostraka {

struct RefineOptions {
    std::uint64_t vertices = 0;  ///< target number of vertices, or 0
    int levels = 0;              ///< number of uniform subdivisions, or 0
    enum class Scheme { midpoint, loop, longest_edge } scheme = Scheme::midpoint;

    void describe(OptionList& visit);
};

struct RefineResult {
    std::vector<Index> face_origin;  ///< new face -> old face
    std::vector<Index> edge_origin;  ///< new edge -> old edge that contains it; no_index for edges inside old faces
    /// Vertex old_vertices + i was inserted between these two vertices (of smaller index).
    std::vector<std::array<Index, 2>> parents;
    std::size_t old_vertices = 0;  ///< vertices with a smaller index keep it
    int levels = 0;                ///< number of uniform subdivisions
    std::size_t bisections = 0;    ///< number of single edges halved afterwards
};

/// Splits edges until the target number of vertices, or the requested number of levels, is reached; exactly one of the two must
/// be given. Old vertices keep their index and, unless the scheme is loop, their position. Values in property maps of types
/// Index, int, bool, double, float and std::uint8_t are carried along: halves of edges and parts of faces take the values of the
/// element they were cut from; new vertices, and edges inside old faces, take the default of the map. Linear in the size of the
/// result, except for sorting by length. Deterministic. Throws Error (usage) if the mesh has more vertices than requested, no
/// edges to split, or if the result would be too large for 32-bit indices.
///
/// Sources: Rivara, "Algorithms for refining triangular grids suitable for adaptive and multigrid techniques", 1984 (halving
/// longest edges keeps angles bounded); Loop, "Smooth subdivision surfaces based on triangles", 1987.
RefineResult refine(Mesh& mesh, const RefineOptions& options);

}  // namespace ostraka
