// Annotations -> W3C Web Annotation JSON-LD.
#include "ostraka/interchange/web_annotation.h"

#include "text.h"
#include "web_terms.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/core/json_build.h"

#include <algorithm>
#include <map>

namespace ostraka {

namespace {

using namespace interchange;

/// A name for ever for a thing that `content` describes: a UUID of version 8 (RFC 9562) from its SHA-256.
std::string uuid_of(const std::string& content) {
    std::string hex = sha256(content).substr(0, 32);
    hex[12] = '8';
    hex[16] = "89ab"[static_cast<std::size_t>(hex[16] >= 'a' ? hex[16] - 'a' + 10 : hex[16] - '0') % 4];
    return "urn:uuid:" + hex.substr(0, 8) + "-" + hex.substr(8, 4) + "-" + hex.substr(12, 4) + "-" + hex.substr(16, 4) + "-" +
           hex.substr(20);
}

/// A file name as a relative IRI (RFC 3986): everything but unreserved characters as percent codes.
std::string iri_of(const std::string& name) {
    std::string iri;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.' ||
                           c == '_' || c == '~';
        if (plain) iri += c;
        else iri += std::string("%") + "0123456789ABCDEF"[byte >> 4] + "0123456789ABCDEF"[byte & 15];
    }
    return iri.empty() ? "mesh" : iri;
}

class WebWriter {
public:
    WebWriter(const Mesh& mesh, const AnnotationSet& set, const std::string& mesh_file, const Provenance& provenance)
        : mesh_(mesh), set_(set), native_(annotations_to_json(set, mesh, mesh_file, provenance)), number_(components()) {
        document_.SetObject();
        checksum_ = text_member(native_["mesh"], "sha256");
        source_ = iri_of(Path(mesh_file).filename().string());
    }

    std::string write() {
        JsonValue items(rapidjson::kArrayType);
        std::string all = checksum_;
        const JsonValue& list = native_["annotations"];
        for (rapidjson::SizeType i = 0; i < list.Size(); ++i) {
            JsonValue item = annotation(list[i], set_.annotations[i]);
            all += text_member(item, "id");
            items.PushBack(item, a());
        }
        const std::string collection = uuid_of(all);
        add_members(document_, a(), "@context", context(), "id", collection, "type", "AnnotationCollection", "label",
                    set_.object_class.empty() ? "annotations" : set_.object_class);
        JsonValue generator = json_object(a(), "id", "urn:x-ostraka:tool", "type", "Software", "name", "ostraka " + version());
        add_members(document_, a(), "generator", std::move(generator), "total", items.Size());
        JsonValue about(rapidjson::kObjectType);
        for (const char* name : {"class", "unit", "up", "provenance"})
            if (const JsonValue* value = find_member(native_, name)) add_member(about, name, JsonValue(*value, a()), a());
        add_member(document_, "about", std::move(about), a());
        JsonValue page = json_object(a(), "id", uuid_of(all + "page"), "type", "AnnotationPage", "partOf", collection,
                                     "startIndex", 0, "items", std::move(items));
        add_member(document_, "first", std::move(page), a());
        return json_text(document_);
    }

private:
    JsonAllocator& a() { return document_.GetAllocator(); }

    JsonValue context() {
        JsonValue terms(rapidjson::kObjectType), list(rapidjson::kArrayType);
        add_members(terms, a(), "@version", 1.1, "ostraka", web::terms);
        for (const char* name : {"sha256", "vertices", "faces"}) add_member(terms, name, std::string("ostraka:") + name, a());
        for (const char* name : {"indices", "places", "about"}) {
            JsonValue term = json_object(a(), "@id", std::string("ostraka:") + name, "@type", "@json");
            add_member(terms, name, std::move(term), a());
        }
        list.PushBack(json_string(web::context, a()), a());
        list.PushBack(terms, a());
        return list;
    }

    JsonValue body(const char* purpose, const char* format, const std::string& value) {
        JsonValue result = json_object(a(), "type", "TextualBody", "purpose", purpose, "format", format, "value", value);
        return result;
    }

