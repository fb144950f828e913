#include "ostraka/collection/technique_objects.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"

#include <fmt/core.h>

#include <cmath>
#include <numbers>

namespace ostraka {

namespace {

Vector vector_of(const std::array<double, 3>& coordinates) { return {coordinates[0], coordinates[1], coordinates[2]}; }

/// A direction and its source.
struct UpDirection {
    Vector direction;
    const char* source;
};
UpDirection up_direction(const std::optional<std::array<double, 3>>& annotated_up,
                         const std::optional<std::array<double, 3>>& up) {
    if (!up) return annotated_up ? UpDirection{vector_of(*annotated_up), "annotations"} : UpDirection{Vector(0, 0, 1), "assumed"};
    const Vector direction = vector_of(*up);
    const bool other = annotated_up && direction * vector_of(*annotated_up) <
                                           std::cos(0.5 * std::numbers::pi / 180) *
                                               std::sqrt(direction.squared_length() * vector_of(*annotated_up).squared_length());
    return {direction, other ? "option against the annotations" : "option"};
}

}  // namespace

std::vector<ObjectResult> measure_technique(const Collection& collection, const std::optional<std::array<double, 3>>& up,
                                            const TechniqueOptions& options, const ResultStore& store, const ObjectParts& parts) {
    std::vector<std::string> key_parts{"technique slices 3"};
    if (up)
        for (const double c : *up) key_parts.push_back(digits(c));
    for (const auto& [key, value] : declare_options(options)) key_parts.push_back(fmt::format("{}={}", key, value));
    for (const std::string& key_part : parts.key()) key_parts.push_back(key_part);
    return for_each_object(collection, store, key_parts, [&](const CollectionObject& object) {
        const ObjectPart part = parts.read(object, up);
        // Annotations that are not needed may be damaged.
        if (!up && part.annotations_error) std::rethrow_exception(part.annotations_error);
        try {
            const UpDirection up_used = up_direction(part.up, up);
            Json kept = technique_to_json(measure_technique(part.mesh, up_used.direction, options));
            add_member(kept, "upFrom", up_used.source, kept.GetAllocator());
            return kept;
        } catch (const Error& error) {
            if (error.where() != "mesh") throw;
            throw Error(error.kind(), object.mesh.string(), error.problem(), error.remedy());
        }
    });
}

std::vector<TechniqueObject> technique_objects(const Collection& collection, const std::vector<ObjectResult>& measured) {
    std::vector<TechniqueObject> objects;
    for (std::size_t i = 0; i < measured.size(); ++i)
        if (measured[i].problem.empty())
            objects.push_back({collection.objects[i].name, collection.objects[i].label, technique_from_json(measured[i].result)});
    return objects;
}

std::vector<std::string> notes_on_directions(const Collection& collection, const std::vector<ObjectResult>& measured) {
    std::vector<std::string> notes;
    for (const auto& [source, words] :
         {std::pair{
              "assumed",
              "the upward direction is unknown and z is used; to change it, give --up or annotations with an upward direction"},
          {"option against the annotations", "--up is used, although the annotations have a different upward direction"}}) {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < measured.size(); ++i)
            if (measured[i].problem.empty() && std::string_view(measured[i].result["upFrom"].GetString()) == source)
                names.push_back(collection.objects[i].name);
        if (!names.empty())
            notes.push_back(
                fmt::format("{} ({} objects: {}{})", words, names.size(), names.front(), names.size() > 1 ? " ..." : ""));
    }
    return notes;
}

}  // namespace ostraka
