// Reports the axes of revolution of groups of joined fragments, and of single fragments.
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/framework/report.h"
#include "ostraka/reassembly/reassembly.h"
#include "ostraka/revolution/group_axes.h"

#include <vector>

namespace ostraka {

/// Adds the axis of group `g` to its entry as "axis", and to the entries of its joins whether the axes of the two fragments
/// agree. Adds a line for people if the group is a revolved vessel or if joins contradict each other.
GroupAxis report_group_axis(Report& report, const std::vector<Fragment>& fragments, const Reassembly& result, int g,
                            JsonValue& group, JsonValue& joins, JsonAllocator& allocator);

/// Axes of revolution of the fragments that are not joined; the other entries have `found` unset.
std::vector<GroupAxis> own_axes(const std::vector<Fragment>& fragments, const Reassembly& result);

/// Adds the axis of an unjoined fragment to its entry, if it has one.
void report_own_axis(const GroupAxis& group_axis, JsonValue& entry, JsonAllocator& allocator);

}  // namespace ostraka
