// Which constraints can be satisfied through the vertices of a cage (doc/cages.md, "What a cage can hold").
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/cage/cage.h"
#include "ostraka/semantic/deform.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// How closely a cage can satisfy one constraint. Lengths are in the mesh's unit.
struct ConstraintReach {
    int id = 0;  ///< id of the relationship
    std::string type;
    std::vector<int> annotations;
    /// Number of rows of the constraint's linear map B on the mesh's points, and rank of B W with the cage weights W, the
    /// number of independent ways in which the cage can change the rows. Singular values below a thousandth of the largest
    /// count as zero. If the rank equals the number of rows the cage can give the rows any values, and a remaining residual is
    /// due to the edit contradicting the constraint.
    std::size_t rows = 0, rank = 0;
    /// Root mean square distance of the rows from their projection, after the edit (`asked`) and after the solve through the
    /// cage (`left`). For the group of rows (for example, the shape of one part) that is worst relative to its tolerance.
    double asked = 0, left = 0;
    double tolerance = 0;                ///< tolerance of `left`: the distance tolerance relative to that group's own diagonal
    std::optional<int> lacking;          ///< the annotation of that group, if it is a single one
    Verdict verdict = Verdict::unknown;  ///< verdict on the constraint in its own quantities, after the solve
    std::vector<Deviation> deviations;
    bool reached = false;  ///< the rank equals the number of rows; or the constraint holds and `left` is within its tolerance
};

/// Solves for each constraint of the graph separately, as a hard constraint, over the vertices of the cage, after each of the
/// edits; returns the worst result for each constraint. Default edits: the object stretched by a tenth along x, y and z.
/// Constraints solved without the cage (seated parts) and constraints that cannot be evaluated are omitted. Throws as deform
/// does, and Error (usage) without a cage.
std::vector<ConstraintReach> cage_reach(const HandleSpace& space, const RelationGraph& graph, const Edit* edit = nullptr,
                                        const std::string& edit_name = "the edit",
                                        const RelationOptions& tolerances = deform_tolerances(),
                                        const std::string& graph_name = "graph");

struct CageForConstraints {
    CageResult made;
    std::vector<ConstraintReach> reach;  ///< for mean value coordinates
};

/// A cage that is denser around the parts of the constraints and, if necessary, closer to the mesh (down to a quarter of the
/// offset) and with up to twice the target number of vertices. Four variants are tried; returns the first that satisfies all
/// constraints, otherwise the one that satisfies most. Throws as make_cage and cage_reach do.
CageForConstraints make_cage_for(AnnotatedMeshView object, const RelationGraph& graph, const CageOptions& options,
                                 const std::optional<MirrorPlane>& mirror = {},
                                 const RelationOptions& tolerances = deform_tolerances(),
                                 const std::string& graph_name = "graph");

/// One sentence with the remaining residual, its initial value, and where control points are missing; empty if the constraint
/// is reached.
std::string describe(const ConstraintReach& reach, const AnnotationSet& set);

}  // namespace ostraka
