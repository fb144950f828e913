#include "ostraka/collection/technique_objects.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"

#include <cmath>
#include <numbers>

namespace ostraka {

namespace {

Vector vector_of(const std::array<double, 3>& way) { return {way[0], way[1], way[2]}; }

/// A direction and its source.
struct UpDirection {
    Vector way;
    const char* from;
};
UpDirection up_direction(const std::optional<std::array<double, 3>>& known, const std::optional<std::array<double, 3>>& up) {
    if (!up) return known ? UpDirection{vector_of(*known), "annotations"} : UpDirection{Vector(0, 0, 1), "assumed"};
    const Vector way = vector_of(*up);
    const bool other =
        known && way * vector_of(*known) < std::cos(0.5 * std::numbers::pi / 180) *
                                               std::sqrt(way.squared_length() * vector_of(*known).squared_length());
    return {way, other ? "option against the annotations" : "option"};
}

}  // namespace

std::vector<ObjectResult> measure_technique(const Collection& collection, const std::optional<std::array<double, 3>>& up,
                                            const TechniqueOptions& options, const ResultStore& store, const ObjectParts& parts) {
    std::vector<std::string> what{"technique slices 3"};
    if (up)
        for (const double c : *up) what.push_back(digits(c));
    for (const auto& [key, value] : list_options(options)) what.push_back(key + "=" + value);
    for (const std::string& one : parts.key()) what.push_back(one);
    return for_each_object(collection, store, what, [&](const CollectionObject& object) {
        const ObjectPart part = parts.read(object, up);
        // Annotations that are not needed may be damaged.
        if (!up && part.annotations_error) std::rethrow_exception(part.annotations_error);
        try {
            const UpDirection direction = up_direction(part.up, up);
            Json kept = technique_to_json(measure_technique(part.mesh, direction.way, options));
            add_member(kept, "upFrom", direction.from, kept.GetAllocator());
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
    for (const auto& [from, words] :
         {std::pair{"assumed", "no upward direction is known, z is taken; else give --up, or annotations that have one"},
          {"option against the annotations", "--up is taken, though the annotations have another upward direction"}}) {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < measured.size(); ++i)
            if (measured[i].problem.empty() && std::string_view(measured[i].result["upFrom"].GetString()) == from)
                names.push_back(collection.objects[i].name);
        if (!names.empty())
            notes.push_back(std::string(words) + " (" + std::to_string(names.size()) + " objects: " + names.front() +
                            (names.size() > 1 ? " ..." : "") + ")");
    }
    return notes;
}

}  // namespace ostraka