    static std::string in_words(const Attribute& attribute) {
        if (attribute.type == AttributeType::semantic) return attribute.name + ": " + attribute.note;
        const bool measured = attribute.type == AttributeType::measure;
        std::string text = attribute.name + ":";
        if (measured && attribute.measure.value) text += " " + digits(*attribute.measure.value);
        for (std::size_t i = 0; !measured && i < attribute.descriptor.values.size() && i < 8; ++i)
            text += " " + digits(attribute.descriptor.values[i]);
        const std::string& unit = measured ? attribute.measure.unit : attribute.descriptor.unit;
        if (!unit.empty()) text += " " + unit;
        return text + ((measured ? attribute.measure.stale : attribute.descriptor.stale) ? " (stale)" : "");
    }

    JsonValue annotation(const JsonValue& native, const Annotation& annotation) {
        Json data(rapidjson::kObjectType);
        JsonValue indices(rapidjson::kObjectType);
        for (const auto& member : native.GetObject()) {
            const std::string name(member.name.GetString(), member.name.GetStringLength());
            if (name == "id" || name == "tag" || name == "colour" || name == "type" || name == "note" || name == "attributes")
                add_member(data, name, JsonValue(member.value, data.GetAllocator()), data.GetAllocator());
            else add_member(indices, name, JsonValue(member.value, a()), a());
        }
        const std::string data_text(trimmed(to_text(data)));
        JsonValue bodies(rapidjson::kArrayType);
        bodies.PushBack(body("tagging", "text/plain", annotation.tag), a());
        for (const Attribute& attribute : annotation.attributes)
            bodies.PushBack(body("describing", "text/plain", in_words(attribute)), a());
        bodies.PushBack(body("describing", "application/json", data_text), a());

        JsonValue by_index(rapidjson::kObjectType), by_place(rapidjson::kObjectType), selectors(rapidjson::kArrayType);
        add_members(by_index, a(), "type", web::index_selector, "indices", std::move(indices));
        add_members(by_place, a(), "type", web::place_selector, "places", places(annotation));
        selectors.PushBack(by_index, a());
        selectors.PushBack(by_place, a());
        JsonValue source(rapidjson::kObjectType), target(rapidjson::kObjectType), result(rapidjson::kObjectType);
        add_members(source, a(), "id", source_, "type", "Dataset");
        for (const char* name : {"vertices", "faces", "sha256"})
            add_member(source, name, JsonValue(native_["mesh"][name], a()), a());
        add_members(target, a(), "type", "SpecificResource", "source", std::move(source), "selector", std::move(selectors));
        add_members(result, a(), "id", uuid_of(checksum_ + to_text(native)), "type", "Annotation", "motivation", "describing",
                    "body", std::move(bodies), "target", std::move(target));
        return result;
    }

    JsonValue place(const Point& p) { return triple_json({p.x(), p.y(), p.z()}, a()); }
    JsonValue place(Index vertex) { return place(mesh_.point(Vertex(vertex))); }

    JsonValue vertex_list(const std::vector<Index>& vertices) {
        JsonValue list(rapidjson::kArrayType);
        for (const Index vertex : vertices) list.PushBack(place(vertex), a());
        return list;
    }

    /// The number of its connected component for each face.
    [[nodiscard]] std::vector<Index> components() const {
        std::vector<Index> number(mesh_.number_of_faces(), no_index);
        Index count = 0;
        for (const Face start : mesh_.faces()) {
            if (number[start] != no_index) continue;
            std::vector<Face> stack{start};
            number[start] = count;
            while (!stack.empty()) {
                const Halfedge first = mesh_.halfedge(stack.back());
                stack.pop_back();
                for (const Halfedge h : mesh_.halfedges_around_face(first)) {
                    const Face next = mesh_.face(mesh_.opposite(h));
                    if (next == Mesh::null_face() || number[next] != no_index) continue;
                    number[next] = count;
                    stack.push_back(next);
                }
            }
            ++count;
        }
        return number;
    }

