// Which constraints on features of a surface can be met by seating them, chosen without being asked.
#pragma once

#include "ostraka/relation/graph.h"
#include "ostraka/semantic/edit.h"

#include <vector>

namespace ostraka::semantic {

/// A graph in which constraints that say nothing of how their parts keep their shape seat them, where that can be.
struct Seating {
    RelationGraph graph;      ///< the constraints alone
    std::vector<int> seated;  ///< ids of those that were changed
};

/// Seats the parts of "same level" and of "keep shape" that are ornaments: regions with one outline that rise above the plane of
/// it by at most half of its radius. They must not touch each other, and no other constraint may be about them, but one on the
/// whole. Constraints that state `shapes` or `mode`, a leader, or that heights stay as they are at rest, are left as they are.
Seating seat_ornaments(const HandleSpace& space, const RelationGraph& graph);

}  // namespace ostraka::semantic
