// Cages of annotated parts, to be nested in that of the whole (coords/nested.h; doc/cages.md).
#pragma once

#include "ostraka/cage/cage.h"
#include "ostraka/relation/graph.h"

namespace ostraka {

/// The plane of a mirror symmetry of these annotations, in any order: as the graph has it, or where it tells none as it is on
/// this mesh. None where the graph holds no such relationship. Throws Error (input) where it says that there is one and there is
/// not.
std::optional<MirrorPlane> symmetry_plane(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& graph,
                                          std::vector<int> annotations, const std::string& graph_name);

struct PartCage {
    CageResult made;
    CageCheck check;  ///< around the part, cut out and closed
};

/// A cage around each of these regions (places in the set), cut out along their outlines and closed, with options.vertices and an
/// offset that is a share of the part's own diagonal. Of two that are in mirror symmetry one is made, around the part and the
/// image of the other, and mirrored; one that is symmetric by itself gets a symmetric cage. Throws as cut_out_part and make_cage.
std::vector<PartCage> make_part_cages(const Mesh& mesh, const AnnotationSet& set, const std::vector<std::size_t>& parts,
                                      const CageOptions& options, const RelationGraph& graph, const std::string& graph_name);

/// Cages in one mesh, in this order: a cage with others nested in it.
Mesh together(const std::vector<const Mesh*>& cages);

}  // namespace ostraka
