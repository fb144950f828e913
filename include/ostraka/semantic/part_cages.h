// Cages of annotated parts, nested in the cage of the whole object (coords/nested.h; doc/cages.md).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/cage/cage.h"
#include "ostraka/relation/graph.h"

namespace ostraka {

/// The mirror plane of a relationship "mirror symmetry" between these annotations, in any order: the plane stated in the graph
/// or, if the graph states no plane, the plane measured on this mesh. Returns nothing if the graph has no such relationship.
/// Throws Error (input) if the graph states a symmetry that does not exist.
std::optional<MirrorPlane> symmetry_plane(AnnotatedMeshView object, const RelationGraph& graph, std::vector<int> annotations,
                                          const std::string& graph_name);

/// A cage around a part.
struct PartCage {
    CageResult made;  ///< the cage, and remarks on its construction
    CageCheck check;  ///< result of checking the cage against the part, cut out and closed
};

/// Makes a cage around each of these regions (indices in the set), which are cut out along their outlines and closed. Each cage
/// has options.vertices vertices and an offset relative to the part's own diagonal. For two regions in mirror symmetry one cage
/// is made, around one part and the mirror image of the other, and mirrored; a region that is symmetric itself gets a symmetric
/// cage. Throws the same errors as cut_out_part and make_cage.
std::vector<PartCage> make_part_cages(AnnotatedMeshView object, const std::vector<std::size_t>& parts, const CageOptions& options,
                                      const RelationGraph& graph, const std::string& graph_name);

/// Joins nested cages in one mesh, in the order of the list: each cage is followed by the cages nested in it.
Mesh together(const std::vector<const Mesh*>& cages);

}  // namespace ostraka
