#include "ostraka/annotation/label_file.h"

#include "ostraka/annotation/colouring.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"

#include <algorithm>
#include <charconv>

namespace ostraka {

namespace {

std::int32_t parse_label(std::string_view text, const std::string& where) {
    std::int32_t label = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), label);
    if (code != std::errc() || end != text.data() + text.size())
        fail_input(where, "'" + std::string(text.substr(0, 40)) + "' is not a label",
                   "give one whole number of 32 bits per line");
    return label;
}

}  // namespace

std::vector<std::int32_t> read_labels(const Path& file, std::size_t face_count, const std::vector<Index>& polygon_of_triangle) {
    const std::string text = read_file(file);
    std::vector<std::int32_t> labels;
    std::size_t line_number = 0, blank_since = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::string_view line = trimmed(line_at(text, at));
        ++line_number;
        if (line.empty()) {
            if (blank_since == 0) blank_since = line_number;
            continue;
        }
        if (blank_since != 0)
            fail_input(file.string() + ", line " + std::to_string(blank_since), "the line is empty",
                       "give one whole number per line");
        labels.push_back(parse_label(line, file.string() + ", line " + std::to_string(line_number)));
    }
    if (labels.size() == face_count) return labels;
    const std::size_t polygons = polygon_of_triangle.empty()
                                     ? face_count
                                     : *std::max_element(polygon_of_triangle.begin(), polygon_of_triangle.end()) + std::size_t{1};
    if (labels.size() != polygons) {
        const std::string counts = polygons == face_count
                                       ? std::to_string(face_count) + " faces"
                                       : std::to_string(polygons) + " polygons (" + std::to_string(face_count) + " triangles)";
        fail_input(file.string(), std::to_string(labels.size()) + " labels for a mesh of " + counts,
                   "give the labels of this mesh, one for each face");
    }
    std::vector<std::int32_t> per_triangle;
    per_triangle.reserve(polygon_of_triangle.size());
    for (const Index polygon : polygon_of_triangle) per_triangle.push_back(labels[polygon]);
    return per_triangle;
}

void write_labels(const Path& file, const std::vector<std::int32_t>& labels) {
    std::string text;
    text.reserve(3 * labels.size());
    for (const std::int32_t label : labels) text += std::to_string(label) + '\n';
    write_file(file, text);
}

std::map<std::int32_t, std::string> read_label_names(const Path& file) {
    const Json document = read_json(file);
    std::map<std::int32_t, std::string> names;
    const auto add = [&](std::int32_t label, const JsonValue& name, const std::string& pointer) {
        if (!name.IsString())
            fail_input(file.string(), "at " + pointer + ": a name must be text", R"(write {"0": "head", "1": "arm"})");
        names[label] = text_of(name);
    };
    if (document.IsObject()) {
        for (const auto& member : document.GetObject()) {
            const std::string key = text_of(member.name);
            add(parse_label(key, file.string() + ", at /" + key), member.value, "/" + key);
        }
    } else if (document.IsArray()) {
        for (rapidjson::SizeType i = 0; i < document.Size(); ++i)
            add(static_cast<std::int32_t>(i), document[i], "/" + std::to_string(i));
    } else {
        fail_input(file.string(), "at the root: neither an object nor a list",
                   R"(write {"0": "head", "1": "arm"} or ["head", "arm"])");
    }
    return names;
}

AnnotationSet regions_from_labels(const Mesh& mesh, const std::vector<std::int32_t>& face_labels,
                                  const std::map<std::int32_t, std::string>& names) {
    if (face_labels.size() != mesh.number_of_faces())
        fail_input("labels",
                   std::to_string(face_labels.size()) + " labels for " + std::to_string(mesh.number_of_faces()) + " faces");
    std::map<std::int32_t, std::vector<Index>> faces;
    auto last = faces.end();
    for (std::size_t face = 0; face < face_labels.size(); ++face) {
        const std::int32_t label = face_labels[face];
        if (label == no_label) continue;
        if (last == faces.end() || last->first != label) last = faces.try_emplace(label).first;
        last->second.push_back(static_cast<Index>(face));
    }
    AnnotationSet set;
    for (auto& [label, list] : faces) {
        Annotation& annotation = set.annotations.emplace_back();
        const auto name = names.find(label);
        annotation.id = label;
        annotation.tag = name == names.end() ? "part " + std::to_string(label) : name->second;
        annotation.faces = std::move(list);
    }
    colour_regions(mesh, set);
    return set;
}

std::vector<std::int32_t> face_labels_from_vertices(const Mesh& mesh, const std::vector<std::int32_t>& vertex_labels) {
    if (vertex_labels.size() != mesh.number_of_vertices())
        fail_input("labels", std::to_string(vertex_labels.size()) + " labels for " + std::to_string(mesh.number_of_vertices()) +
                                 " vertices");
    std::vector<std::int32_t> labels;
    labels.reserve(mesh.number_of_faces());
    for (const Face face : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, face);
        labels.push_back(vertex_labels[b] == vertex_labels[c] ? vertex_labels[b] : vertex_labels[a]);
    }
    return labels;
}

namespace {

/// The id of the smallest region on each face.
std::vector<std::int32_t> labels_on_top(AnnotatedMeshView object) {
    std::vector<std::int32_t> labels(object.mesh.number_of_faces(), no_label);
    for (const Annotation* region : regions_largest_first(object))
        if (!region->all)
            for (const Index face : region->faces) labels[face] = region->id;
    return labels;
}

}  // namespace

FaceLabels face_labels(AnnotatedMeshView object) {
    FaceLabels result;
    const EdgeAlignedAnnotations along_edges(object);
    result.of_face = labels_on_top(along_edges.object());
    if (!along_edges.cut()) return result;
    // A face cut by outlines gets the label of most of its area.
    const std::vector<std::int32_t> parts = std::move(result.of_face);
    const std::vector<Index>& origin = along_edges.cut()->face_origin;
    result.of_face.assign(object.mesh.number_of_faces(), no_label);
    double lost = 0, area = 0;
    for (std::size_t f = 0; f < origin.size();) {
        std::map<std::int32_t, double> shares;
        const Index face = origin[f];
        double whole = 0;
        for (; f < origin.size() && origin[f] == face; ++f) {
            const double part = face_area(along_edges.object().mesh, Face(static_cast<Index>(f)));
            shares[parts[f]] += part;
            whole += part;
        }
        const auto most =
            std::max_element(shares.begin(), shares.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
        result.of_face[face] = most->first;
        lost += whole - most->second;
        area += whole;
    }
    result.lost = area > 0 ? lost / area : 0;
    return result;
}

std::vector<std::int32_t> labels_of(AnnotatedMeshView object) { return face_labels(object).of_face; }

}  // namespace ostraka
