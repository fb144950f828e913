#include "turned_groups.h"

#include "ostraka/core/parallel.h"
#include "ostraka/core/text.h"

#include <algorithm>

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
    std::vector<std::size_t> place(fragments.size(), 0);
    for (std::size_t k = 0; k < fragments.size(); ++k) {
        if (result.group[k] != g) continue;
        place[k] = placed.size();
        Fragment& one = placed.emplace_back();
        one.name = fragments[k].name;
        one.mesh = moved(fragments[k].mesh, result.poses[k]);
        one.facets = fragments[k].facets;
    }
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    std::vector<rapidjson::SizeType> entries;
    for (std::size_t j = 0; j < result.joins.size(); ++j) {
        const FragmentJoin& join = result.joins[j];
        if (result.group[join.first] != g) continue;
        pairs.emplace_back(place[join.first], place[join.second]);
        entries.push_back(static_cast<rapidjson::SizeType>(j));
    }
    GroupAxis found = axis_of_group(placed, pairs);
    JsonValue axis = axis_to_json(found.axis, allocator);
    add_members(axis, allocator, "round", found.round);
    if (found.axis.found) {
        add_members(axis, allocator, "directionError", found.direction_error, "placeError", found.place_error);
        if (found.diameter > 0) add_members(axis, allocator, "largestDiameter", found.diameter);
        JsonValue list(rapidjson::kArrayType);
        for (const SherdOnProfile& one : found.fragments) {
            JsonValue entry = json_object(allocator, "name", one.name, "use", to_string(one.use), "own", one.axis.found);
            if (one.axis.found)
                add_members(entry, allocator, "lean", one.lean, "aside", one.aside / found.diagonal, "weight", one.weight);
            if (!one.reason.empty()) add_members(entry, allocator, "reason", one.reason);
            list.PushBack(entry, allocator);
        }
        add_members(axis, allocator, "fragments", list);
    }
    add_members(group, allocator, "axis", axis);
    std::size_t agree = 0, told = 0;
    const std::string name = "group-" + std::to_string(g + 1);
    std::vector<std::string> against;
    for (std::size_t i = 0; i < found.joins.size(); ++i) {
        const JoinAxes& join = found.joins[i];
        JsonValue entry = json_object(allocator, "agree", to_string(join.agree));
        if (join.agree != AxesAgree::unknown) {
            add_members(entry, allocator, "angle", join.angle, "offset", join.offset);
            ++told;
            agree += join.agree == AxesAgree::yes ? 1 : 0;
        }
        add_members(joins[entries[i]], allocator, "axes", entry);
        // For groups that are not surfaces of revolution, axes carry no information.
        if (found.axis.found && join.agree == AxesAgree::no)
            against.push_back(printable(placed[join.first].name) + " and " + printable(placed[join.second].name) +
                              " are joined, but their axes contradict each other: " + number(join.angle, 2) + " degrees and " +
                              number(100 * join.offset, 2) + " % of the group's diagonal apart");
    }
    if (found.axis.found)
        report.line(name + " was turned: " + number(100 * found.round, 3) +
                    " % of its surface is round about one axis, known to " + number(found.direction_error, 2) + " degrees" +
                    (found.diameter > 0 ? "; largest diameter " + number(found.diameter, 4) : "") +
                    (told > 0
                         ? "; in " + std::to_string(agree) + " of " + std::to_string(told) + " joins that tell, both agree in it"
                         : ""));
    for (const std::string& text : against) report.line(text);
    return found;
}

std::vector<GroupAxis> own_axes(const std::vector<Fragment>& fragments, const Reassembly& result) {
    std::vector<GroupAxis> axes(fragments.size());
    parallel_for(
        fragments.size(),
        [&](std::size_t k) {
            if (result.group[k] < 0 && fragments[k].mesh.number_of_faces() > 0) axes[k] = axis_of_group({fragments[k]}, {});
        },
        1);
    return axes;
}

void report_own_axis(const GroupAxis& found, JsonValue& entry, JsonAllocator& allocator) {
    if (!found.axis.found) return;
    JsonValue axis = axis_to_json(found.axis, allocator);
    add_members(axis, allocator, "directionError", found.direction_error, "largestDiameter", found.diameter, "diameterError",
                2 * found.place_error);
    add_members(entry, allocator, "axis", axis);
}

}  // namespace ostraka
