// What a pair mode found, as a file.
#include "ostraka/core/json_build.h"
#include "ostraka/fracture/break_pair.h"
#include "ostraka/registration/pose_json.h"

namespace ostraka {

JsonValue pair_to_json(const BreakPair& pair, const std::string& a, const std::string& b, JsonAllocator& allocator) {
    JsonValue result(rapidjson::kObjectType), list(rapidjson::kArrayType);
    add_members(result, allocator, "format", "ostraka-pair", "version", 1, "first", a, "second", b, "verdict",
                pair.decided() ? "together" : "undecided");
    if (!pair.decided()) add_member(result, "because", pair.undecided, allocator);
    add_members(result, allocator, "confidence", pair.confidence, "size", pair.size, "fractureOfFirst", pair.fracture_a,
                "fractureOfSecond", pair.fracture_b, "tried", pair.tried);
    for (const PairCandidate& candidate : pair.candidates) {
        JsonValue entry = json_object(allocator, "pose", pose_to_json(candidate.pose, allocator), "score", candidate.score,
                                      "contact", candidate.contact, "rim", candidate.rim, "residual", candidate.residual,
                                      "penetration", candidate.penetration, "depth", candidate.depth);
        list.PushBack(entry, allocator);
    }
    add_member(result, "candidates", std::move(list), allocator);
    return result;
}

}  // namespace ostraka
