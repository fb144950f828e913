#include "ostraka/annotation/remap.h"

#include "ostraka/annotation/annotation_maps.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/core/error.h"

#include <algorithm>

namespace ostraka {

namespace {

/// The face with these corners in cyclic order, or no_index.
Index face_with(const Mesh& mesh, Index a, Index b, Index c) {
    if (a == no_index || b == no_index || c == no_index || a == b || b == c || c == a) return no_index;
    const Halfedge h = find_halfedge(mesh, Vertex(a), Vertex(b));
    if (!h.is_valid() || mesh.is_border(h) || mesh.target(mesh.next(h)) != Vertex(c)) return no_index;
    return mesh.face(h);
}

}  // namespace

std::vector<Index> read_index_map(const Path& file, const std::string& kind, std::size_t from, std::size_t to) {
    const Json document = read_json(file);
    validate(document, "map", file.string());
    const std::string found = document["kind"].GetString();
    if (found != kind)
        fail_input(file.string(), "at /kind: a map of kind '" + found + "' where one of kind '" + kind + "' is needed",
                   "give the other map");
    const auto check_count = [&](const char* name, std::size_t expected, const char* which) {
        const JsonValue& value = document[name];
        if (!value.IsUint64() || value.GetUint64() != expected)
            fail_input(
                file.string(),
                std::string("at /") + name + ": does not fit the " + which + " mesh, which has " + std::to_string(expected),
                "give the map made with these two meshes");
    };
    check_count("from", from, "old");
    check_count("to", to, "new");
    const JsonValue& list = document["map"];
    if (list.Size() != from)
        fail_input(file.string(),
                   "at /map: " + std::to_string(list.Size()) + " entries for " + std::to_string(from) + " elements",
                   "make the map again");
    std::vector<Index> map;
    map.reserve(from);
    for (rapidjson::SizeType i = 0; i < list.Size(); ++i) {
        const std::int64_t entry = list[i].GetInt64();
        if (entry >= static_cast<std::int64_t>(to))
            fail_input(file.string(),
                       "at /map/" + std::to_string(i) + ": element " + std::to_string(entry) + " of " + std::to_string(to),
                       "make the map again");
        map.push_back(entry < 0 ? no_index : static_cast<Index>(entry));
    }
    return map;
}

AnnotationSet remap_annotations(AnnotatedMeshView before, const Mesh& after, const std::vector<Index>& vertex_map,
                                const std::vector<Index>& face_map) {
    if (vertex_map.size() != before.mesh.number_of_vertices() ||
        (!face_map.empty() && face_map.size() != before.mesh.number_of_faces()))
        fail_input("maps", "their lengths are not the counts of the old mesh", "give the maps made with these two meshes");
    AnnotationSet moved;
    for (const Annotation& annotation : before.annotations.annotations) {
        Annotation& now = moved.annotations.emplace_back();
        now.id = annotation.id;
        now.type = annotation.type;
        now.all = annotation.all;
        for (const Index face : annotation.faces) {
            Index place = no_index;
            if (!face_map.empty()) {
                place = face_map[face];
            } else {
                const auto [a, b, c] = corners(before.mesh, Face(face));
                place = face_with(after, vertex_map[a], vertex_map[b], vertex_map[c]);
            }
            if (place != no_index) now.faces.push_back(place);
        }
        std::sort(now.faces.begin(), now.faces.end());
        now.faces.erase(std::unique(now.faces.begin(), now.faces.end()), now.faces.end());
    }
    // The rest is the same as after an edit: regions are read from the maps on the new mesh, everything else follows the vertex
    // map.
    Mesh mesh = after;
    AnnotationTable table = attach_annotations(mesh, moved);
    table.outlines.clear();
    for (const Annotation& annotation : before.annotations.annotations)
        if (annotation.type == AnnotationType::region && !annotation.all)
            table.outlines[annotation.id] = extract_outlines(before.mesh, annotation.faces);
    return collect_annotations(mesh, table, before.annotations, vertex_map);
}

AnnotationSet annotations_of_piece(AnnotatedMeshView whole, const Mesh& piece, const std::vector<Index>& vertices,
                                   const std::vector<Index>& faces) {
    const auto inverse = [](const std::vector<Index>& kept, std::size_t count) {
        std::vector<Index> map(count, no_index);
        for (std::size_t i = 0; i < kept.size(); ++i) map.at(kept[i]) = static_cast<Index>(i);
        return map;
    };
    AnnotationSet rest = remap_annotations(whole, piece, inverse(vertices, whole.mesh.number_of_vertices()),
                                           inverse(faces, whole.mesh.number_of_faces()));
    std::erase_if(rest.annotations, [&](const Annotation& one) {
        const Annotation* before = whole.annotations.find(one.id);
        return before == nullptr || before->type != one.type ||
               (one.type == AnnotationType::point && one.points.size() != before->points.size());
    });
    return rest;
}

std::vector<std::int32_t> remap_labels(const std::vector<std::int32_t>& labels, const std::vector<Index>& face_map,
                                       std::size_t face_count) {
    if (face_map.size() != labels.size())
        fail_input("maps", "the length of the face map is not the count of the labels", "give the map made with this mesh");
    std::vector<std::int32_t> result(face_count, no_label);
    for (std::size_t face = labels.size(); face-- > 0;)  // the first of several old faces determines the label
        if (face_map[face] != no_index) {
            if (face_map[face] >= face_count)
                fail_input("maps", "face " + std::to_string(face_map[face]) + " of " + std::to_string(face_count));
            result[face_map[face]] = labels[face];
        }
    return result;
}

}  // namespace ostraka
