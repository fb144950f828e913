#include "io/formats.h"
#include "io/text_writer.h"

#include <fmt/core.h>

namespace ostraka::io {

Notes write_off(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options) {
    TextWriter writer(file);
    const WrittenFaces faces(soup, options);
    const bool textured = !extras.vertex_texture.empty(), coloured = !extras.vertex_colours.empty();
    writer.text(fmt::format("{}{}OFF\n", textured ? "ST" : "", coloured ? "C" : ""));
    if (!options.comment.empty()) writer.text(fmt::format("# {}\n", one_line(options.comment)));
    writer.text(fmt::format("{} {} 0\n", soup.points.size(), faces.size()));
    for (std::size_t v = 0; v < soup.points.size(); ++v) {
        const auto& [x, y, z] = soup.points[v];
        writer.number(x);
        writer.numbers({y, z});
        if (coloured)
            for (const std::uint8_t c : extras.vertex_colours[v]) writer.numbers<unsigned>({c});
        if (textured) writer.numbers({extras.vertex_texture[v][0], extras.vertex_texture[v][1]});
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
    if (!extras.corner_texture.empty()) notes.emplace_back("OFF cannot store texture coordinates of corners");
    return notes;
}

}  // namespace ostraka::io
