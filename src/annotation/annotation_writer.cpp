// Annotations -> JSON.
#include "annotation_places.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/core/json_build.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

JsonValue list_of(const std::vector<Index>& indices, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    list.Reserve(static_cast<rapidjson::SizeType>(indices.size()), allocator);
    for (const Index index : indices) list.PushBack(index, allocator);
    return list;
}

JsonValue list_of(const std::vector<std::vector<Index>>& vertex_paths, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const auto& vertex_path : vertex_paths) list.PushBack(list_of(vertex_path, allocator), allocator);
    return list;
}

/// Whole numbers without a decimal point, as a person writes them.
JsonValue number_of(double value) {
    if (std::abs(value) < 1e9 && value == std::floor(value)) return JsonValue(static_cast<int>(value));
    return JsonValue(value);
}

template <class Numbers>
JsonValue numbers_of(const Numbers& numbers, JsonAllocator& allocator) {
    JsonValue list(rapidjson::kArrayType);
    for (const auto number : numbers) list.PushBack(number_of(number), allocator);
    return list;
}

void add_text(JsonValue& object, const char* name, const std::string& text, JsonAllocator& allocator) {
    if (!text.empty()) add_member(object, name, text, allocator);
}

JsonValue json_of(const Measure& measure, JsonAllocator& allocator) {
    JsonValue object = json_object(allocator, "tool", measure.tool, "points", list_of(measure.points, allocator));
    if (!measure.locations.empty()) {
        JsonValue locations(rapidjson::kArrayType);
        for (const auto& location : measure.locations) {
            JsonValue entry =
                json_object(allocator, "face", location.face, "barycentric", numbers_of(location.barycentric, allocator));
            locations.PushBack(entry, allocator);
        }
        add_member(object, "locations", std::move(locations), allocator);
    }
    if (measure.direction) add_member(object, "direction", numbers_of(*measure.direction, allocator), allocator);
    if (measure.exact) add_member(object, "geodesic", "exact", allocator);
    if (!measure.repeats.empty()) add_member(object, "repeats", list_of(measure.repeats, allocator), allocator);
    if (measure.value) add_member(object, "value", number_of(*measure.value), allocator);
    if (measure.uncertainty) add_member(object, "uncertainty", number_of(*measure.uncertainty), allocator);
    add_text(object, "unit", measure.unit, allocator);
    if (measure.stale) add_member(object, "stale", JsonValue(true), allocator);
    return object;
}

JsonValue json_of(const Attribute& attribute, JsonAllocator& allocator) {
    JsonValue object = json_object(allocator, "id", attribute.id, "name", attribute.name);
    switch (attribute.type) {
        case AttributeType::semantic:
            add_member(object, "type", "semantic", allocator);
            add_member(object, "note", attribute.note, allocator);
            add_text(object, "origin", attribute.origin, allocator);
            break;
        case AttributeType::measure:
            add_member(object, "type", "measure", allocator);
            add_member(object, "measure", json_of(attribute.measure, allocator), allocator);
            break;
        case AttributeType::descriptor: {
            const Descriptor& descriptor = attribute.descriptor;
            add_member(object, "type", "descriptor", allocator);
            if (descriptor.is_list) add_member(object, "value", numbers_of(descriptor.values, allocator), allocator);
            else if (!descriptor.values.empty()) add_member(object, "value", number_of(descriptor.values.front()), allocator);
            add_text(object, "file", descriptor.file, allocator);
            add_text(object, "unit", descriptor.unit, allocator);
            if (descriptor.stale) add_member(object, "stale", JsonValue(true), allocator);
            break;
        }
    }
    return object;
}

