// Checks which relationships of a graph hold on a mesh, and by how much the others deviate.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/relation/graph.h"

namespace ostraka {

/// Default tolerances, for relationships that state none.
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
    RelationParameters parameters;  ///< measured on this mesh, with the tolerances applied
    std::string text;               ///< why it fails or cannot be determined; empty if it holds
};

/// Checks each relationship of `graph`, in its order. The verdict is unknown for constraints (see judge_constraints), for types
/// that only experts can determine, and for types whose input is missing; `text` gives the reason. Throws Error (input) if the
/// graph does not match the set.
std::vector<RelationCheck> check_relations(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& graph,
                                           const RelationOptions& options = {});

}  // namespace ostraka
