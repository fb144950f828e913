// Automatic choice of the features whose constraints are met by seating: re-attaching the feature as a rigid detail.
#pragma once

#include "ostraka/relation/graph.h"
#include "ostraka/semantic/edit.h"

#include <vector>

namespace ostraka::semantic {

/// A graph in which constraints that do not specify how parts keep their shape seat the parts, if possible.
struct Seating {
    RelationGraph graph;      ///< only the constraints
    std::vector<int> seated;  ///< ids of the changed constraints
};

/// Seats the parts of "same level" and of "keep shape" that are ornaments: regions with one outline that rise above the plane of
/// the outline by at most half of its radius. Ornaments must not touch each other, and be in no other constraint except a
/// constraint on the whole. Constraints that specify `shapes` or `mode`, a leader, or heights as at rest, are unchanged.
Seating seat_ornaments(const HandleSpace& space, const RelationGraph& graph);

}  // namespace ostraka::semantic
