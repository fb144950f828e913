#include "ostraka/reconstruction/assembly.h"

#include "ostraka/core/json_build.h"
#include "ostraka/fracture/rotational_report.h"

#include "ostraka/core/error.h"
#include "ostraka/registration/pose_json.h"

#include <algorithm>
#include <map>

namespace ostraka {

namespace {

JsonValue placement_of(const FragmentPlacement& one, JsonAllocator& allocator) {
    JsonValue entry(rapidjson::kObjectType), landmarks(rapidjson::kArrayType);
    if (!one.problem.empty()) {
        add_member(entry, "problem", one.problem, allocator);
    } else {
        add_members(entry, allocator, "pose", pose_to_json(one.pose, allocator), "residual", one.residual);
    }
    if (one.own_scale > 0) add_member(entry, "ownScale", JsonValue(one.own_scale), allocator);
    for (const LandmarkResidual& landmark : one.landmarks) {
        JsonValue item = json_object(allocator, "name", landmark.name, "distance", landmark.distance, "used", landmark.used);
        landmarks.PushBack(item, allocator);
    }
    add_member(entry, "landmarks", std::move(landmarks), allocator);
    return entry;
}

/// What a search had to say of a fragment's pose.
JsonValue search_of(const PoseSearchResult& one, JsonAllocator& allocator) {
    JsonValue entry(rapidjson::kObjectType), slippable(rapidjson::kObjectType), ways(rapidjson::kArrayType);
    const auto triple = [&](const Eigen::Vector3d& v) {
        JsonValue list(rapidjson::kArrayType);
        for (int i = 0; i < 3; ++i) list.PushBack(v[i], allocator);
        return list;
    };
    add_members(entry, allocator, "decided", one.decided, "confidence", one.confidence, "margin", one.margin);
    if (!one.candidates.empty()) {
        add_members(entry, allocator, "score", one.candidates.front().score, "share", one.candidates.front().share);
    }
    if (!one.reason.empty()) add_member(entry, "reason", one.reason, allocator);
    add_member(slippable, "kind", to_string(one.slippable.kind), allocator);
    if (one.slippable.kind != SlippableKind::none) {
        add_members(slippable, allocator, "text", one.slippable.text(), "point", triple(one.slippable.point), "direction",
                    triple(one.slippable.direction));
    }
    for (const SlippableRange& way : one.ways) {
        JsonValue item = json_object(allocator, "turns", way.rotates, "least", way.minimum, "most", way.maximum);
        ways.PushBack(item, allocator);
    }
    add_member(slippable, "ways", std::move(ways), allocator);
    add_member(entry, "freedom", std::move(slippable), allocator);
    return entry;
}

JsonValue constraint_of(const ConstraintReport& constraint, JsonAllocator& allocator) {
    JsonValue entry(rapidjson::kObjectType), deviations(rapidjson::kArrayType);
    add_members(entry, allocator, "id", constraint.id, "type", constraint.type, "used", constraint.used, "before",
                to_string(constraint.before), "verdict", to_string(constraint.verdict), "text", constraint.text);
    for (std::size_t i = 0; i < constraint.deviations.size(); ++i) {
        const Deviation& d = constraint.deviations[i];
        JsonValue item(rapidjson::kObjectType);
        add_member(item, "quantity", d.quantity, allocator);
        if (i < constraint.before_values.size()) add_member(item, "before", JsonValue(constraint.before_values[i]), allocator);
        if (d.value) add_member(item, "value", JsonValue(*d.value), allocator);
        if (d.tolerance) add_member(item, "tolerance", JsonValue(*d.tolerance), allocator);
        add_member(item, "unit", d.unit, allocator);
        deviations.PushBack(item, allocator);
    }
    add_member(entry, "deviations", std::move(deviations), allocator);
    return entry;
}

}  // namespace

JsonValue assembly_to_json(const Reconstruction& result, const AssemblyNames& names, JsonAllocator& allocator) {
    JsonValue assembly(rapidjson::kObjectType), fragments(rapidjson::kArrayType), constraints(rapidjson::kArrayType),
        objections(rapidjson::kArrayType), levels(rapidjson::kArrayType);
    add_members(assembly, allocator, "format", "ostraka-assembly", "version", 1, "template", names.template_file, "scale",
                result.placement.scale);
    for (std::size_t k = 0; k < result.placement.fragments.size(); ++k) {
        JsonValue entry = placement_of(result.placement.fragments[k], allocator), matches(rapidjson::kArrayType),
                  notes(rapidjson::kArrayType);
        add_member(entry, "name", k < names.fragments.size() ? names.fragments[k] : std::to_string(k + 1), allocator);
        const bool searched = k < result.searched.size() && result.searched[k].has_value();
        if (searched || result.placement.fragments[k].problem.empty())
            add_member(entry, "source", searched ? "search" : "landmarks", allocator);
        if (searched) add_member(entry, "search", search_of(*result.searched[k], allocator), allocator);
        if (result.rotations && result.rotations->group[k] >= 0)
            add_member(entry, "turn", rotation_to_json(*result.rotations, k, names.fragments, allocator), allocator);
        if (k < result.annotations.size())
            for (const AnnotationMatch& match : result.annotations[k]) {
                JsonValue item = json_object(allocator, "ofFragment", match.of_fragment, "ofTemplate", match.of_template, "score",
                                             match.score, "attributes", match.attributes, "containers", match.containers, "place",
                                             match.place, "extent", match.extent, "stated", match.stated);
                matches.PushBack(item, allocator);
            }
        add_member(entry, "annotations", std::move(matches), allocator);
        if (k < result.notes.size())
            for (const std::string& note : result.notes[k]) notes.PushBack(JsonValue(note, allocator), allocator);
        add_member(entry, "notes", std::move(notes), allocator);
        if (k < result.joined.size())
            add_member(entry, "joinedFaces", JsonValue(static_cast<std::uint64_t>(result.joined[k])), allocator);
        fragments.PushBack(entry, allocator);
    }
    add_member(assembly, "fragments", std::move(fragments), allocator);
    if (result.rotations) {
        add_members(assembly, allocator, "joints", joints_to_json(*result.rotations, names.fragments, allocator), "wall",
                    result.rotations->wall);
    }
    for (const NonRigidFit::Level& level : result.fit.levels) {
        JsonValue item = json_object(allocator, "smoothing", level.smoothing, "matched", level.matched, "residual",
                                     level.residual, "steps", level.steps);
        levels.PushBack(item, allocator);
    }
    add_members(assembly, allocator, "levels", std::move(levels), "observedShare", result.observed_share, "crossings",
                result.crossings);
    JsonValue completion(rapidjson::kArrayType);
    for (const CompletionNote& note : result.object.notes)
        completion.PushBack(JsonValue(names.fragments[static_cast<std::size_t>(note.fragment)] + ": " + note.text, allocator),
                            allocator);
    add_member(assembly, "completionNotes", std::move(completion), allocator);
    for (const ConstraintReport& constraint : result.constraints)
        constraints.PushBack(constraint_of(constraint, allocator), allocator);
    add_member(assembly, "constraints", std::move(constraints), allocator);
    for (const Objection& objection : result.objections) {
        JsonValue item(rapidjson::kObjectType);
        if (objection.fragment >= 0)
            add_member(item, "fragment", names.fragments[static_cast<std::size_t>(objection.fragment)], allocator);
        if (objection.constraint >= 0) add_member(item, "constraint", JsonValue(objection.constraint), allocator);
        add_member(item, "kind", to_string(objection.kind), allocator);
        if (objection.strain > 0) add_member(item, "strain", JsonValue(objection.strain), allocator);
        add_member(item, "text", objection.text, allocator);
        objections.PushBack(item, allocator);
    }
    add_members(assembly, allocator, "objections", std::move(objections), "strain", result.strain, "verdict",
                to_string(result.verdict));
    if (!result.undecided.empty()) add_member(assembly, "undecided", result.undecided, allocator);
    return assembly;
}

namespace {

struct Statement {
    StatedMatch match;
    std::string place;  ///< JSON pointer
};

/// What is stated of the fragment of this name, with its place in the file.
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
