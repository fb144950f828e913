// Reports the axes of revolution of groups of joined fragments, and of single fragments.
#pragma once

#include "ostraka/files/json.h"
#include "ostraka/framework/report.h"
#include "ostraka/reassembly/reassembly.h"
#include "ostraka/revolution/group_axes.h"

#include <vector>

namespace ostraka {

/// Adds the axis of revolution of group `g` to the JSON entry `group` as "axis", and to each entry of `joins` whether the axes of
/// the two joined fragments agree. Adds a row to the printed report if the group is a vessel of revolution or if joins contradict
/// each other.
GroupAxis report_group_axis(Report& report, const std::vector<Fragment>& fragments, const Reassembly& result, int g,
                            JsonValue& group, JsonValue& joins, JsonAllocator& allocator);

/// For each fragment, its own axis of revolution if the fragment is not joined; `found` is false for joined fragments.
std::vector<GroupAxis> own_axes(const std::vector<Fragment>& fragments, const Reassembly& result);

/// Adds the axis of revolution of an unjoined fragment to its JSON entry, if the axis was found.
void report_own_axis(const GroupAxis& group_axis, JsonValue& entry, JsonAllocator& allocator);

}  // namespace ostraka
