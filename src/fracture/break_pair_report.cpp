// What a pair mode found, as a file.
#include "ostraka/fracture/break_pair.h"
#include "ostraka/registration/pose_json.h"

namespace ostraka {

JsonValue pair_to_json(const BreakPair& pair, const std::string& a, const std::string& b, JsonAllocator& allocator) {
    JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType);
    add_member(result, "format", "ostraka-pair", allocator);
    add_member(result, "version", JsonValue(1), allocator);
    add_member(result, "first", a, allocator);
    add_member(result, "second", b, allocator);
    add_member(result, "verdict", pair.decided() ? "together" : "undecided", allocator);
    if (!pair.decided()) add_member(result, "because", pair.undecided, allocator);
    add_member(result, "confidence", JsonValue(pair.confidence), allocator);
    add_member(result, "size", JsonValue(pair.size), allocator);
    add_member(result, "fractureOfFirst", JsonValue(pair.fracture_a), allocator);
    add_member(result, "fractureOfSecond", JsonValue(pair.fracture_b), allocator);
    add_member(result, "tried", JsonValue(static_cast<std::uint64_t>(pair.tried)), allocator);
    for (const PairCandidate& candidate : pair.candidates) {
        JsonValue entry(rapidjson::kObjectType);
        add_member(entry, "pose", pose_to_json(candidate.pose, allocator), allocator);
        add_member(entry, "score", JsonValue(candidate.score), allocator);
        add_member(entry, "contact", JsonValue(candidate.contact), allocator);
        add_member(entry, "rim", JsonValue(candidate.rim), allocator);
        add_member(entry, "residual", JsonValue(candidate.residual), allocator);
        add_member(entry, "penetration", JsonValue(candidate.penetration), allocator);
        add_member(entry, "depth", JsonValue(candidate.depth), allocator);
        list.PushBack(entry, allocator);
    }
    add_member(result, "candidates", std::move(list), allocator);
    return result;
}

}  // namespace ostraka
