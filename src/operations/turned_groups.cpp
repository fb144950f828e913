#include "operations/turned_groups.h"

#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

JsonValue axis_to_json(const Axis& axis, JsonAllocator& allocator) {
    JsonValue value = json_object(allocator, "found", axis.found);
    if (!axis.found) {
        if (!axis.reason.empty()) add_members(value, allocator, "reason", axis.reason);
        return value;
    }
    const auto triple = [](const auto& v) { return std::vector<double>{v.x(), v.y(), v.z()}; };
    add_members(value, allocator, "through", triple(axis.point), "direction", triple(axis.direction));
    return value;
}

}  // namespace

GroupAxis report_group_axis(Report& report, const std::vector<Fragment>& fragments, const Reassembly& result, int g,
                            JsonValue& group, JsonValue& joins, JsonAllocator& allocator) {
    std::vector<Fragment> placed;
    std::vector<std::size_t> index_in_group(fragments.size(), 0);
    for (std::size_t k = 0; k < fragments.size(); ++k) {
        if (result.group[k] != g) continue;
        index_in_group[k] = placed.size();
        Fragment& fragment = placed.emplace_back();
        fragment.name = fragments[k].name;
        fragment.mesh = moved(fragments[k].mesh, result.poses[k]);
        fragment.facets = fragments[k].facets;
    }
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    std::vector<rapidjson::SizeType> entries;
    for (std::size_t j = 0; j < result.joins.size(); ++j) {
        const FragmentJoin& join = result.joins[j];
        if (result.group[join.first] != g) continue;
        pairs.emplace_back(index_in_group[join.first], index_in_group[join.second]);
        entries.push_back(static_cast<rapidjson::SizeType>(j));
    }
    GroupAxis group_axis = axis_of_group(placed, pairs);
    JsonValue axis = axis_to_json(group_axis.axis, allocator);
    add_members(axis, allocator, "round", group_axis.round);
    if (group_axis.axis.found) {
        add_members(axis, allocator, "directionError", group_axis.direction_error, "placeError", group_axis.place_error);
        if (group_axis.diameter > 0) add_members(axis, allocator, "largestDiameter", group_axis.diameter);
        JsonValue fragment_entries(rapidjson::kArrayType);
        for (const SherdOnProfile& sherd : group_axis.fragments) {
            JsonValue entry = json_object(allocator, "name", sherd.name, "use", to_string(sherd.use), "own", sherd.axis.found);
            if (sherd.axis.found)
                add_members(entry, allocator, "lean", sherd.lean, "aside", sherd.aside / group_axis.diagonal, "weight",
                            sherd.weight);
            if (!sherd.reason.empty()) add_members(entry, allocator, "reason", sherd.reason);
            fragment_entries.PushBack(entry, allocator);
        }
        add_members(axis, allocator, "fragments", fragment_entries);
    }
    add_members(group, allocator, "axis", axis);
    std::size_t agree = 0, determined = 0;
    const std::string name = "group-" + std::to_string(g + 1);
    std::vector<std::string> contradictions;
    for (std::size_t i = 0; i < group_axis.joins.size(); ++i) {
        const JoinAxes& join = group_axis.joins[i];
        JsonValue entry = json_object(allocator, "agree", to_string(join.agree));
        if (join.agree != AxesAgree::unknown) {
            add_members(entry, allocator, "angle", join.angle, "offset", join.offset);
            ++determined;
            agree += join.agree == AxesAgree::yes ? 1 : 0;
        }
        add_members(joins[entries[i]], allocator, "axes", entry);
        // For groups that are not surfaces of revolution, axes carry no information.
        if (group_axis.axis.found && join.agree == AxesAgree::no)
            contradictions.push_back(fmt::format(
                "{} and {} are joined, but their axes contradict each other: {} degrees and {} % of the group's diagonal apart",
                printable(placed[join.first].name), printable(placed[join.second].name), number(join.angle, 2),
                number(100 * join.offset, 2)));
    }
    if (group_axis.axis.found)
        report.line(fmt::format(
            "{} is a surface of revolution: {} % of its surface is round about one axis, whose direction is known to {} "
            "degrees{}{}",
            name, number(100 * group_axis.round, 3), number(group_axis.direction_error, 2),
            group_axis.diameter > 0 ? "; largest diameter " + number(group_axis.diameter, 4) : "",
            determined > 0 ? fmt::format("; in {} of {} joins where both fragments have an axis, these agree", agree, determined)
                           : ""));
    for (const std::string& text : contradictions) report.line(text);
    return group_axis;
}

std::vector<GroupAxis> own_axes(const std::vector<Fragment>& fragments, const Reassembly& result) {
    std::vector<GroupAxis> axes(fragments.size());
    parallel_for(fragments.size(), 1, [&](std::size_t k) {
        if (result.group[k] < 0 && fragments[k].mesh.number_of_faces() > 0) axes[k] = axis_of_group({fragments[k]}, {});
    });
    return axes;
}

void report_own_axis(const GroupAxis& group_axis, JsonValue& entry, JsonAllocator& allocator) {
    if (!group_axis.axis.found) return;
    JsonValue axis = axis_to_json(group_axis.axis, allocator);
    add_members(axis, allocator, "directionError", group_axis.direction_error, "largestDiameter", group_axis.diameter,
                "diameterError", 2 * group_axis.place_error);
    add_members(entry, allocator, "axis", axis);
}

}  // namespace ostraka
