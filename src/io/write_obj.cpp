#include "io/formats.h"
#include "io/text_writer.h"

#include <fmt/core.h>

namespace ostraka::io {

Notes write_obj(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options) {
    TextWriter writer(file);
    if (!options.comment.empty()) writer.text(fmt::format("# {}\n", one_line(options.comment)));
    bool alpha = false;
    for (std::size_t v = 0; v < soup.points.size(); ++v) {
        writer.character('v');
        for (const double x : soup.points[v]) writer.numbers({x});
        if (!extras.vertex_colours.empty()) {
            const Colour& colour = extras.vertex_colours[v];
            for (std::size_t k = 0; k < 3; ++k) writer.numbers({static_cast<float>(colour[k]) / 255.0F});
            alpha = alpha || colour[3] != 255;
        }
        writer.end_line();
    }
    // Per-vertex texture coordinates have the numbers of the vertices; per-corner ones are numbered consecutively.
    const bool by_vertex = !extras.vertex_texture.empty(), by_corner = !by_vertex && !extras.corner_texture.empty();
    for (const auto& [s, t] : by_vertex ? extras.vertex_texture : extras.corner_texture) {
        writer.text("vt");
        writer.numbers({s, t});
        writer.end_line();
    }
    const WrittenFaces faces(soup, options);
    for (std::size_t t = 0; t < faces.size(); ++t) {
        writer.character('f');
        const auto corners = faces.corners(t);
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const Index v = corners[k];
            writer.character(' ');
            writer.number(static_cast<std::uint64_t>(v) + 1);
            if (!by_vertex && !by_corner) continue;
            writer.character('/');
            writer.number(by_vertex ? static_cast<std::uint64_t>(v) + 1 : static_cast<std::uint64_t>(3 * t + k) + 1);
        }
        writer.end_line();
    }
    writer.commit();
    Notes notes;
    if (alpha) notes.emplace_back("OBJ cannot store the opacity of colours");
    if (!extras.face_colours.empty()) notes.emplace_back("OBJ cannot store colours of faces");
    if (!extras.vertex_labels.empty()) notes.emplace_back("OBJ cannot store labels of vertices");
    if (!extras.face_labels.empty()) notes.emplace_back("OBJ cannot store labels of faces");
    if (by_vertex && !extras.corner_texture.empty())
        notes.emplace_back("texture coordinates of corners are dropped in favour of those of vertices");
    return notes;
}

}  // namespace ostraka::io
