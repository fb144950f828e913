#include "io/formats.h"
#include "io/text_writer.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka::io {

namespace {

bool has_alpha(const std::vector<Colour>& colours) {
    return std::any_of(colours.begin(), colours.end(), [](const Colour& c) { return c[3] != 255; });
}

std::string colour_properties(bool alpha) {
    return std::string("property uchar red\nproperty uchar green\nproperty uchar blue\n") +
           (alpha ? "property uchar alpha\n" : "");
}

/// Writes values as words on lines or as bytes.
class Values {
public:
    Values(TextWriter& writer, bool ascii) : writer_(writer), ascii_(ascii) {}
    template <class T>
    void put(T value) {
        if (!ascii_) {
            writer_.bytes(value);
            return;
        }
        if (!first_) writer_.character(' ');
        first_ = false;
        if constexpr (std::is_same_v<T, std::uint8_t>) writer_.number(static_cast<unsigned>(value));
        else writer_.number(value);
    }
    void colour(const Colour& colour, bool alpha) {
        for (std::size_t k = 0; k < (alpha ? 4 : 3); ++k) put(colour[k]);
    }
    void end_element() {
        if (ascii_) writer_.character('\n');
        first_ = true;
        writer_.flush_if_full();
    }

private:
    TextWriter& writer_;
    bool ascii_, first_ = true;
};

}  // namespace

Notes write_ply(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options) {
    TextWriter writer(file);
    const bool ascii = options.encoding == Encoding::ascii;
    const bool vertex_alpha = has_alpha(extras.vertex_colours), face_alpha = has_alpha(extras.face_colours);
    const WrittenFaces faces(soup, options);
    std::size_t max_corners = 3;
    for (std::size_t t = 0; t < faces.size(); ++t) max_corners = std::max(max_corners, faces.corners(t).size());
    const bool wide_counts = max_corners > 255;
    std::string header = fmt::format("ply\nformat {} 1.0\n", ascii ? "ascii" : "binary_little_endian");
    if (!options.comment.empty()) header += fmt::format("comment {}\n", one_line(options.comment));
    header += fmt::format("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n", soup.points.size());
    if (!extras.vertex_colours.empty()) header += colour_properties(vertex_alpha);
    if (!extras.vertex_labels.empty()) header += "property int label\n";
    if (!extras.vertex_texture.empty()) header += "property float s\nproperty float t\n";
    if (!options.vertex_quality.empty()) header += "property double quality\n";
    header += fmt::format("element face {}\nproperty list {} int vertex_indices\n", faces.size(), wide_counts ? "int" : "uchar");
    if (!extras.face_colours.empty()) header += colour_properties(face_alpha);
    if (!extras.face_labels.empty()) header += "property int label\n";
    for (const FaceValues& attribute : options.face_values) header += fmt::format("property float {}\n", attribute.name);
    if (!extras.corner_texture.empty()) header += "property list uchar float texcoord\n";
    writer.text(header + "end_header\n");

    Values values(writer, ascii);
    for (std::size_t v = 0; v < soup.points.size(); ++v) {
        for (const double x : soup.points[v]) values.put(x);
        if (!extras.vertex_colours.empty()) values.colour(extras.vertex_colours[v], vertex_alpha);
        if (!extras.vertex_labels.empty()) values.put(extras.vertex_labels[v]);
        if (!extras.vertex_texture.empty())
            for (const float x : extras.vertex_texture[v]) values.put(x);
        if (!options.vertex_quality.empty()) values.put(options.vertex_quality[v]);
        values.end_element();
    }
    for (std::size_t t = 0; t < faces.size(); ++t) {
        const auto corners = faces.corners(t);
        if (wide_counts) values.put(static_cast<Index>(corners.size()));
        else values.put(static_cast<std::uint8_t>(corners.size()));
        for (const Index v : corners) values.put(v);
        if (!extras.face_colours.empty()) values.colour(extras.face_colours[t], face_alpha);
        if (!extras.face_labels.empty()) values.put(extras.face_labels[t]);
        for (const FaceValues& attribute : options.face_values) values.put(attribute.values[t]);
        if (!extras.corner_texture.empty()) {
            values.put(std::uint8_t{6});
            for (std::size_t k = 3 * t; k < 3 * t + 3; ++k)
                for (const float x : extras.corner_texture[k]) values.put(x);
        }
        values.end_element();
    }
    writer.commit();
    return {};
}

}  // namespace ostraka::io