/// Boundaries always, as the thesis's readers ask for them; seeds for whole closed components; the faces themselves only if those
/// two do not tell them.
void add_region(JsonValue& object, const Annotation& annotation, const Mesh& mesh, JsonAllocator& allocator) {
    const std::vector<bool> selected = face_flags(mesh, annotation.faces);
    const std::vector<Outline> outlines = extract_outlines(mesh, annotation.faces);
    add_member(object, "boundaries", list_of(outlines, allocator), allocator);
    if (annotation.all) {
        add_member(object, "all", JsonValue(true), allocator);
        return;
    }
    const WholeComponents whole = whole_components(mesh, annotation.faces, selected);
    if (!whole.seeds.empty()) add_member(object, "seeds", list_of(whole.seeds, allocator), allocator);
    Filling filling = fill_outlines(mesh, outlines);
    for (const Index face : whole.faces) filling.selected[face] = true;
    if (filling.conflicts > 0 || filling.selected != selected)
        add_member(object, "faces", list_of(annotation.faces, allocator), allocator);
}

JsonValue json_of(const Annotation& annotation, const Mesh& mesh, JsonAllocator& allocator) {
    JsonValue object = json_object(allocator, "id", annotation.id, "tag", annotation.tag);
    JsonValue colour(rapidjson::kArrayType);
    for (const int part : annotation.colour) colour.PushBack(part, allocator);
    add_members(object, allocator, "colour", std::move(colour), "type", to_string(annotation.type));
    if (annotation.type == AnnotationType::point) add_member(object, "points", list_of(annotation.points, allocator), allocator);
    if (annotation.type == AnnotationType::line)
        add_member(object, "polylines", list_of(annotation.polylines, allocator), allocator);
    if (annotation.type == AnnotationType::region) add_region(object, annotation, mesh, allocator);
    add_text(object, "note", annotation.note, allocator);
    JsonValue attributes(rapidjson::kArrayType);
    for (const auto& attribute : annotation.attributes) attributes.PushBack(json_of(attribute, allocator), allocator);
    add_member(object, "attributes", std::move(attributes), allocator);
    return object;
}

}  // namespace

WholeComponents whole_components(const Mesh& mesh, const std::vector<Index>& faces, const std::vector<bool>& selected) {
    WholeComponents result;
    std::vector<bool> seen(selected.size(), false);
    for (const Index first : faces) {
        if (seen[first]) continue;
        std::vector<Index> part{first};
        seen[first] = true;
        bool whole = true;
        for (std::size_t i = 0; i < part.size(); ++i)
            for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(part[i])))) {
                const Face next = mesh.face(mesh.opposite(h));
                if (next == Mesh::null_face() || !selected[next]) whole = false;
                else if (!seen[next]) {
                    seen[next] = true;
                    part.push_back(next);
                }
            }
        if (!whole) continue;
        result.seeds.push_back(first);  // the smallest of its component, as `faces` ascends
        result.faces.insert(result.faces.end(), part.begin(), part.end());
    }
    return result;
}

Json annotations_to_json(const AnnotationSet& set, const Mesh& mesh, const std::string& mesh_file, const Provenance& provenance) {
    check_annotations(set, mesh, mesh_file.empty() ? "annotations" : "annotations of " + mesh_file);
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_members(document, allocator, "format", "ostraka-annotations", "version", 1);
    JsonValue made_for(rapidjson::kObjectType);
    add_text(made_for, "file", Path(mesh_file).filename().string(), allocator);
    add_members(made_for, allocator, "vertices", mesh.number_of_vertices(), "faces", mesh.number_of_faces(), "sha256",
                mesh_checksum(mesh));
    add_member(document, "mesh", std::move(made_for), allocator);
    add_text(document, "unit", set.unit, allocator);
    add_text(document, "class", set.object_class, allocator);
    if (set.up) add_member(document, "up", numbers_of(*set.up, allocator), allocator);
    JsonValue list(rapidjson::kArrayType);
    for (const auto& annotation : set.annotations) list.PushBack(json_of(annotation, mesh, allocator), allocator);
    add_members(document, allocator, "annotations", std::move(list), "provenance", provenance.to_json(allocator));
    return document;
}

void write_annotations(const Path& file, const AnnotationSet& set, const Mesh& mesh, const std::string& mesh_file,
                       const Provenance& provenance) {
    write_json(file, annotations_to_json(set, mesh, mesh_file, provenance));
}

}  // namespace ostraka
