#include "ostraka/reconstruction/pose_searches.h"

#include "ostraka/core/error.h"
#include "ostraka/files/file.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/provenance.h"

#include <algorithm>

namespace ostraka {

struct PoseSearches::TemplateSearch {
    TemplateSearch(const Mesh& mesh, const PoseSearchOptions& options) : surface(mesh), search(surface, options) {}
    SurfaceSearch surface;
    PoseSearch search;
};

PoseSearches::PoseSearches(const Mesh& mesh, const PoseSearchOptions& options) : mesh_(mesh), options_(options) {
    std::string text = version() + '\n' + mesh_checksum(mesh);
    for (const auto& [name, value] : declare_options(options)) text += '\n' + name + '=' + value;
    template_key_ = sha256(text);
}
PoseSearches::~PoseSearches() = default;
PoseSearches::PoseSearches(PoseSearches&&) noexcept = default;

std::string PoseSearches::key_of(const Fragment& fragment, double min_scale, double max_scale) const {
    std::string text = template_key_ + '\n' + mesh_checksum(fragment.mesh) + '\n';
    for (const Facet facet : fragment.facets) text += facet == Facet::fracture ? '-' : '+';
    Json scales(rapidjson::kArrayType);
    scales.PushBack(min_scale, scales.GetAllocator()).PushBack(max_scale, scales.GetAllocator());
    return sha256(text + '\n' + to_text(scales));
}

std::optional<PoseSearchResult> PoseSearches::find(const Fragment& fragment, double min_scale, double max_scale) {
    const std::vector<bool> counts = intact_faces(fragment.facets);
    if (!counts.empty() && std::find(counts.begin(), counts.end(), true) == counts.end()) return {};
    const std::string key = key_of(fragment, min_scale, max_scale);
    if (const auto entry = stored_.find(key); entry != stored_.end()) {
        ++reused_;
        return entry->second.result;
    }
    if (!template_search_) template_search_ = std::make_unique<TemplateSearch>(mesh_, options_);
    PoseSearchResult result = template_search_->search.find(fragment.mesh, counts, min_scale, max_scale);
    ++made_;
    stored_.emplace(key, StoredSearch{fragment.name, result});
    return result;
}

namespace {

JsonValue to_json(const Motion& motion, JsonAllocator& allocator) {
    return json_object(allocator, "turn", motion.rotation.reshaped<Eigen::RowMajor>(), "shift", motion.translation, "scale",
                       motion.scale);
}

JsonValue to_json(const PoseSearchResult& result, JsonAllocator& allocator) {
    const auto candidate_entry = [&](const PoseCandidate& candidate) {
        return json_object(allocator, "pose", to_json(candidate.pose, allocator), "scale", candidate.scale, "score",
                           candidate.score, "share", candidate.share, "inside", candidate.inside, "residual", candidate.residual);
    };
    const auto range_entry = [&](const SlippableRange& range) {
        return json_object(allocator, "point", range.point, "direction", range.direction, "turns", range.rotates, "min",
                           range.minimum, "max", range.maximum);
    };
    JsonValue slippable = json_object(allocator, "kind", to_string(result.slippable.kind), "point", result.slippable.point,
                                      "direction", result.slippable.direction, "pitch", result.slippable.pitch);
    return json_object(allocator, "candidates", json_list(result.candidates, allocator, candidate_entry), "margin", result.margin,
                       "confidence", result.confidence, "decided", result.decided, "reason", result.reason, "freedom",
                       std::move(slippable), "ways", json_list(result.slippable_ranges, allocator, range_entry));
}

// The input is already validated against the schema.
Eigen::Vector3d vector_from(const JsonValue& numbers) {
    return {numbers[0].GetDouble(), numbers[1].GetDouble(), numbers[2].GetDouble()};
}
Motion motion_from(const JsonValue& entry) {
    Motion motion;
    for (int i = 0; i < 9; ++i) motion.rotation(i / 3, i % 3) = entry["turn"][static_cast<rapidjson::SizeType>(i)].GetDouble();
    motion.translation = vector_from(entry["shift"]);
    motion.scale = entry["scale"].GetDouble();
    return motion;
}
SlippableKind slippable_kind_from(const std::string& name) {
    for (const SlippableKind kind : {SlippableKind::none, SlippableKind::rotation, SlippableKind::translation,
                                     SlippableKind::helix, SlippableKind::cylinder, SlippableKind::sphere, SlippableKind::plane})
        if (to_string(kind) == name) return kind;
    return SlippableKind::more;
}
PoseSearchResult result_from(const JsonValue& entry) {
    PoseSearchResult result;
    for (const auto& item : entry["candidates"].GetArray())
        result.candidates.push_back({motion_from(item["pose"]), item["scale"].GetDouble(), item["score"].GetDouble(),
                                     item["share"].GetDouble(), item["inside"].GetDouble(), item["residual"].GetDouble()});
    result.margin = entry["margin"].GetDouble();
    result.confidence = entry["confidence"].GetDouble();
    result.decided = entry["decided"].GetBool();
    result.reason = entry["reason"].GetString();
    const JsonValue& slippable = entry["freedom"];
    result.slippable.kind = slippable_kind_from(slippable["kind"].GetString());
    result.slippable.point = vector_from(slippable["point"]);
    result.slippable.direction = vector_from(slippable["direction"]);
    result.slippable.pitch = slippable["pitch"].GetDouble();
    for (const auto& item : entry["ways"].GetArray())
        result.slippable_ranges.push_back({vector_from(item["point"]), vector_from(item["direction"]), item["turns"].GetBool(),
                                           item["min"].GetDouble(), item["max"].GetDouble()});
    return result;
}

}  // namespace

JsonValue PoseSearches::to_json(JsonAllocator& allocator) const {
    const auto stored_entry = [&](const auto& entry) {
        JsonValue result = ostraka::to_json(entry.second.result, allocator);
        const std::string checksum = sha256(to_text(result));
        return json_object(allocator, "fragment", entry.second.fragment, "key", entry.first, "checksum", checksum, "result",
                           std::move(result));
    };
    return json_object(allocator, "format", "ostraka-searches", "version", 1, "template", template_key_, "searches",
                       json_list(stored_, allocator, stored_entry));
}

std::size_t PoseSearches::add(const JsonValue& document, const std::string& file) {
    validate(document, "searches", file);
    std::size_t damaged = 0;
    if (document["template"].GetString() != template_key_) return damaged;
    for (const auto& entry : document["searches"].GetArray()) {
        if (sha256(to_text(entry["result"])) != entry["checksum"].GetString()) {
            ++damaged;
            continue;
        }
        PoseSearchResult result = result_from(entry["result"]);
        if (result.decided && result.candidates.empty()) ++damaged;
        else stored_.try_emplace(entry["key"].GetString(), StoredSearch{entry["fragment"].GetString(), std::move(result)});
    }
    return damaged;
}

}  // namespace ostraka
