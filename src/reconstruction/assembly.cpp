#include "ostraka/reconstruction/assembly.h"

#include "ostraka/core/json_build.h"

#include "ostraka/core/error.h"
#include "ostraka/registration/pose_json.h"

#include <algorithm>
#include <map>

namespace ostraka {

namespace {

JsonValue placement_of(const FragmentPlacement& one, JsonAllocator& allocator) {
    JsonValue entry(rapidjson::kObjectType);
    if (one.problem.empty()) add_members(entry, allocator, "pose", pose_to_json(one.pose, allocator), "residual", one.residual);
    else add_members(entry, allocator, "problem", one.problem);
    if (one.own_scale > 0) add_members(entry, allocator, "ownScale", one.own_scale);
    const auto of_landmark = [&](const LandmarkResidual& landmark) {
        return json_object(allocator, "name", landmark.name, "distance", landmark.distance, "used", landmark.used);
    };
    add_members(entry, allocator, "landmarks", json_list(one.landmarks, allocator, of_landmark));
    return entry;
}

/// The search result for a fragment's pose.
JsonValue search_of(const PoseSearchResult& one, JsonAllocator& allocator) {
    JsonValue entry = json_object(allocator, "decided", one.decided, "confidence", one.confidence, "margin", one.margin);
    if (!one.candidates.empty())
        add_members(entry, allocator, "score", one.candidates.front().score, "share", one.candidates.front().share);
    if (!one.reason.empty()) add_members(entry, allocator, "reason", one.reason);
    JsonValue slippable = json_object(allocator, "kind", to_string(one.slippable.kind));
    if (one.slippable.kind != SlippableKind::none)
        add_members(slippable, allocator, "text", one.slippable.text(), "point", one.slippable.point, "direction",
                    one.slippable.direction);
    const auto of_way = [&](const SlippableRange& way) {
        return json_object(allocator, "turns", way.rotates, "least", way.minimum, "most", way.maximum);
    };
    add_members(slippable, allocator, "ways", json_list(one.ways, allocator, of_way));
    add_members(entry, allocator, "freedom", std::move(slippable));
    return entry;
}

JsonValue joint_of(const BreakJoint& joint, const std::vector<std::string>& names, JsonAllocator& allocator) {
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
JsonValue rotation_of(const RotationMatch& rotations, std::size_t fragment, const std::vector<std::string>& names,
                      JsonAllocator& allocator) {
    std::vector<std::string> with;
    for (std::size_t k = 0; k < rotations.group.size(); ++k)
        if (k != fragment && rotations.group[k] == rotations.group[fragment]) with.push_back(names[k]);
    JsonValue item = json_object(allocator, "decided", !with.empty(), "holdsWith", with, "overlap", rotations.overlap[fragment]);
    if (!rotations.notes[fragment].empty()) add_members(item, allocator, "note", rotations.notes[fragment]);
    return item;
}

JsonValue constraint_of(const ConstraintReport& constraint, JsonAllocator& allocator) {
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

JsonValue match_of(const AnnotationMatch& match, JsonAllocator& allocator) {
    return json_object(allocator, "ofFragment", match.of_fragment, "ofTemplate", match.of_template, "score", match.score,
                       "attributes", match.attributes, "containers", match.containers, "place", match.place, "extent",
                       match.extent, "stated", match.stated);
}

JsonValue objection_of(const Objection& objection, const std::vector<std::string>& names, JsonAllocator& allocator) {
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
        JsonValue entry = placement_of(result.placement.fragments[k], allocator);
        add_members(entry, allocator, "name", k < names.fragments.size() ? names.fragments[k] : std::to_string(k + 1));
        const bool searched = k < result.searched.size() && result.searched[k].has_value();
        if (searched || result.placement.fragments[k].problem.empty())
            add_members(entry, allocator, "source", searched ? "search" : "landmarks");
        if (searched) add_members(entry, allocator, "search", search_of(*result.searched[k], allocator));
        if (result.rotations && result.rotations->group[k] >= 0)
            add_members(entry, allocator, "turn", rotation_of(*result.rotations, k, names.fragments, allocator));
        const auto matches = k < result.annotations.size() ? result.annotations[k] : std::vector<AnnotationMatch>();
        add_members(entry, allocator, "annotations",
                    json_list(matches, allocator, [&](const AnnotationMatch& match) { return match_of(match, allocator); }),
                    "notes", k < result.notes.size() ? result.notes[k] : std::vector<std::string>());
        if (k < result.joined.size()) add_members(entry, allocator, "joinedFaces", result.joined[k]);
        fragments.PushBack(entry, allocator);
    }
    JsonValue assembly = json_object(allocator, "format", "ostraka-assembly", "version", 1, "template", names.template_file,
                                     "scale", result.placement.scale, "fragments", std::move(fragments));
    if (result.rotations) {
        const auto of_joint = [&](const BreakJoint& joint) { return joint_of(joint, names.fragments, allocator); };
        add_members(assembly, allocator, "joints", json_list(result.rotations->joints, allocator, of_joint), "wall",
                    result.rotations->wall);
    }
    const auto of_level = [&](const NonRigidFit::Level& level) {
        return json_object(allocator, "smoothing", level.smoothing, "matched", level.matched, "residual", level.residual, "steps",
                           level.steps);
    };
    const auto of_note = [&](const CompletionNote& note) {
        return json_value(names.fragments[static_cast<std::size_t>(note.fragment)] + ": " + note.text, allocator);
    };
    const auto of_constraint = [&](const ConstraintReport& constraint) { return constraint_of(constraint, allocator); };
    const auto of_objection = [&](const Objection& one) { return objection_of(one, names.fragments, allocator); };
    add_members(
        assembly, allocator, "levels", json_list(result.fit.levels, allocator, of_level), "observedShare", result.observed_share,
        "crossings", result.crossings, "completionNotes", json_list(result.object.notes, allocator, of_note), "constraints",
        json_list(result.constraints, allocator, of_constraint), "objections",
        json_list(result.objections, allocator, of_objection), "strain", result.strain, "verdict", to_string(result.verdict));
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
    std::map<int, std::string> settled;
    std::vector<Statement> list;
    const auto fragments = assembly["fragments"].GetArray();
    for (unsigned k = 0; k < fragments.Size(); ++k) {
        const std::string place = "/fragments/" + std::to_string(k), name = fragments[k]["name"].GetString();
        if (const auto [other, fresh] = entries.emplace(name, place); !fresh)
            fail_input(file, "at " + place + ": fragment '" + name + "' has an entry already, at " + other->second,
                       "keep one of them");
        const JsonValue* matches = find_member(fragments[k], "annotations");
        if (name != fragment || matches == nullptr) continue;
        for (unsigned i = 0; i < matches->Size(); ++i) {
            const JsonValue& item = (*matches)[i];
            const JsonValue *stated = find_member(item, "stated"), *of_template = find_member(item, "ofTemplate");
            if (stated == nullptr || !stated->GetBool()) continue;
            StatedMatch match{item["ofFragment"].GetInt(), {}};
            const std::string at = place + "/annotations/" + std::to_string(i), what = "at " + at + ": annotation " +
                                                                                       std::to_string(match.of_fragment) +
                                                                                       " of fragment '" + name + "'";
            if (of_template == nullptr)
                fail_input(file, what + " is stated without \"ofTemplate\"",
                           "give the id of the template's annotation, or null for none");
            if (const auto [other, fresh] = settled.emplace(match.of_fragment, at); !fresh)
                fail_input(file, what + " is stated already, at " + other->second, "keep one of them");
            if (!of_template->IsNull()) match.of_template = of_template->GetInt();
            list.push_back({match, at});
        }
    }
    return list;
}

}  // namespace

std::vector<StatedMatch> stated_matches(const JsonValue& assembly, const std::string& fragment, const std::string& file) {
    std::vector<StatedMatch> list;
    for (const Statement& one : statements(assembly, fragment, file)) list.push_back(one.match);
    return list;
}

std::vector<StatedMatch> stated_matches(const JsonValue& assembly, const Fragment& fragment, const AnnotationSet& of_template,
                                        const std::string& file) {
    std::vector<StatedMatch> list;
    for (const auto& [match, place] : statements(assembly, fragment.name, file)) {
        const std::string at = "at " + place + ": ", whose = "fragment '" + fragment.name + "'";
        const auto find = [&](const AnnotationSet& set, int id, const std::string& owner) {
            const Annotation* annotation = set.find(id);
            if (annotation == nullptr)
                fail_input(file, at + owner + " has no annotation " + std::to_string(id),
                           "look at its ids with 'annotation list'");
            return annotation->type;
        };
        const AnnotationType theirs = find(fragment.annotations, match.of_fragment, whose);
        if (match.of_template) {
            const AnnotationType ours = find(of_template, *match.of_template, "for " + whose + ", the template");
            if (ours != theirs)
                fail_input(file,
                           at + "matches a " + to_string(theirs) + " (annotation " + std::to_string(match.of_fragment) + " of " +
                               whose + ") with a " + to_string(ours) + " (annotation " + std::to_string(*match.of_template) +
                               " of the template)",
                           "match annotations of one type");
        }
        list.push_back(match);
    }
    return list;
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
