// Conversion of annotations to W3C Web Annotation JSON-LD.
#include "ostraka/interchange/web_annotation.h"

#include "interchange/text.h"
#include "interchange/web_terms.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/files/json_build.h"
#include "ostraka/mesh/flood.h"

#include <fmt/core.h>

#include <map>

namespace ostraka {

namespace {

using namespace interchange;

/// A persistent identifier derived from `content`: a UUID of version 8 (RFC 9562) from its SHA-256.
std::string uuid_of(const std::string& content) {
    std::string hex = sha256(content).substr(0, 32);
    hex[12] = '8';
    hex[16] = "89ab"[static_cast<std::size_t>(hex[16] >= 'a' ? hex[16] - 'a' + 10 : hex[16] - '0') % 4];
    return fmt::format("urn:uuid:{}-{}-{}-{}-{}", hex.substr(0, 8), hex.substr(8, 4), hex.substr(12, 4), hex.substr(16, 4),
                       hex.substr(20));
}

class WebWriter {
public:
    WebWriter(AnnotatedMeshView object, const std::string& mesh_file, const Provenance& provenance)
        : object_(object), native_(annotations_to_json(object, mesh_file, provenance)), number_(components()) {
        document_.SetObject();
        checksum_ = text_in(native_["mesh"], "sha256");
        source_ = percent_encoded(Path(mesh_file).filename().string());  // a relative IRI
        if (source_.empty()) source_ = "mesh";
    }

    std::string write() {
        JsonValue items(rapidjson::kArrayType);
        std::string content = checksum_;
        const JsonValue& entries = native_["annotations"];
        for (rapidjson::SizeType i = 0; i < entries.Size(); ++i) {
            JsonValue item = annotation(entries[i], object_.annotations.annotations[i]);
            content += text_in(item, "id");
            items.PushBack(item, a());
        }
        const std::string collection = uuid_of(content);
        add_members(document_, a(), "@context", context(), "id", collection, "type", "AnnotationCollection", "label",
                    object_.annotations.object_class.empty() ? "annotations" : object_.annotations.object_class);
        JsonValue generator = json_object(a(), "id", "urn:x-ostraka:tool", "type", "Software", "name", "ostraka " + version());
        add_members(document_, a(), "generator", std::move(generator), "total", items.Size());
        JsonValue about(rapidjson::kObjectType);
        copy_members(about, a(), native_, {"class", "unit", "up", "provenance"});
        add_members(document_, a(), "about", std::move(about));
        JsonValue page = json_object(a(), "id", uuid_of(content + "page"), "type", "AnnotationPage", "partOf", collection,
                                     "startIndex", 0, "items", std::move(items));
        add_member(document_, "first", std::move(page), a());
        return json_text(document_);
    }

private:
    JsonAllocator& a() { return document_.GetAllocator(); }

    JsonValue context() {
        JsonValue terms = json_object(a(), "@version", 1.1, "ostraka", web::terms);
        for (const char* name : {"sha256", "vertices", "faces"}) add_member(terms, name, std::string("ostraka:") + name, a());
        for (const char* name : {"indices", "places", "about"})
            add_members(terms, a(), name, json_object(a(), "@id", std::string("ostraka:") + name, "@type", "@json"));
        JsonValue contexts = json_value(std::array{web::context}, a());
        contexts.PushBack(terms, a());
        return contexts;
    }

    JsonValue body(const char* purpose, const char* format, const std::string& value) {
        return json_object(a(), "type", "TextualBody", "purpose", purpose, "format", format, "value", value);
    }

    static std::string description_of(const Attribute& attribute) {
        if (const Note* note = attribute.note()) return fmt::format("{}: {}", attribute.name, note->text);
        const auto [values, unit, stale] = attribute_values(attribute);
        std::string text = attribute.name + ":";
        for (std::size_t i = 0; i < values.size() && i < 8; ++i) text += " " + digits(values[i]);
        return text + (unit.empty() ? "" : " " + unit) + (stale ? " (stale)" : "");
    }

