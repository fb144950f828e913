#include "ostraka/io/carry_extras.h"

#include <algorithm>
#include <limits>

namespace ostraka {

namespace {

template <class Value>
std::vector<Value> picked(const std::vector<Value>& values, const std::vector<Index>* sources, const Value& missing) {
    if (values.empty() || sources == nullptr) return values;
    std::vector<Value> result;
    result.reserve(sources->size());
    for (const Index source : *sources) result.push_back(source == no_index ? missing : values[source]);
    return result;
}

std::vector<NamedValues> picked(const std::vector<NamedValues>& columns, const std::vector<Index>* sources) {
    std::vector<NamedValues> result;
    for (const NamedValues& column : columns)
        result.push_back({column.name, picked(column.values, sources, std::numeric_limits<double>::quiet_NaN())});
    return result;
}

}  // namespace

MeshExtras carried(const MeshExtras& extras, const ElementSources& sources) {
    MeshExtras result;
    const Colour white{255, 255, 255, 255};
    result.vertex_colours = picked(extras.vertex_colours, sources.vertices, white);
    result.vertex_labels = picked(extras.vertex_labels, sources.vertices, std::int32_t{0});
    result.vertex_values = picked(extras.vertex_values, sources.vertices);
    result.face_colours = picked(extras.face_colours, sources.faces, white);
    result.face_labels = picked(extras.face_labels, sources.faces, std::int32_t{0});
    result.face_materials = picked(extras.face_materials, sources.faces, no_index);
    result.face_values = picked(extras.face_values, sources.faces);
    result.corner_texture = picked(extras.corner_texture, sources.corners, TexturePoint{0, 0});
    result.appearance = extras.appearance;
    return result;
}

std::vector<Index> corner_sources(const Mesh& part, const std::vector<Index>& vertices, const std::vector<Index>& faces,
                                  const Mesh& whole) {
    std::vector<Index> sources;
    sources.reserve(3 * faces.size());
    for (const Face face : part.faces()) {
        const Index source = faces[face];
        if (source == no_index) {
            sources.insert(sources.end(), 3, no_index);
            continue;
        }
        const auto whole_corners = corners(whole, Face(source));
        for (const Vertex v : corners(part, face)) {
            const auto place = std::find(whole_corners.begin(), whole_corners.end(), Vertex(vertices[v]));
            sources.push_back(place == whole_corners.end() ? no_index
                                                           : 3 * source + static_cast<Index>(place - whole_corners.begin()));
        }
    }
    return sources;
}

std::vector<bool> texture_seams(const Mesh& mesh, const MeshExtras& extras) {
    std::vector<bool> seams(mesh.number_of_edges(), false);
    if (extras.corner_texture.empty() && extras.face_materials.empty()) return seams;
    const auto texture_of = [&](Halfedge h) {  // at the target of h in its face
        const auto vertices = corners(mesh, mesh.face(h));
        std::size_t k = 0;
        while (vertices[k] != mesh.target(h)) ++k;
        return extras.corner_texture[3 * static_cast<std::size_t>(mesh.face(h)) + k];
    };
    for (const Edge edge : mesh.edges()) {
        const Halfedge h = mesh.halfedge(edge, 0), o = mesh.opposite(h);
        if (mesh.is_border(h) || mesh.is_border(o)) continue;
        bool seam = !extras.face_materials.empty() && extras.face_materials[mesh.face(h)] != extras.face_materials[mesh.face(o)];
        if (!seam && !extras.corner_texture.empty())
            seam = texture_of(h) != texture_of(mesh.prev(o)) || texture_of(o) != texture_of(mesh.prev(h));
        seams[edge] = seam;
    }
    return seams;
}

}  // namespace ostraka
