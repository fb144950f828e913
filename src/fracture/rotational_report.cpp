#include "ostraka/fracture/rotational_report.h"
#include "ostraka/core/json_build.h"

#include <algorithm>

namespace ostraka {

JsonValue joints_to_json(const RotationMatch& rotations, const std::vector<std::string>& names, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const BreakJoint& joint : rotations.joints) {
        JsonValue item =
            json_object(allocator, "first", names[static_cast<std::size_t>(joint.first)], "second",
                        names[static_cast<std::size_t>(joint.second)], "turn", joint.rotation, "score", joint.score, "contact",
                        joint.contact, "rim", joint.rim, "residual", joint.residual, "carries", joint.carries);
        if (joint.carries) {
            add_members(item, allocator, "share", joint.share, "lead", joint.lead, "confidence", joint.confidence, "decided",
                        joint.decided);
        }
        list.PushBack(item, allocator);
    }
    return list;
}

JsonValue rotation_to_json(const RotationMatch& rotations, std::size_t fragment, const std::vector<std::string>& names,
                           JsonAllocator& allocator) {
    JsonValue item(rapidjson::kObjectType), with(rapidjson::kArrayType);
    const int group = rotations.group[fragment];
    for (std::size_t k = 0; k < rotations.group.size(); ++k)
        if (k != fragment && rotations.group[k] == group) with.PushBack(JsonValue(names[k], allocator), allocator);
    add_members(item, allocator, "decided", !with.Empty(), "holdsWith", std::move(with), "overlap", rotations.overlap[fragment]);
    if (!rotations.notes[fragment].empty()) add_member(item, "note", rotations.notes[fragment], allocator);
    return item;
}

}  // namespace ostraka
