// Conversion of annotations to JSON.

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/json_build.h"
#include "ostraka/mesh/flood.h"

namespace ostraka {

namespace {

template <class Numbers>
JsonValue numbers_of(const Numbers& numbers, JsonAllocator& allocator) {
    return json_list(numbers, allocator, json_number);
}

JsonValue json_of(const Measure& measure, JsonAllocator& allocator) {
    JsonValue object = json_object(allocator, "tool", measure.tool, "points", measure.points);
    JsonValue locations = json_list(measure.locations, allocator, [&](const SurfacePoint& location) {
        return json_object(allocator, "face", location.element[0], "barycentric", numbers_of(location.weights, allocator));
    });
    add_nonempty_members(object, allocator, "locations", std::move(locations));
    if (measure.direction) add_member(object, "direction", numbers_of(*measure.direction, allocator), allocator);
    if (measure.exact) add_member(object, "geodesic", "exact", allocator);
    add_nonempty_members(object, allocator, "repeats", measure.repeats);
    if (measure.value) add_member(object, "value", json_number(*measure.value), allocator);
    if (measure.uncertainty) add_member(object, "uncertainty", json_number(*measure.uncertainty), allocator);
    add_nonempty_members(object, allocator, "unit", measure.unit, "stale", measure.stale);
    return object;
}

JsonValue json_of(const Attribute& attribute, JsonAllocator& allocator) {
    JsonValue object = json_object(allocator, "id", attribute.id, "name", attribute.name);
    if (const Note* note = attribute.note()) {
        add_members(object, allocator, "type", "semantic", "note", note->text);
        add_nonempty_members(object, allocator, "origin", note->origin);
    } else if (const Measure* measure = attribute.measure()) {
        add_members(object, allocator, "type", "measure", "measure", json_of(*measure, allocator));
    } else if (const Descriptor* descriptor = attribute.descriptor()) {
        add_member(object, "type", "descriptor", allocator);
        if (descriptor->is_list) add_member(object, "value", numbers_of(descriptor->values, allocator), allocator);
        else if (!descriptor->values.empty()) add_member(object, "value", json_number(descriptor->values.front()), allocator);
        add_nonempty_members(object, allocator, "file", descriptor->file, "sha256", descriptor->sha256, "unit", descriptor->unit,
                             "stale", descriptor->stale);
    }
    return object;
}

/// Representation of the faces of a region in a file.
struct RegionParts {
    std::vector<Outline> outlines;  ///< always written, since readers of the thesis's format require them
    std::vector<Index> seeds;       ///< the smallest face of each completely covered closed component, which has no outline
    bool complete = true;           ///< false: outlines and seeds do not determine the faces, which must be listed
};
RegionParts parts_of(const Annotation& annotation, const Mesh& mesh) {
    RegionParts parts;
    parts.outlines = extract_outlines(mesh, annotation.faces);
    if (annotation.all) return parts;
    if (is_free(annotation)) {
        // Its faces follow from its curves, except for components that no curve traverses.
        const std::vector<SurfaceCurve> curves = curves_on(mesh, annotation);
        const CurveFilling without = fill_curves(mesh, curves);
        std::vector<bool> seen(mesh.number_of_faces(), false);
        for (const Index first : annotation.faces)
            if (!seen[first] && without.sides[first] == FaceSide::out) {
                parts.seeds.push_back(first);
                flood_faces(mesh, Face(first), seen);
            }
        return parts;
    }
    const std::vector<bool> selected = face_flags(mesh, annotation.faces);
    Filling filling = fill_outlines(mesh, parts.outlines);
    for (const Index first : annotation.faces) {
        if (filling.selected[first]) continue;
        parts.seeds.push_back(first);
        flood_faces(mesh, Face(first), filling.selected);
    }
    parts.complete = filling.conflicts == 0 && filling.selected == selected;
    return parts;
}

JsonValue json_of(const SurfacePoint& p, JsonAllocator& allocator) {
    if (p.is_vertex()) return JsonValue(p.element[0]);
    if (p.is_in_face()) return json_object(allocator, "face", p.element[0], "barycentric", numbers_of(p.weights, allocator));
    JsonValue list(rapidjson::kArrayType);
    list.PushBack(p.element[0], allocator).PushBack(p.element[1], allocator).PushBack(json_number(p.weights[1]), allocator);
    return list;
}

JsonValue json_of(const Annotation& annotation, const RegionParts& parts, JsonAllocator& allocator) {
    JsonValue object = json_object(allocator, "id", annotation.id, "tag", annotation.tag, "colour", annotation.colour, "type",
                                   to_string(annotation.type));
    if (annotation.type == AnnotationType::point) add_members(object, allocator, "points", annotation.points);
    if (annotation.type == AnnotationType::line) add_members(object, allocator, "polylines", annotation.polylines);
    if (is_free(annotation))
        add_member(object, "curves",
                   json_list(annotation.curves, allocator,
                             [&](const std::vector<SurfacePoint>& curve) {
                                 return json_list(curve, allocator, [&](const SurfacePoint& p) { return json_of(p, allocator); });
                             }),
                   allocator);
    if (annotation.type == AnnotationType::region) {
        add_members(object, allocator, "boundaries", parts.outlines);
        if (annotation.all) add_member(object, "all", JsonValue(true), allocator);
        add_nonempty_members(object, allocator, "seeds", parts.seeds);
        if (!parts.complete && !is_free(annotation)) add_members(object, allocator, "faces", annotation.faces);
    }
    add_nonempty_members(object, allocator, "note", annotation.note);
    if (!annotation.information.empty())
        add_members(object, allocator, "information", json_list(annotation.information, allocator, [&](const Information& one) {
                        JsonValue entry = json_object(allocator, "kind", to_string(one.kind), "value", one.value);
                        add_nonempty_members(entry, allocator, "title", one.title);
                        add_nonempty_members(entry, allocator, "sha256", one.sha256);
                        return entry;
                    }));
    add_members(object, allocator, "attributes",
                json_list(annotation.attributes, allocator, [&](const Attribute& one) { return json_of(one, allocator); }));
    return object;
}

}  // namespace

Json annotations_to_json(AnnotatedMeshView object, const std::string& mesh_file, const Provenance& provenance) {
    check_annotations(object, mesh_file.empty() ? "annotations" : "annotations of " + mesh_file);
    Json document = json_document("annotations");
    auto& allocator = document.GetAllocator();
    if (any_free(object.annotations)) document["version"] = 2;
    JsonValue made_for(rapidjson::kObjectType);
    add_nonempty_members(made_for, allocator, "file", Path(mesh_file).filename().string());
    add_members(made_for, allocator, "vertices", object.mesh.number_of_vertices(), "faces", object.mesh.number_of_faces(),
                "sha256", mesh_checksum(object.mesh));
    add_members(document, allocator, "mesh", std::move(made_for));
    add_nonempty_members(document, allocator, "unit", object.annotations.unit, "class", object.annotations.object_class);
    if (object.annotations.up) add_member(document, "up", numbers_of(*object.annotations.up, allocator), allocator);
    std::vector<RegionParts> parts(object.annotations.annotations.size());
    parallel_for(parts.size(), 1, [&](std::size_t i) {
        if (object.annotations.annotations[i].type == AnnotationType::region)
            parts[i] = parts_of(object.annotations.annotations[i], object.mesh);
    });
    JsonValue list = json_list(object.annotations.annotations, allocator, [&](const Annotation& one) {
        return json_of(one, parts[static_cast<std::size_t>(&one - object.annotations.annotations.data())], allocator);
    });
    add_members(document, allocator, "annotations", std::move(list), "provenance", provenance.to_json(allocator));
    return document;
}

void write_annotations(const Path& file, AnnotatedMeshView object, const std::string& mesh_file, const Provenance& provenance) {
    write_json(file, annotations_to_json(object, mesh_file, provenance));
}

}  // namespace ostraka
