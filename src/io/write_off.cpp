#include "io/formats.h"
#include "io/text_writer.h"

#include <fmt/core.h>

namespace ostraka::io {

namespace {

/// Texture coordinates of the vertices; empty if a vertex has different ones in its corners, or if there are none. Vertices
/// without corners have (0, 0).
std::vector<TexturePoint> texture_of_vertices(const TriangleSoup& soup, const std::vector<TexturePoint>& corner_texture) {
    std::vector<TexturePoint> texture;
    if (corner_texture.empty()) return texture;
    texture.assign(soup.points.size(), {0, 0});
    std::vector<bool> has_texture(soup.points.size(), false);
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const Index v = soup.triangles[t][k];
            if (has_texture[v] && texture[v] != corner_texture[3 * t + k]) return {};
            texture[v] = corner_texture[3 * t + k];
            has_texture[v] = true;
        }
    return texture;
}

}  // namespace

Notes write_off(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options) {
    TextWriter writer(file);
    const WrittenFaces faces(soup, options);
    const std::vector<TexturePoint> texture =
        options.polygons.empty() ? texture_of_vertices(soup, extras.corner_texture) : std::vector<TexturePoint>();
    const bool textured = !texture.empty(), coloured = !extras.vertex_colours.empty();
    writer.text(fmt::format("{}{}OFF\n", textured ? "ST" : "", coloured ? "C" : ""));
    if (!options.comment.empty()) writer.text(fmt::format("# {}\n", one_line(options.comment)));
    writer.text(fmt::format("{} {} 0\n", soup.points.size(), faces.size()));
    for (std::size_t v = 0; v < soup.points.size(); ++v) {
        const auto& [x, y, z] = soup.points[v];
        writer.number(x);
        writer.numbers({y, z});
        if (coloured)
            for (const std::uint8_t c : extras.vertex_colours[v]) writer.numbers<unsigned>({c});
        if (textured) writer.numbers({texture[v][0], texture[v][1]});
        writer.end_line();
    }
    for (std::size_t t = 0; t < faces.size(); ++t) {
        const auto corners = faces.corners(t);
        writer.number(corners.size());
        for (const Index v : corners) writer.numbers({v});
        if (!extras.face_colours.empty())
            for (const std::uint8_t c : extras.face_colours[t]) writer.numbers<unsigned>({c});
        writer.end_line();
    }
    writer.commit();
    Notes notes;
    if (!extras.vertex_labels.empty()) notes.emplace_back("OFF cannot store labels of vertices");
    if (!extras.face_labels.empty()) notes.emplace_back("OFF cannot store labels of faces");
    if (!extras.corner_texture.empty() && !textured)
        notes.emplace_back("OFF cannot store different texture coordinates of the corners of a vertex");
    if (!extras.appearance.empty()) notes.emplace_back("OFF cannot store materials and images");
    return notes;
}

}  // namespace ostraka::io
