// Checks which relationships of a graph hold on a mesh, and measures the deviations of the others.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/relation/graph.h"

namespace ostraka {

/// Tolerances of relationships that do not have their own.
struct RelationOptions {
    double distance = 0.01;
    double angle = 5;
    double tilt = 20;
    double ratio = 10;

    void describe(OptionList& visit);
};

enum class Verdict { holds, fails, unknown };
std::string to_string(Verdict verdict);

struct RelationCheck {
    Verdict verdict = Verdict::unknown;
    RelationParameters parameters;  ///< measured on this mesh, with the tolerances in effect
    std::string text;               ///< why it fails or cannot be determined
};

/// Checks each relationship of `graph`, in its order. Unknown are constraints (see judge_relationships), types that only experts
/// can decide, and types whose input is missing; `text` gives the reason. Throws Error (input) if the graph does not fit the set.
std::vector<RelationCheck> check_relations(AnnotatedMeshView object, const RelationGraph& graph,
                                           const RelationOptions& options = {});

}  // namespace ostraka
