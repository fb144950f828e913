// More vertices by splitting edges, with everything that is bound to the mesh carried along.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"

#include <array>
#include <cstdint>
#include <vector>

namespace ostraka {

struct RefineOptions {
    std::uint64_t vertices = 0;  ///< wanted number of vertices, or 0
    int levels = 0;              ///< number of uniform subdivisions, or 0
    enum class Scheme { midpoint, loop, longest_edge } scheme = Scheme::midpoint;

    void describe(OptionList& visit);
};

struct RefineResult {
    std::vector<Index> face_origin;             ///< new face -> old face
    std::vector<Index> edge_origin;             ///< new edge -> old edge it is part of; no_index for edges inside old faces
    std::vector<std::array<Index, 2>> parents;  ///< vertex old_vertices + i was put between these two vertices (of smaller index)
    std::size_t old_vertices = 0;               ///< vertices below keep their index
    int levels = 0;                             ///< uniform subdivisions done
    std::size_t bisections = 0;                 ///< single edges halved after that
};

/// Splits edges until the wanted number of vertices, or after the wanted levels, is reached; exactly one of the two must be
/// given. Old vertices keep their index, and their place unless the scheme is loop. Values in property maps of types Index,
/// int, bool, double, float and std::uint8_t are carried along: halves of edges and parts of faces take the values of what they
/// were cut from; new vertices, and edges inside old faces, the map's default. Linear in the size of the result, but for sorting
/// by length. Deterministic. Throws Error (usage) if the mesh has more vertices than wanted, no edges to split, or the result
/// would be too large for 32-bit indices.
///
/// Sources: Rivara, "Algorithms for refining triangular grids suitable for adaptive and multigrid techniques", 1984 (halving
/// longest edges keeps angles bounded); Loop, "Smooth subdivision surfaces based on triangles", 1987.
RefineResult refine(Mesh& mesh, const RefineOptions& options);

}  // namespace ostraka
