// Refines a mesh by splitting edges; values in the mesh's property maps are preserved.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace ostraka {

struct RefineOptions {
    std::uint64_t vertices = 0;  ///< target number of vertices; 0: `levels` is given instead
    int levels = 0;              ///< number of uniform subdivisions; 0: `vertices` is given instead
    /// Scheme of refinement: determines which edges are split and where the new vertices lie.
    enum class Scheme { midpoint, loop, longest_edge } scheme = Scheme::midpoint;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

struct RefineResult {
    std::vector<Index> face_origin;  ///< for each new face, the old face that contains it
    std::vector<Index> edge_origin;  ///< for each new edge, the old edge that contains it; no_index for edges inside old faces
    /// For each new vertex old_vertices + i, the two vertices (of smaller index) between which it was inserted.
    std::vector<std::array<Index, 2>> parents;
    std::size_t old_vertices = 0;  ///< number of old vertices; they keep their indices
    int levels = 0;                ///< number of uniform subdivisions that were made
    std::size_t bisections = 0;    ///< number of single edges that were split after the subdivisions
};

/// Splits edges until the target number of vertices, or the requested number of levels, is reached; exactly one of the two must
/// be given. Old vertices keep their indices and, unless the scheme is loop, their positions. Values in property maps of types
/// Index, int, bool, double, float and std::uint8_t are preserved: parts of an edge or face get the value of that edge or face;
/// new vertices, and edges inside old faces, get the default value of the map. Time: linear in the size of the result, except
/// for sorting by length. The result is deterministic. Throws Error (usage) if the mesh has more vertices than requested, no
/// edges to split, or if the result would be too large for 32-bit indices.
///
/// Sources: Rivara, "Algorithms for refining triangular grids suitable for adaptive and multigrid techniques", 1984 (halving
/// longest edges keeps angles bounded); Loop, "Smooth subdivision surfaces based on triangles", 1987.
RefineResult refine(Mesh& mesh, const RefineOptions& options);

}  // namespace ostraka
