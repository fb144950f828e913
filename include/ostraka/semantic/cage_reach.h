// Which constraints the vertices of a cage can meet (doc/cages.md, "What a cage can hold").
#pragma once

#include "ostraka/cage/cage.h"
#include "ostraka/semantic/deform.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// How near a cage comes to what one constraint asks. Lengths are in the mesh's unit.
struct ConstraintReach {
    int id = 0;  ///< of the relationship
    std::string type;
    std::vector<int> annotations;
    /// Rows of the constraint's linear map B on the mesh's points, and the rank of B W, W the weights: in so many ways the cage
    /// can change them. Singular values below a thousandth of the largest count as zero. Where the rank is the number of rows the
    /// cage can give them any values, and what is left is what the edit asks against the constraint.
    std::size_t rows = 0, rank = 0;
    /// Root mean square distance of the rows from what they admit, where the edit leaves them and after the cage has done what it
    /// can. Of the group of rows (the shape of one part, say) that is farthest off against its tolerance.
    double asked = 0, left = 0;
    double tolerance = 0;                ///< for `left`: the tolerance of distances as a share of that group's own diagonal
    std::optional<int> lacking;          ///< the annotation that the group is of, if it is of one
    Verdict verdict = Verdict::unknown;  ///< in the constraint's own quantities, after the cage has done what it can
    std::vector<Deviation> deviations;
    bool reached = false;  ///< the rank is the number of rows; or the constraint holds, and `left` is within its tolerance
};

/// Solves for each constraint of the graph alone, hard, over the vertices of the cage, after each of the edits, and tells the
/// worst of them. Without an edit: the object stretched by a tenth along x, y and z. Constraints that are solved for without the
/// cage (seated parts) and those that nothing is known of are left out. Throws as deform does, and Error (usage) without a cage.
std::vector<ConstraintReach> cage_reach(const HandleSpace& space, const RelationGraph& graph, const JsonValue* edit = nullptr,
                                        const std::string& edit_name = "the edit",
                                        const RelationOptions& tolerances = deform_tolerances(),
                                        const std::string& graph_name = "graph");

struct CageForConstraints {
    CageResult made;
    std::vector<ConstraintReach> reach;  ///< through mean value coordinates
};

/// A cage that is denser where the constraints' parts are, and if need be lies nearer to the mesh (down to a quarter of the
/// offset) and has up to twice as many vertices as asked: of four that are tried, the first that reaches them all, or the one
/// that reaches most of them. Throws as make_cage and cage_reach do.
CageForConstraints make_cage_for(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& graph,
                                 const CageOptions& options, const std::optional<MirrorPlane>& mirror = {},
                                 const RelationOptions& tolerances = deform_tolerances(),
                                 const std::string& graph_name = "graph");

/// In one sentence: what is left, of how much, and where control points are missing; empty where it is reached.
std::string describe(const ConstraintReach& reach, const AnnotationSet& set);

}  // namespace ostraka
