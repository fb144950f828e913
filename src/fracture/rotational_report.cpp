#include "ostraka/fracture/rotational_report.h"

#include <algorithm>

namespace ostraka {

JsonValue joints_to_json(const BreakTurns& turns, const std::vector<std::string>& names, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const BreakJoint& joint : turns.joints) {
        JsonValue item(rapidjson::kObjectType);
        add_member(item, "first", names[static_cast<std::size_t>(joint.first)], allocator);
        add_member(item, "second", names[static_cast<std::size_t>(joint.second)], allocator);
        add_member(item, "turn", JsonValue(joint.turn), allocator);
        add_member(item, "score", JsonValue(joint.score), allocator);
        add_member(item, "contact", JsonValue(joint.contact), allocator);
        add_member(item, "rim", JsonValue(joint.rim), allocator);
        add_member(item, "residual", JsonValue(joint.residual), allocator);
        add_member(item, "carries", JsonValue(joint.carries), allocator);
        if (joint.carries) {
            add_member(item, "share", JsonValue(joint.share), allocator);
            add_member(item, "lead", JsonValue(joint.lead), allocator);
            add_member(item, "confidence", JsonValue(joint.confidence), allocator);
            add_member(item, "decided", JsonValue(joint.decided), allocator);
        }
        list.PushBack(item, allocator);
    }
    return list;
}

JsonValue turn_to_json(const BreakTurns& turns, std::size_t fragment, const std::vector<std::string>& names,
                       JsonAllocator& allocator) {
    JsonValue item(rapidjson::kObjectType), with(rapidjson::kArrayType);
    const int group = turns.group[fragment];
    for (std::size_t k = 0; k < turns.group.size(); ++k)
        if (k != fragment && turns.group[k] == group) with.PushBack(JsonValue(names[k], allocator), allocator);
    add_member(item, "decided", JsonValue(!with.Empty()), allocator);
    add_member(item, "holdsWith", std::move(with), allocator);
    add_member(item, "overlap", JsonValue(turns.overlap[fragment]), allocator);
    if (!turns.notes[fragment].empty()) add_member(item, "note", turns.notes[fragment], allocator);
    return item;
}

}  // namespace ostraka
