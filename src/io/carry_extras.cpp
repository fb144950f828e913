#include "ostraka/io/carry_extras.h"

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

/// Barycentric coordinates of the projection of `p` to the plane of a triangle; {1, 0, 0} for a degenerate triangle.
std::array<double, 3> projected_barycentric(const Point& a, const Point& b, const Point& c, const Point& p) {
    const Vector u = b - a, v = c - a, w = p - a;
    const double uu = u * u, uv = u * v, vv = v * v, wu = w * u, wv = w * v, determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) return {1, 0, 0};
    const double second = (vv * wu - uv * wv) / determinant, third = (uu * wv - uv * wu) / determinant;
    return {1 - second - third, second, third};
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

std::vector<TexturePoint> texture_at_positions(const Mesh& mesh, const std::vector<Index>& origin, const Mesh& other,
                                               const std::vector<TexturePoint>& texture) {
    std::vector<TexturePoint> result;
    if (texture.empty()) return result;
    result.reserve(3 * mesh.number_of_faces());
    for (const Face face : mesh.faces()) {
        const Index source = origin[face];
        for (const Vertex vertex : corners(mesh, face)) {
            if (source == no_index) {
                result.push_back({0, 0});
                continue;
            }
            const auto [a, b, c] = corners(other, Face(source));
            const auto weights = projected_barycentric(other.point(a), other.point(b), other.point(c), mesh.point(vertex));
            TexturePoint coordinates{};
            for (std::size_t axis = 0; axis < 2; ++axis) {
                double sum = 0;
                for (std::size_t k = 0; k < 3; ++k) sum += weights[k] * static_cast<double>(texture[3 * source + k][axis]);
                coordinates[axis] = static_cast<float>(sum);
            }
            result.push_back(coordinates);
        }
    }
    return result;
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
