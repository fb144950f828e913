// Which relationships of a graph hold on a mesh, and by how much the others fail.
#pragma once

#include "ostraka/relation/graph.h"

namespace ostraka {

enum class Verdict { holds, fails, unknown };
std::string to_string(Verdict verdict);

struct RelationCheck {
    Verdict verdict = Verdict::unknown;
    RelationParameters parameters;  ///< as measured on this mesh, with the tolerances that were asked for
    std::string text;               ///< why it fails or cannot be told
};

/// Checks each relationship of `graph`, in its order. Unknown are constraints, types that only experts can tell, and types whose
/// input is missing; `text` says what. Throws Error (input) if the graph does not fit the set.
std::vector<RelationCheck> check_relations(const Mesh& mesh, const AnnotationSet& set, const RelationGraph& graph);

}  // namespace ostraka
