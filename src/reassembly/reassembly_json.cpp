#include "ostraka/reassembly/reassembly_json.h"

#include "ostraka/core/error.h"
#include "ostraka/core/file.h"
#include "ostraka/core/json_build.h"
#include "ostraka/registration/pose_json.h"

#include <cstring>

namespace ostraka {

namespace {

constexpr double JoinEvidence::*evidence_members[] = {
    &JoinEvidence::area,        &JoinEvidence::share,       &JoinEvidence::coverage,     &JoinEvidence::residual,
    &JoinEvidence::relief,      &JoinEvidence::bending,     &JoinEvidence::grip,         &JoinEvidence::facing,
    &JoinEvidence::rim,         &JoinEvidence::rim_share,   &JoinEvidence::rim_coverage, &JoinEvidence::rim_step,
    &JoinEvidence::penetration, &JoinEvidence::depth,       &JoinEvidence::widths,       &JoinEvidence::side_turn,
    &JoinEvidence::side_step,   &JoinEvidence::side_length, &JoinEvidence::noise,        &JoinEvidence::edge,
    &JoinEvidence::roughness,   &JoinEvidence::axis,        &JoinEvidence::own_axis};
static_assert(std::size(evidence_members) == JoinEvidence::numbers, "what is not kept would be lost in a run that goes on");

double number_of(const JsonValue& value) {
    if (!value.IsNumber()) fail_input("pair", "holds something that is no number", "remove the file");
    return value.GetDouble();
}

}  // namespace

JsonValue pair_of_many_to_json(const PairOfMany& pair, JsonAllocator& allocator) {
    const auto of_candidate = [&](const PairCandidate& one) {
        std::vector<double> evidence;
        for (const auto member : evidence_members) evidence.push_back(one.evidence.*member);
        std::vector<double> pose;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) pose.push_back(one.pose.rotation(i, j));
        for (int i = 0; i < 3; ++i) pose.push_back(one.pose.translation[i]);
        return json_object(allocator, "pose", pose, "evidence", evidence, "numbers",
                           std::vector<double>{one.score, one.contact, one.rim, one.residual, one.penetration, one.depth});
    };
    return json_object(allocator, "confidence", pair.confidence, "candidates",
                       json_list(pair.candidates, allocator, of_candidate));
}

PairOfMany pair_of_many_from_json(const JsonValue& value, std::size_t first, std::size_t second) {
    const auto list = [](const JsonValue& of, const char* name, std::size_t size) -> const JsonValue& {
        if (!of.IsObject() || !of.HasMember(name) || !of[name].IsArray() || (size > 0 && of[name].Size() != size))
            fail_input("pair", std::string("has no list \"") + name + "\" as it should", "remove the file");
        return of[name];
    };
    PairOfMany pair{first, second, {}, 0};
    if (!value.IsObject() || !value.HasMember("confidence")) fail_input("pair", "has no confidence", "remove the file");
    pair.confidence = number_of(value["confidence"]);
    for (const JsonValue& from : list(value, "candidates", 0).GetArray()) {
        PairCandidate one;
        const JsonValue& pose = list(from, "pose", 12);
        for (int i = 0; i < 9; ++i) one.pose.rotation(i / 3, i % 3) = number_of(pose[static_cast<unsigned>(i)]);
        for (int i = 0; i < 3; ++i) one.pose.translation[i] = number_of(pose[static_cast<unsigned>(9 + i)]);
        const JsonValue& evidence = list(from, "evidence", std::size(evidence_members));
        for (unsigned k = 0; k < evidence.Size(); ++k) one.evidence.*evidence_members[k] = number_of(evidence[k]);
        const JsonValue& numbers = list(from, "numbers", 6);
        double* const to[] = {&one.score, &one.contact, &one.rim, &one.residual, &one.penetration, &one.depth};
        for (unsigned k = 0; k < 6; ++k) *to[k] = number_of(numbers[k]);
        one.log_odds = join_log_odds(one.evidence);
        pair.candidates.push_back(one);
    }
    return pair;
}

std::string fragment_checksum(const Fragment& fragment) {
    std::string bytes;
    const auto add = [&](const auto& value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        bytes.append(raw, sizeof value);
    };
    for (const Vertex v : fragment.mesh.vertices())
        for (int k = 0; k < 3; ++k) add(fragment.mesh.point(v)[k]);
    for (const Face f : fragment.mesh.faces())
        for (const Vertex v : corners(fragment.mesh, f)) add(static_cast<Index>(v));
    for (const Facet facet : fragment.facets) add(static_cast<std::uint8_t>(facet));
    return sha256(bytes);
}

JsonValue reassembly_to_json(const Reassembly& result, const std::vector<std::string>& names, JsonAllocator& allocator) {
    JsonValue groups(rapidjson::kArrayType);
    for (int g = 0; g < result.groups(); ++g) {
        std::vector<std::string> members;
        for (std::size_t k = 0; k < names.size(); ++k)
            if (result.group[k] == g) members.push_back(names[k]);
        groups.PushBack(json_object(allocator, "fragments", members), allocator);
    }
    const auto of_join = [&](const FragmentJoin& one) {
        return json_object(allocator, "first", names[one.first], "second", names[one.second], "group",
                           result.group[one.first] + 1, "confidence", one.confidence, "byTheTwoAlone", one.pair, "loops",
                           one.loops, "carries", one.carries, "contact", one.evidence.share, "rim", one.evidence.rim_share,
                           "penetration", one.evidence.penetration, "pose", pose_to_json(one.pose, allocator), "because",
                           one.reason);
    };
    const auto of_undone = [&](const UndoneJoin& one) {
        return json_object(allocator, "first", names[one.first], "second", names[one.second], "byTheTwoAlone", one.pair,
                           "because", one.reason);
    };
    return json_object(allocator, "groups", std::move(groups), "joins", json_list(result.joins, allocator, of_join), "undone",
                       json_list(result.undone, allocator, of_undone), "pairsTried", result.pairs_tried, "pairsLeft",
                       result.pairs_left);
}

}  // namespace ostraka
