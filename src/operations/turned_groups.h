// What groups of joined fragments, and single ones, say of an axis of revolution: for reports.
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/operation/report.h"
#include "ostraka/reassembly/reassembly.h"
#include "ostraka/revolution/group_axes.h"

#include <vector>

namespace ostraka {

/// The axis of group `g`, added to its entry as "axis", and to those of its joins whether the two agree in it; for people a line
/// where the group is a turned vessel, or joins contradict each other.
GroupAxis report_group_axis(Report& report, const std::vector<Fragment>& fragments, const Reassembly& result, int g,
                            JsonValue& group, JsonValue& joins, JsonAllocator& allocator);

/// Axes of revolution of the fragments that are alone; not found of the others.
std::vector<GroupAxis> own_axes(const std::vector<Fragment>& fragments, const Reassembly& result);

/// The axis of a fragment that is alone, added to its entry; nothing where it has none.
void report_own_axis(const GroupAxis& found, JsonValue& entry, JsonAllocator& allocator);

}  // namespace ostraka
