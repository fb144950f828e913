#include "ostraka/annotation/annotation.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/mesh/ids.h"

#include <algorithm>
#include <numeric>

namespace ostraka {

AnnotationSet::AnnotationSet(const AnnotationSet& other)
    : object_class(other.object_class), unit(other.unit), up(other.up), annotations(other.annotations), notes(other.notes) {
    provenance.CopyFrom(other.provenance, provenance.GetAllocator());
}

AnnotationSet& AnnotationSet::operator=(const AnnotationSet& other) {
    if (this != &other) *this = AnnotationSet(other);
    return *this;
}

bool Information::is_local() const {
    return (kind == Kind::image || kind == Kind::file) && value.find("://") == std::string::npos && !value.starts_with("data:");
}

std::string to_string(Information::Kind kind) {
    switch (kind) {
        case Information::Kind::text:
            return "text";
        case Information::Kind::image:
            return "image";
        case Information::Kind::link:
            return "link";
        case Information::Kind::file:
            break;
    }
    return "file";
}

std::string name_of(const Annotation& annotation) {
    return "annotation " + std::to_string(annotation.id) + " ('" + annotation.tag + "')";
}

const Annotation* AnnotationSet::find(int id) const {
    const auto found = std::find_if(annotations.begin(), annotations.end(), [id](const Annotation& a) { return a.id == id; });
    return found == annotations.end() ? nullptr : &*found;
}

Annotation* AnnotationSet::find(int id) { return const_cast<Annotation*>(std::as_const(*this).find(id)); }

std::string to_string(AnnotationType type) {
    static constexpr const char* words[]{"point", "line", "region"};
    return words[static_cast<std::size_t>(type)];
}

int free_id(const AnnotationSet& set) { return next_free_id(set.annotations); }

Annotation& ensure_root(AnnotationSet& set, const Mesh& mesh) {
    auto root = std::find_if(set.annotations.begin(), set.annotations.end(), [](const Annotation& a) { return a.all; });
    if (root == set.annotations.end()) {
        Annotation made;
        made.id = free_id(set);
        made.tag = set.object_class.empty() ? "object" : set.object_class;
        made.all = true;
        root = set.annotations.insert(set.annotations.begin(), std::move(made));
    }
    root->faces.resize(mesh.number_of_faces());
    std::iota(root->faces.begin(), root->faces.end(), Index{0});
    return *root;
}

std::vector<Index> pins_of(const Measure& measure) {
    std::vector<Index> pins = measure.points;
    for (const auto& again : measure.repeats) pins.insert(pins.end(), again.begin(), again.end());
    return pins;
}

std::vector<Index> pins_of(const Attribute& attribute) {
    const Measure* measure = attribute.measure();
    return measure == nullptr ? std::vector<Index>() : pins_of(*measure);
}

Figures attribute_values(const Attribute& attribute) {
    if (const Descriptor* descriptor = attribute.descriptor()) return {descriptor->values, descriptor->unit, descriptor->stale};
    const Measure* measure = attribute.measure();
    if (measure == nullptr) return {};
    return {measure->value ? std::vector{*measure->value} : std::vector<double>(), measure->unit, measure->stale};
}

std::vector<bool> face_flags(const Mesh& mesh, const std::vector<Index>& faces) {
    std::vector<bool> flags(mesh.number_of_faces(), false);
    for (const Index face : faces) {
        if (face >= flags.size())
            fail_input("face " + std::to_string(face), "the mesh has " + std::to_string(flags.size()) + " faces");
        flags[face] = true;
    }
    return flags;
}

double area_of(const Mesh& mesh, const std::vector<Index>& faces) {
    double area = 0;
    for (const Index face : faces) area += face_area(mesh, Face(face));
    return area;
}

std::vector<Index> flagged(const std::vector<bool>& flags) {
    std::vector<Index> list;
    for (std::size_t i = 0; i < flags.size(); ++i)
        if (flags[i]) list.push_back(static_cast<Index>(i));
    return list;
}

std::vector<Index> touched_vertices(const Mesh& mesh, const Annotation& annotation) {
    check_cancelled();
    std::vector<Index> vertices = annotation.points;
    for (const auto& polyline : annotation.polylines) vertices.insert(vertices.end(), polyline.begin(), polyline.end());
    for (const Index face : annotation.faces)
        for (const Vertex corner : corners(mesh, Face(face))) vertices.push_back(corner);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

}  // namespace ostraka
