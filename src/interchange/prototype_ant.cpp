// Writer for the prototype's .ant files.
#include "interchange/prototype_files.h"

#include "interchange/landmark_formats.h"
#include "interchange/text.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"
#include "ostraka/measure/measure.h"
#include "ostraka/mesh/ids.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

using namespace interchange;

std::string value_text(const Descriptor& descriptor) {
    std::string text = joined_numbers(descriptor.values);
    if (!descriptor.file.empty()) text += descriptor.file;
    return descriptor.unit.empty() ? text : fmt::format("{} {}", text, descriptor.unit);
}

}  // namespace

std::string prototype_annotations(AnnotatedMeshView object, std::vector<std::string>& notes) {
    const Json native = annotations_to_json(object, "", {});
    Json document(rapidjson::kObjectType);
    auto& a = document.GetAllocator();
    JsonValue entries(rapidjson::kArrayType);
    std::size_t descriptors = 0, unbounded = 0, renamed = 0, remarks = 0, unevaluated = 0;
    FreeIds ids(object.annotations.annotations);
    for (std::size_t i = 0; i < object.annotations.annotations.size(); ++i) {
        const Annotation& annotation = object.annotations.annotations[i];
        const JsonValue& source = native["annotations"][static_cast<rapidjson::SizeType>(i)];
        renamed += annotation.id < 0 ? 1 : 0;
        remarks += annotation.note.empty() ? 0 : 1;
        const bool point = annotation.type == AnnotationType::point, line = annotation.type == AnnotationType::line;
        JsonValue entry = json_object(a, "id", annotation.id < 0 ? ids.next() : annotation.id, "tag", annotation.tag, "color",
                                      source["colour"], "type",
                                      point  ? "Point"
                                      : line ? "Line"
                                             : "Area");
        if (point || line) {
            copy_members(entry, a, source, {"points", "polylines"});
        } else {
            // The prototype's outlines repeat their first vertex at the end.
            JsonValue boundaries(source["boundaries"], a);
            for (auto& boundary : boundaries.GetArray()) boundary.PushBack(JsonValue(boundary[0], a), a);
            add_member(entry, "boundaries", std::move(boundaries), a);
            unbounded +=
                find_member(source, "seeds") != nullptr || find_member(source, "faces") != nullptr || annotation.all ? 1 : 0;
            // Additions that the prototype ignores and our reader uses.
            copy_members(entry, a, source, {"seeds", "faces", "all"});
        }
        JsonValue attributes(rapidjson::kArrayType);
        for (const Attribute& attribute : annotation.attributes) {
            JsonValue flat = json_object(a, "id", attribute.id, "name", attribute.name);
            if (const Measure* measure = attribute.measure()) {
                double value = measure->value.value_or(0);
                try {
                    if (!measure->value) value = evaluate(object.mesh, annotation, *measure);
                } catch (const Error&) {
                    ++unevaluated;
                }
                add_members(flat, a, "type", "Geometric", "value", value, "points", measure->points, "tool", measure->tool);
                add_nonempty_members(flat, a, "direction", measure->direction);
            } else {
                const Note* note = attribute.note();
                descriptors += note != nullptr ? 0 : 1;
                add_members(flat, a, "type", "Semantic", "value",
                            note != nullptr ? note->text : value_text(*attribute.descriptor()));
            }
            attributes.PushBack(flat, a);
        }
        add_member(entry, "attributes", std::move(attributes), a);
        entries.PushBack(entry, a);
    }
    add_member(document, "annotations", std::move(entries), a);
    const auto add_note = [&](std::size_t count, const char* noun, const char* description) {
        if (count > 0) notes.push_back(counted(count, noun) + description);
    };
    add_note(descriptors, "descriptor", " written as text: the prototype supports measures and texts only");
    add_note(unbounded, "region", " without a complete outline: the prototype will not see all of it");
    add_note(renamed, "id", " below zero replaced: the prototype does not support them");
    add_note(remarks, "note", " left out");
    add_note(unevaluated, "measure", " that could not be evaluated written as 0");
    if (!object.annotations.unit.empty() || !object.annotations.object_class.empty() || object.annotations.up)
        notes.emplace_back("class, unit and upward direction left out: the format cannot store them");
    return json_text(document);
}

}  // namespace ostraka
