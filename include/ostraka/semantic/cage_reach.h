// Determines which constraints can be satisfied by moving the vertices of a cage (doc/cages.md, "What a cage can hold").
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
    int id = 0;                    ///< id of the relationship
    std::string type;              ///< type of the relationship
    std::vector<int> annotations;  ///< ids of the constrained annotations
    /// Number of rows of the constraint's linear map B on the mesh's points, and rank of B W with the cage weights W: the
    /// number of degrees of freedom of the cage on these rows. Singular values below a thousandth of the largest count as zero.
    /// If the rank equals the number of rows, the cage can realise all values of the rows; a remaining residual is then due to
    /// an edit that contradicts the constraint.
    std::size_t rows = 0, rank = 0;
    /// Root mean square distance of the rows from their projection onto the constraint, after the edit (`distance_after_edit`)
    /// and after the solve over the cage vertices (`remaining_distance`). Both are given for the group of rows (for example, the
    /// shape of one part) with the largest distance relative to its tolerance.
    double distance_after_edit = 0, remaining_distance = 0;
    /// Max value of `remaining_distance` with which the constraint is satisfied: the relative distance tolerance times the
    /// diagonal of the group.
    double tolerance = 0;
    std::optional<int> lacking;  ///< id of the annotation to which the group belongs; empty: several annotations
    /// Whether the quantities that the constraint prescribes are within their tolerances after the solve.
    Verdict verdict = Verdict::unknown;
    std::vector<Deviation> deviations;  ///< deviations of the quantities that the constraint prescribes, after the solve
    bool reached = false;  ///< true: the rank equals the number of rows, or the constraint holds and `remaining_distance` is
                           ///< within `tolerance`
};

/// Solves for each constraint of the graph separately, as a hard constraint, over the vertices of the cage, after each step of
/// `edit`; returns the worst result for each constraint. Without an edit the object is stretched by a tenth along x, y and z in
/// turn. Constraints solved without the cage (seated parts) and constraints that cannot be evaluated are omitted. `edit_name` and
/// `graph_name` are used in errors. Throws the same errors as deform, and Error (usage) without a cage.
std::vector<ConstraintReach> cage_reach(const HandleSpace& space, const RelationGraph& graph, const Edit* edit = nullptr,
                                        const std::string& edit_name = "the edit",
                                        const RelationOptions& tolerances = deform_tolerances(),
                                        const std::string& graph_name = "graph");

/// A cage made for the constraints of a graph.
struct ConstraintCage {
    CageResult made;  ///< the cage, and remarks on its construction
    /// For each constraint, how closely the cage with mean value coordinates can satisfy it.
    std::vector<ConstraintReach> reach;
};

/// Makes a cage that is denser around the constrained parts and, if necessary, closer to the mesh (down to a quarter of the
/// offset) and with up to twice the target number of vertices. Four variants are tried; returns the first variant that satisfies
/// all constraints, otherwise the variant that satisfies the most constraints. Throws the same errors as make_cage and
/// cage_reach.
ConstraintCage make_cage_for_constraints(AnnotatedMeshView object, const RelationGraph& graph, const CageOptions& options,
                                         const std::optional<MirrorPlane>& mirror = {},
                                         const RelationOptions& tolerances = deform_tolerances(),
                                         const std::string& graph_name = "graph");

/// Message about a constraint that the cage cannot satisfy: the remaining residual, its initial value, and where cage vertices
/// are missing. Empty if the constraint is satisfied.
std::string describe(const ConstraintReach& reach, const AnnotationSet& set);

}  // namespace ostraka
