// Relationship graphs of an object that is moved, or converted to another unit.
#pragma once

#include "ostraka/geom/rigid_fit.h"
#include "ostraka/relation/graph.h"

#include <string>

namespace ostraka {

/// The relationship graph of an object after a motion of the object. Planes, axes, points and directions, including those in
/// the parameters of constraints, are transformed. Values and tolerances in the unit of the coordinates (`unit_before`), ranges
/// of 'keep measure' and absolute ranges of lengths, areas and volumes are scaled; their unit becomes `unit_after`. Ratios,
/// angles and percentages are unchanged.
RelationGraph moved_graph(const RelationGraph& graph, const Motion& motion, const std::string& unit_before,
                          const std::string& unit_after);

}  // namespace ostraka
