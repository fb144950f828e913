#include "ostraka/reassembly/reassembly_json.h"

#include "ostraka/core/error.h"
#include "ostraka/files/file.h"
#include "ostraka/files/json_build.h"
#include "ostraka/registration/pose_json.h"

#include <fmt/core.h>

#include <cstring>

namespace ostraka {

namespace {

constexpr double JoinEvidence::*evidence_members[] = {
    &JoinEvidence::area,        &JoinEvidence::share,       &JoinEvidence::coverage,        &JoinEvidence::residual,
    &JoinEvidence::relief,      &JoinEvidence::bending,     &JoinEvidence::stability,       &JoinEvidence::facing,
    &JoinEvidence::rim,         &JoinEvidence::rim_share,   &JoinEvidence::rim_coverage,    &JoinEvidence::rim_step,
    &JoinEvidence::penetration, &JoinEvidence::depth,       &JoinEvidence::width_log_ratio, &JoinEvidence::side_turn,
    &JoinEvidence::side_step,   &JoinEvidence::side_length, &JoinEvidence::noise,           &JoinEvidence::edge,
    &JoinEvidence::roughness,   &JoinEvidence::axis,        &JoinEvidence::own_axis};
static_assert(std::size(evidence_members) == JoinEvidence::numbers, "a member that is not stored would be lost in a resumed run");

double number_of(const JsonValue& value) {
    if (!value.IsNumber()) fail_input("pair", "contains a value that is not a number", "remove the file");
    return value.GetDouble();
}

}  // namespace

JsonValue pair_result_to_json(const PairResult& pair, JsonAllocator& allocator) {
    const auto candidate_to_json = [&](const PairCandidate& candidate) {
        std::vector<double> evidence;
        for (const auto member : evidence_members) evidence.push_back(candidate.evidence.*member);
        std::vector<double> pose;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) pose.push_back(candidate.pose.rotation(i, j));
        for (int i = 0; i < 3; ++i) pose.push_back(candidate.pose.translation[i]);
        return json_object(allocator, "pose", pose, "evidence", evidence, "numbers",
                           std::vector<double>{candidate.score, candidate.contact, candidate.rim, candidate.residual,
                                               candidate.penetration, candidate.depth});
    };
    return json_object(allocator, "confidence", pair.confidence, "candidates",
                       json_list(pair.candidates, allocator, candidate_to_json));
}

PairResult pair_result_from_json(const JsonValue& value, std::size_t first, std::size_t second) {
    const auto member_list = [](const JsonValue& object, const char* name, std::size_t size) -> const JsonValue& {
        if (!object.IsObject() || !object.HasMember(name) || !object[name].IsArray() || (size > 0 && object[name].Size() != size))
            fail_input("pair", fmt::format("has no list \"{}\" of the expected length", name), "remove the file");
        return object[name];
    };
    PairResult pair{first, second, {}, 0};
    if (!value.IsObject() || !value.HasMember("confidence")) fail_input("pair", "has no confidence", "remove the file");
    pair.confidence = number_of(value["confidence"]);
    for (const JsonValue& entry : member_list(value, "candidates", 0).GetArray()) {
        PairCandidate candidate;
        const JsonValue& pose = member_list(entry, "pose", 12);
        for (int i = 0; i < 9; ++i) candidate.pose.rotation(i / 3, i % 3) = number_of(pose[static_cast<unsigned>(i)]);
        for (int i = 0; i < 3; ++i) candidate.pose.translation[i] = number_of(pose[static_cast<unsigned>(9 + i)]);
        const JsonValue& evidence = member_list(entry, "evidence", std::size(evidence_members));
        for (unsigned k = 0; k < evidence.Size(); ++k) candidate.evidence.*evidence_members[k] = number_of(evidence[k]);
        const JsonValue& numbers = member_list(entry, "numbers", 6);
        double* const members[] = {&candidate.score,    &candidate.contact,     &candidate.rim,
                                   &candidate.residual, &candidate.penetration, &candidate.depth};
        for (unsigned k = 0; k < 6; ++k) *members[k] = number_of(numbers[k]);
        candidate.log_odds = join_log_odds(candidate.evidence);
        pair.candidates.push_back(candidate);
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
    const auto join_to_json = [&](const FragmentJoin& join) {
        return json_object(allocator, "first", names[join.first], "second", names[join.second], "group",
                           result.group[join.first] + 1, "confidence", join.confidence, "byTheTwoAlone", join.pair_probability,
                           "loops", join.loops, "carries", join.carries, "contact", join.evidence.share, "rim",
                           join.evidence.rim_share, "penetration", join.evidence.penetration, "pose",
                           pose_to_json(join.pose, allocator), "because", join.reason);
    };
    const auto rejected_to_json = [&](const RejectedJoin& rejected) {
        return json_object(allocator, "first", names[rejected.first], "second", names[rejected.second], "byTheTwoAlone",
                           rejected.pair_probability, "because", rejected.reason);
    };
    return json_object(allocator, "groups", std::move(groups), "joins", json_list(result.joins, allocator, join_to_json),
                       "undone", json_list(result.rejected, allocator, rejected_to_json), "pairsTried", result.pairs_tried,
                       "pairsLeft", result.pairs_left);
}

}  // namespace ostraka