    JsonValue annotation(const JsonValue& native, const Annotation& annotation) {
        Json data(rapidjson::kObjectType);
        JsonValue indices(rapidjson::kObjectType);
        for (const auto& member : native.GetObject()) {
            const std::string name = text_of(member.name);
            if (name == "id" || name == "tag" || name == "colour" || name == "type" || name == "note" || name == "attributes")
                add_member(data, name, JsonValue(member.value, data.GetAllocator()), data.GetAllocator());
            else add_member(indices, name, JsonValue(member.value, a()), a());
        }
        const std::string data_text(trimmed(to_text(data)));
        JsonValue bodies(rapidjson::kArrayType);
        bodies.PushBack(body("tagging", "text/plain", annotation.tag), a());
        for (const Attribute& attribute : annotation.attributes)
            bodies.PushBack(body("describing", "text/plain", description_of(attribute)), a());
        bodies.PushBack(body("describing", "application/json", data_text), a());

        JsonValue selectors = json_list_of(json_object(a(), "type", web::index_selector, "indices", std::move(indices)), a());
        selectors.PushBack(json_object(a(), "type", web::place_selector, "places", places(annotation)), a());
        JsonValue source = json_object(a(), "id", source_, "type", "Dataset");
        copy_members(source, a(), native_["mesh"], {"vertices", "faces", "sha256"});
        JsonValue target =
            json_object(a(), "type", "SpecificResource", "source", std::move(source), "selector", std::move(selectors));
        return json_object(a(), "id", uuid_of(checksum_ + to_text(native)), "type", "Annotation", "motivation", "describing",
                           "body", std::move(bodies), "target", std::move(target));
    }

    JsonValue place(const Point& p) { return json_value(std::array{p.x(), p.y(), p.z()}, a()); }
    JsonValue place(Index vertex) { return place(object_.mesh.point(Vertex(vertex))); }

    JsonValue vertex_list(const std::vector<Index>& vertices) {
        return json_list(vertices, a(), [&](Index vertex) { return place(vertex); });
    }

    /// The index of the connected component of each face.
    [[nodiscard]] std::vector<Index> components() const { return face_pieces(object_.mesh).of_face; }

    /// One part per component of the mesh that the region covers, since winding numbers are defined per component.
    JsonValue parts(const Annotation& annotation) {
        struct Part {
            double area = 0;
            Index largest = no_index;
            double largest_area = -1;
            std::vector<Outline> outlines;
        };
        std::map<Index, Part> component_parts;
        for (const Index face : annotation.faces) {
            Part& part = component_parts[number_[face]];
            const double area = face_area(object_.mesh, Face(face));
            part.area += area;
            if (area > part.largest_area) {
                part.largest_area = area;
                part.largest = face;
            }
        }
        for (Outline& outline : extract_outlines(object_.mesh, annotation.faces)) {
            const Halfedge first = find_halfedge(object_.mesh, Vertex(outline[0]), Vertex(outline[1]));
            component_parts[number_[object_.mesh.face(first)]].outlines.push_back(std::move(outline));
        }
        return json_list(component_parts, a(), [&](const auto& entry) {
            const Part& part = entry.second;
            return json_object(a(), "area", part.area, "inside", place(centroid(object_.mesh, Face(part.largest))), "outlines",
                               json_list(part.outlines, a(), [&](const Outline& outline) { return vertex_list(outline); }));
        });
    }

    JsonValue places(const Annotation& annotation) {
        JsonValue result(rapidjson::kObjectType);
        if (annotation.type == AnnotationType::point) add_members(result, a(), "points", vertex_list(annotation.points));
        else if (annotation.type == AnnotationType::line)
            add_members(result, a(), "polylines", json_list(annotation.polylines, a(), [&](std::vector<Index> polyline) {
                            const bool closed = polyline.size() > 3 && polyline.front() == polyline.back();
                            if (closed) polyline.pop_back();
                            return json_object(a(), "closed", closed, "points", vertex_list(polyline));
                        }));
        else if (annotation.all) add_members(result, a(), "all", true);
        else add_members(result, a(), "parts", parts(annotation));
        JsonValue pins(rapidjson::kObjectType), repeats(rapidjson::kObjectType);
        for (const Attribute& attribute : annotation.attributes) {
            if (attribute.measure() == nullptr) continue;
            const Measure& measure = *attribute.measure();
            const auto pin = [&](const SurfacePoint& location) { return place(position(object_.mesh, location)); };
            add_members(pins, a(), std::to_string(attribute.id),
                        measure.locations.empty() ? vertex_list(measure.points) : json_list(measure.locations, a(), pin));
            const auto picking = [&](const std::vector<Index>& picked) { return vertex_list(picked); };
            add_nonempty_members(repeats, a(), std::to_string(attribute.id), json_list(measure.repeats, a(), picking));
        }
        add_nonempty_members(result, a(), "pins", std::move(pins), "repeats", std::move(repeats));
        return result;
    }

    const AnnotatedMeshView object_;
    Json native_;
    std::vector<Index> number_;
    std::string checksum_, source_;
    Json document_;
};

}  // namespace

std::string web_annotations(AnnotatedMeshView object, const std::string& mesh_file, const Provenance& provenance) {
    return WebWriter(object, mesh_file, provenance).write();
}

}  // namespace ostraka
