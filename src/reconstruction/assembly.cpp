#include "ostraka/reconstruction/assembly.h"

#include "ostraka/files/json_build.h"

#include "ostraka/core/error.h"
#include "ostraka/registration/pose_json.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace ostraka {

namespace {

JsonValue placement_to_json(const FragmentPlacement& placement, JsonAllocator& allocator) {
    JsonValue entry(rapidjson::kObjectType);
    if (placement.problem.empty())
        add_members(entry, allocator, "pose", pose_to_json(placement.pose, allocator), "residual", placement.residual);
    else add_members(entry, allocator, "problem", placement.problem);
    if (placement.own_scale > 0) add_members(entry, allocator, "ownScale", placement.own_scale);
    const auto landmark_entry = [&](const LandmarkResidual& landmark) {
        return json_object(allocator, "name", landmark.name, "distance", landmark.distance, "used", landmark.used);
    };
    add_members(entry, allocator, "landmarks", json_list(placement.landmarks, allocator, landmark_entry));
    return entry;
}

/// The search result for a fragment's pose.
JsonValue search_to_json(const PoseSearchResult& search, JsonAllocator& allocator) {
    JsonValue entry = json_object(allocator, "decided", search.decided, "confidence", search.confidence, "margin", search.margin);
    if (!search.candidates.empty())
        add_members(entry, allocator, "score", search.candidates.front().score, "share", search.candidates.front().share);
    if (!search.reason.empty()) add_members(entry, allocator, "reason", search.reason);
    JsonValue slippable = json_object(allocator, "kind", to_string(search.slippable.kind));
    if (search.slippable.kind != SlippableKind::none)
        add_members(slippable, allocator, "text", search.slippable.text(), "point", search.slippable.point, "direction",
                    search.slippable.direction);
    const auto range_entry = [&](const SlippableRange& range) {
        return json_object(allocator, "turns", range.rotates, "min", range.minimum, "max", range.maximum);
    };
    add_members(slippable, allocator, "ways", json_list(search.slippable_ranges, allocator, range_entry));
    add_members(entry, allocator, "freedom", std::move(slippable));
    return entry;
}

JsonValue joint_to_json(const FractureJoint& joint, const std::vector<std::string>& names, JsonAllocator& allocator) {
    JsonValue item =
        json_object(allocator, "first", names[static_cast<std::size_t>(joint.first)], "second",
                    names[static_cast<std::size_t>(joint.second)], "turn", joint.rotation, "score", joint.score, "contact",
                    joint.contact, "rim", joint.rim, "residual", joint.residual, "carries", joint.carries);
    if (joint.carries)
        add_members(item, allocator, "share", joint.share, "lead", joint.lead, "confidence", joint.confidence, "decided",
                    joint.decided);
    return item;
}

/// Whether a fragment's rotation is decided, and with which other fragments.
JsonValue rotation_to_json(const RotationMatch& rotations, std::size_t fragment, const std::vector<std::string>& names,
                           JsonAllocator& allocator) {
    std::vector<std::string> partners;
    for (std::size_t k = 0; k < rotations.group.size(); ++k)
        if (k != fragment && rotations.group[k] == rotations.group[fragment]) partners.push_back(names[k]);
    JsonValue item =
        json_object(allocator, "decided", !partners.empty(), "holdsWith", partners, "overlap", rotations.overlap[fragment]);
    if (!rotations.notes[fragment].empty()) add_members(item, allocator, "note", rotations.notes[fragment]);
    return item;
}

JsonValue constraint_to_json(const ConstraintReport& constraint, JsonAllocator& allocator) {
    JsonValue deviations(rapidjson::kArrayType);
    for (std::size_t i = 0; i < constraint.deviations.size(); ++i) {
        const Deviation& d = constraint.deviations[i];
        JsonValue item = json_object(allocator, "quantity", d.quantity);
        if (i < constraint.before_values.size()) add_members(item, allocator, "before", constraint.before_values[i]);
        if (d.value) add_members(item, allocator, "value", *d.value);
        if (d.tolerance) add_members(item, allocator, "tolerance", *d.tolerance);
        add_members(item, allocator, "unit", d.unit);
        deviations.PushBack(item, allocator);
    }
    return json_object(allocator, "id", constraint.id, "type", constraint.type, "used", constraint.used, "before",
                       to_string(constraint.before), "verdict", to_string(constraint.verdict), "text", constraint.text,
                       "deviations", std::move(deviations));
}

JsonValue match_to_json(const AnnotationMatch& match, JsonAllocator& allocator) {
    return json_object(allocator, "ofFragment", match.fragment_annotation, "ofTemplate", match.template_annotation, "score",
                       match.score, "attributes", match.attributes, "containers", match.containers, "place", match.place,
                       "extent", match.extent, "stated", match.stated);
}

JsonValue objection_to_json(const Objection& objection, const std::vector<std::string>& names, JsonAllocator& allocator) {
    JsonValue item(rapidjson::kObjectType);
    if (objection.fragment >= 0) add_members(item, allocator, "fragment", names[static_cast<std::size_t>(objection.fragment)]);
    if (objection.constraint >= 0) add_members(item, allocator, "constraint", objection.constraint);
    add_members(item, allocator, "kind", to_string(objection.kind));
    if (objection.strain > 0) add_members(item, allocator, "strain", objection.strain);
    add_members(item, allocator, "text", objection.text);
    return item;
}

}  // namespace