    /// A part for each component of the mesh that the region lies on, since winding numbers are counted within one.
    JsonValue parts(const Annotation& annotation) {
        struct Part {
            double area = 0;
            Index largest = no_index;
            double largest_area = -1;
            std::vector<Outline> outlines;
        };
        std::map<Index, Part> found;
        for (const Index face : annotation.faces) {
            Part& part = found[number_[face]];
            const double area = face_area(mesh_, Face(face));
            part.area += area;
            if (area > part.largest_area) {
                part.largest_area = area;
                part.largest = face;
            }
        }
        for (Outline& outline : extract_outlines(mesh_, annotation.faces)) {
            const Halfedge first = find_halfedge(mesh_, Vertex(outline[0]), Vertex(outline[1]));
            found[number_[mesh_.face(first)]].outlines.push_back(std::move(outline));
        }
        JsonValue list(rapidjson::kArrayType);
        for (const auto& [component, part] : found) {
            JsonValue entry(rapidjson::kObjectType), outlines(rapidjson::kArrayType);
            for (const Outline& outline : part.outlines) outlines.PushBack(vertex_list(outline), a());
            add_members(entry, a(), "area", part.area, "inside", place(centroid(mesh_, Face(part.largest))), "outlines",
                        std::move(outlines));
            list.PushBack(entry, a());
        }
        return list;
    }

    JsonValue places(const Annotation& annotation) {
        JsonValue result(rapidjson::kObjectType);
        switch (annotation.type) {
            case AnnotationType::point:
                add_member(result, "points", vertex_list(annotation.points), a());
                break;
            case AnnotationType::line: {
                JsonValue list(rapidjson::kArrayType);
                for (std::vector<Index> polyline : annotation.polylines) {
                    const bool closed = polyline.size() > 3 && polyline.front() == polyline.back();
                    if (closed) polyline.pop_back();
                    JsonValue entry = json_object(a(), "closed", closed, "points", vertex_list(polyline));
                    list.PushBack(entry, a());
                }
                add_member(result, "polylines", std::move(list), a());
                break;
            }
            case AnnotationType::region:
                if (annotation.all) add_member(result, "all", JsonValue(true), a());
                else add_member(result, "parts", parts(annotation), a());
                break;
        }
        JsonValue pins(rapidjson::kObjectType), repeats(rapidjson::kObjectType);
        for (const Attribute& attribute : annotation.attributes) {
            if (attribute.type != AttributeType::measure) continue;
            const Measure& measure = attribute.measure;
            JsonValue list(rapidjson::kArrayType);
            for (std::size_t i = 0; i < measure.points.size(); ++i)
                list.PushBack(measure.locations.empty() ? place(measure.points[i]) : place(at(measure.locations[i])), a());
            add_member(pins, std::to_string(attribute.id), std::move(list), a());
            if (measure.repeats.empty()) continue;
            JsonValue pickings(rapidjson::kArrayType);
            for (const auto& picked : measure.repeats) {
                JsonValue again(rapidjson::kArrayType);
                for (const Index vertex : picked) again.PushBack(place(vertex), a());
                pickings.PushBack(again, a());
            }
            add_member(repeats, std::to_string(attribute.id), std::move(pickings), a());
        }
        if (pins.MemberCount() > 0) add_member(result, "pins", std::move(pins), a());
        if (repeats.MemberCount() > 0) add_member(result, "repeats", std::move(repeats), a());
        return result;
    }

    [[nodiscard]] Point at(const Location& location) const {
        const auto [p, q, r] = corners(mesh_, Face(location.face));
        const auto& w = location.barycentric;
        const Vector sum = w[0] * (mesh_.point(p) - CGAL::ORIGIN) + w[1] * (mesh_.point(q) - CGAL::ORIGIN) +
                           w[2] * (mesh_.point(r) - CGAL::ORIGIN);
        return CGAL::ORIGIN + sum;
    }

    const Mesh& mesh_;
    const AnnotationSet& set_;
    Json native_;
    std::vector<Index> number_;
    std::string checksum_, source_;
    Json document_;
};

}  // namespace

std::string web_annotations(const Mesh& mesh, const AnnotationSet& set, const std::string& mesh_file,
                            const Provenance& provenance) {
    return WebWriter(mesh, set, mesh_file, provenance).write();
}

}  // namespace ostraka
