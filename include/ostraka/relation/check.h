// Checks which relationships of a graph hold on a mesh, and measures the deviations.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/relation/graph.h"

namespace ostraka {

/// Default tolerances, for relationships that do not state a tolerance.
struct RelationOptions {
    double distance = 0.01;      ///< tolerance of distances and heights, as a share of the mesh's diagonal
    double angle = 5;            ///< tolerance of angles between axes, degrees
    double tilt = 20;            ///< tolerance of the tilt of a contact, degrees
    double max_difference = 10;  ///< tolerance of the relative difference of areas, shapes and attribute values, per cent

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

enum class Verdict { holds, fails, unknown };  ///< whether a relationship holds; unknown: cannot be determined
std::string to_string(Verdict verdict);

/// Result of checking one relationship.
struct RelationCheck {
    Verdict verdict = Verdict::unknown;  ///< whether the relationship holds
    RelationParameters parameters;       ///< deviations measured on this mesh, with the tolerances in effect
    std::string text;                    ///< why the relationship fails or cannot be determined; empty if it holds
};

/// Checks each relationship of `graph`, in the order of the graph. The verdict is unknown for constraints (see
/// judge_relationships), for types that cannot be computed from the geometry, and if required input is missing; `text` gives
/// the reason. Throws Error (input) if the graph refers to annotations that the set does not have.
std::vector<RelationCheck> check_relations(AnnotatedMeshView object, const RelationGraph& graph,
                                           const RelationOptions& options = {});

}  // namespace ostraka