JsonValue assembly_to_json(const Reconstruction& result, const AssemblyNames& names, JsonAllocator& allocator) {
    JsonValue fragments(rapidjson::kArrayType);
    for (std::size_t k = 0; k < result.placement.fragments.size(); ++k) {
        JsonValue entry = placement_to_json(result.placement.fragments[k], allocator);
        add_members(entry, allocator, "name", k < names.fragments.size() ? names.fragments[k] : std::to_string(k + 1));
        const bool searched = k < result.searched.size() && result.searched[k].has_value();
        if (searched || result.placement.fragments[k].problem.empty())
            add_members(entry, allocator, "source", searched ? "search" : "landmarks");
        if (searched) add_members(entry, allocator, "search", search_to_json(*result.searched[k], allocator));
        if (result.rotations && result.rotations->group[k] >= 0)
            add_members(entry, allocator, "turn", rotation_to_json(*result.rotations, k, names.fragments, allocator));
        const auto matches = k < result.annotations.size() ? result.annotations[k] : std::vector<AnnotationMatch>();
        add_members(entry, allocator, "annotations",
                    json_list(matches, allocator, [&](const AnnotationMatch& match) { return match_to_json(match, allocator); }),
                    "notes", k < result.notes.size() ? result.notes[k] : std::vector<std::string>());
        if (k < result.joined.size()) add_members(entry, allocator, "joinedFaces", result.joined[k]);
        fragments.PushBack(entry, allocator);
    }
    JsonValue assembly = json_object(allocator, "format", "ostraka-assembly", "version", 1, "template", names.template_file,
                                     "scale", result.placement.scale, "fragments", std::move(fragments));
    if (result.rotations) {
        const auto joint_entry = [&](const FractureJoint& joint) { return joint_to_json(joint, names.fragments, allocator); };
        add_members(assembly, allocator, "joints", json_list(result.rotations->joints, allocator, joint_entry), "wall",
                    result.rotations->wall);
    }
    const auto level_entry = [&](const NonRigidFit::Level& level) {
        return json_object(allocator, "smoothing", level.smoothing, "matched", level.matched, "residual", level.residual, "steps",
                           level.steps);
    };
    const auto note_entry = [&](const CompletionNote& note) {
        return json_value(names.fragments[static_cast<std::size_t>(note.fragment)] + ": " + note.text, allocator);
    };
    const auto constraint_entry = [&](const ConstraintReport& constraint) { return constraint_to_json(constraint, allocator); };
    const auto objection_entry = [&](const Objection& objection) {
        return objection_to_json(objection, names.fragments, allocator);
    };
    add_members(assembly, allocator, "levels", json_list(result.fit.levels, allocator, level_entry), "observedShare",
                result.observed_share, "crossings", result.crossings, "completionNotes",
                json_list(result.object.notes, allocator, note_entry), "constraints",
                json_list(result.constraints, allocator, constraint_entry), "objections",
                json_list(result.objections, allocator, objection_entry), "strain", result.strain, "verdict",
                to_string(result.verdict));
    if (!result.undecided.empty()) add_members(assembly, allocator, "undecided", result.undecided);
    return assembly;
}

