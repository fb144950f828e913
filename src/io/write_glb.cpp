#include "io/formats.h"
#include "io/text_writer.h"
#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"
#include "ostraka/io/glb.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka::io {

Notes write_glb(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options) {
    if (soup.triangles.empty()) fail_work(file.string(), "glTF cannot store a mesh without triangles", "write PLY, OBJ or OFF");
    const bool corner_texture = extras.vertex_texture.empty() && !extras.corner_texture.empty();
    const bool textured = corner_texture || !extras.vertex_texture.empty();
    const bool face_coloured = extras.vertex_colours.empty() && !extras.face_colours.empty();
    const bool coloured = face_coloured || !extras.vertex_colours.empty();
    const bool split = corner_texture || face_coloured;
    const std::size_t corner_count = 3 * soup.triangles.size(), count = split ? corner_count : soup.points.size();
    constexpr const char* too_large = "write PLY, or simplify the mesh";
    glb::check_size(count * 28 + corner_count * 4, file.string(), too_large);
    const auto vertex_of = [&](std::size_t i) { return split ? soup.triangles[i / 3][i % 3] : static_cast<Index>(i); };
    const auto colour_of = [&](std::size_t i) -> const Colour& {
        return face_coloured ? extras.face_colours[i / 3] : extras.vertex_colours[vertex_of(i)];
    };

    bool rounded = false, translucent = false;
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::max());
    high.fill(std::numeric_limits<float>::lowest());
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const double x = soup.points[vertex_of(i)][k];
            if (std::fabs(x) > static_cast<double>(std::numeric_limits<float>::max()))
                fail_work(file.string(), "a coordinate does not fit the single precision of glTF",
                          "write PLY, OBJ or OFF, or rescale the mesh");
            const auto single = static_cast<float>(x);
            rounded = rounded || static_cast<double>(single) != x;
            low[k] = std::min(low[k], single);
            high[k] = std::max(high[k], single);
        }
    if (coloured)
        for (std::size_t i = 0; i < count && !translucent; ++i) translucent = colour_of(i)[3] != 255;

    glb::Builder builder;
    auto& allocator = builder.allocator();
    Json& root = builder.document();
    const auto in_list = [&](JsonValue value) { return json_list_of(std::move(value), allocator); };
    if (!options.comment.empty())
        add_members(root["asset"], allocator, "extras", json_object(allocator, "provenance", one_line(options.comment)));
    JsonValue minimum = json_value(low, allocator), maximum = json_value(high, allocator);
    JsonValue attributes =
        json_object(allocator, "POSITION",
                    builder.announce_accessor(12 * count, glb::array_buffer, glb::single, count, "VEC3", &minimum, &maximum));
    if (coloured) {
        const int colours = builder.announce_accessor(8 * count, glb::array_buffer, glb::short_word, count, "VEC4");
        builder.mark_normalised(colours);
        add_members(attributes, allocator, "COLOR_0", colours);
    }
    if (textured)
        add_members(attributes, allocator, "TEXCOORD_0",
                    builder.announce_accessor(8 * count, glb::array_buffer, glb::single, count, "VEC2"));
    const int indices = builder.announce_accessor(4 * corner_count, glb::element_array_buffer, glb::word, corner_count, "SCALAR");
    JsonValue primitive = json_object(allocator, "attributes", std::move(attributes), "indices", indices, "mode",
                                      glb::triangles_mode, "material", 0);
    JsonValue mesh = json_object(allocator, "primitives", in_list(std::move(primitive)));
    JsonValue material =
        json_object(allocator, "pbrMetallicRoughness", json_object(allocator, "metallicFactor", 0, "roughnessFactor", 1));
    add_nonempty_members(material, allocator, "alphaMode", std::string(translucent ? "BLEND" : ""), "doubleSided", true);
    add_members(root, allocator, "scene", 0, "scenes", in_list(json_object(allocator, "nodes", std::array{0})), "nodes",
                in_list(json_object(allocator, "mesh", 0)), "meshes", in_list(std::move(mesh)), "materials",
                in_list(std::move(material)));
    const std::string head = builder.head(file.string(), too_large);

    TextWriter writer(file);
    writer.text(head);
    for (std::size_t i = 0; i < count; ++i) {
        for (const double x : soup.points[vertex_of(i)]) writer.bytes(static_cast<float>(x));
        writer.flush_if_full();
    }
    for (std::size_t i = 0; coloured && i < count; ++i) {
        const Colour& colour = colour_of(i);
        for (std::size_t k = 0; k < 3; ++k) writer.bytes(glb::linear_channel(colour[k]));
        writer.bytes(static_cast<std::uint16_t>(257 * colour[3]));
        writer.flush_if_full();
    }
    for (std::size_t i = 0; textured && i < count; ++i) {
        const auto& [s, t] = corner_texture ? extras.corner_texture[i] : extras.vertex_texture[vertex_of(i)];
        writer.bytes(s);
        writer.bytes(1 - t);  // the first row of an image is at the top in glTF, at the bottom in OBJ and PLY
        writer.flush_if_full();
    }
    for (std::size_t i = 0; i < corner_count; ++i) {
        writer.bytes(split ? static_cast<std::uint32_t>(i) : soup.triangles[i / 3][i % 3]);
        writer.flush_if_full();
    }
    writer.commit();

    Notes notes;
    if (rounded) notes.emplace_back("GLB stores coordinates in single precision; they were rounded");
    if (split) notes.emplace_back("vertices were split so that GLB can store the data of faces and corners");
    if (!extras.vertex_colours.empty() && !extras.face_colours.empty())
        notes.emplace_back("GLB stores one set of colours; those of faces are dropped");
    if (!extras.vertex_texture.empty() && !extras.corner_texture.empty())
        notes.emplace_back("GLB stores one set of texture coordinates; those of corners are dropped");
    if (!extras.vertex_labels.empty() || !extras.face_labels.empty()) notes.emplace_back("GLB cannot store labels");
    return notes;
}

}  // namespace ostraka::io