namespace {

struct Statement {
    StatedMatch match;
    std::string place;  ///< JSON pointer
};

/// The statements on the fragment of this name, with their positions in the file.
std::vector<Statement> statements(const JsonValue& assembly, const std::string& fragment, const std::string& file) {
    validate(assembly, "assembly", file);
    std::map<std::string, std::string> entries;
    std::map<int, std::string> stated_ids;
    std::vector<Statement> result;
    const auto fragments = assembly["fragments"].GetArray();
    for (unsigned k = 0; k < fragments.Size(); ++k) {
        const std::string place = "/fragments/" + std::to_string(k), name = fragments[k]["name"].GetString();
        if (const auto [previous, inserted] = entries.emplace(name, place); !inserted)
            fail_input(file, fmt::format("at {}: fragment '{}' already has an entry, at {}", place, name, previous->second),
                       "keep one of them");
        const JsonValue* matches = find_member(fragments[k], "annotations");
        if (name != fragment || matches == nullptr) continue;
        for (unsigned i = 0; i < matches->Size(); ++i) {
            const JsonValue& item = (*matches)[i];
            const JsonValue *stated = find_member(item, "stated"), *of_template = find_member(item, "ofTemplate");
            if (stated == nullptr || !stated->GetBool()) continue;
            StatedMatch match{item["ofFragment"].GetInt(), {}};
            const std::string pointer = place + "/annotations/" + std::to_string(i),
                              subject =
                                  fmt::format("at {}: annotation {} of fragment '{}'", pointer, match.fragment_annotation, name);
            if (of_template == nullptr)
                fail_input(file, subject + " is stated without \"ofTemplate\"",
                           "give the id of the template's annotation, or null for none");
            if (const auto [previous, inserted] = stated_ids.emplace(match.fragment_annotation, pointer); !inserted)
                fail_input(file, fmt::format("{} is already stated, at {}", subject, previous->second), "keep one of them");
            if (!of_template->IsNull()) match.template_annotation = of_template->GetInt();
            result.push_back({match, pointer});
        }
    }
    return result;
}

}  // namespace

std::vector<StatedMatch> stated_matches(const JsonValue& assembly, const std::string& fragment, const std::string& file) {
    std::vector<StatedMatch> matches;
    for (const Statement& statement : statements(assembly, fragment, file)) matches.push_back(statement.match);
    return matches;
}

std::vector<StatedMatch> stated_matches(const JsonValue& assembly, const Fragment& fragment, const AnnotationSet& of_template,
                                        const std::string& file) {
    std::vector<StatedMatch> result;
    for (const auto& [match, place] : statements(assembly, fragment.name, file)) {
        const std::string prefix = "at " + place + ": ", fragment_name = "fragment '" + fragment.name + "'";
        const auto find = [&](const AnnotationSet& set, int id, const std::string& owner) {
            const Annotation* annotation = set.find(id);
            if (annotation == nullptr)
                fail_input(file, fmt::format("{}{} has no annotation {}", prefix, owner, id),
                           "list its ids with 'annotation list'");
            return annotation->type;
        };
        const AnnotationType theirs = find(fragment.annotations, match.fragment_annotation, fragment_name);
        if (match.template_annotation) {
            const AnnotationType ours = find(of_template, *match.template_annotation, "for " + fragment_name + ", the template");
            if (ours != theirs)
                fail_input(file,
                           fmt::format("{}matches a {} (annotation {} of {}) with a {} (annotation {} of the template)", prefix,
                                       to_string(theirs), match.fragment_annotation, fragment_name, to_string(ours),
                                       *match.template_annotation),
                           "match annotations of the same type");
        }
        result.push_back(match);
    }
    return result;
}

std::vector<std::string> unused_statements(const JsonValue& assembly, const std::vector<std::string>& fragments) {
    validate(assembly, "assembly", "assembly");
    std::vector<std::string> names;
    for (const auto& entry : assembly["fragments"].GetArray()) {
        const std::string name = entry["name"].GetString();
        const JsonValue* matches = find_member(entry, "annotations");
        if (matches == nullptr || std::find(fragments.begin(), fragments.end(), name) != fragments.end()) continue;
        const auto stated = [](const JsonValue& item) {
            const JsonValue* flag = find_member(item, "stated");
            return flag != nullptr && flag->GetBool();
        };
        if (std::any_of(matches->Begin(), matches->End(), stated)) names.push_back(name);
    }
    return names;
}

}  // namespace ostraka
