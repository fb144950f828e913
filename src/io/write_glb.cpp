#include "formats.h"
#include "ostraka/core/error.h"
#include "ostraka/io/glb.h"
#include "text_writer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka::io {

Notes write_glb(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options) {
    if (soup.triangles.empty())
        throw Error(ErrorKind::failure, file.string(), "glTF does not hold a mesh without triangles", "write PLY, OBJ or OFF");
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
                throw Error(ErrorKind::failure, file.string(), "a coordinate does not fit the single precision of glTF",
                            "write PLY, OBJ or OFF, or rescale the mesh");
            const auto narrow = static_cast<float>(x);
            rounded = rounded || static_cast<double>(narrow) != x;
            low[k] = std::min(low[k], narrow);
            high[k] = std::max(high[k], narrow);
        }
    if (coloured)
        for (std::size_t i = 0; i < count && !translucent; ++i) translucent = colour_of(i)[3] != 255;

    glb::Builder builder;
    auto& allocator = builder.allocator();
    Json& root = builder.document();
    const auto in_list = [&](JsonValue value) {
        JsonValue list(rapidjson::kArrayType);
        list.PushBack(value, allocator);
        return list;
    };
    if (!options.comment.empty()) {
        JsonValue extras_of_asset(rapidjson::kObjectType);
        add_member(extras_of_asset, "provenance", one_line(options.comment), allocator);
        add_member(root["asset"], "extras", std::move(extras_of_asset), allocator);
    }
    JsonValue attributes(rapidjson::kObjectType), primitive(rapidjson::kObjectType), mesh(rapidjson::kObjectType),
        node(rapidjson::kObjectType), scene(rapidjson::kObjectType), surface(rapidjson::kObjectType),
        material(rapidjson::kObjectType), minimum(rapidjson::kArrayType), maximum(rapidjson::kArrayType);
    for (const float x : low) minimum.PushBack(static_cast<double>(x), allocator);
    for (const float x : high) maximum.PushBack(static_cast<double>(x), allocator);
    add_member(
        attributes, "POSITION",
        JsonValue(builder.announce_accessor(12 * count, glb::array_buffer, glb::single, count, "VEC3", &minimum, &maximum)),
        allocator);
    if (coloured) {
        const int colours = builder.announce_accessor(8 * count, glb::array_buffer, glb::short_word, count, "VEC4");
        builder.mark_normalised(colours);
        add_member(attributes, "COLOR_0", JsonValue(colours), allocator);
    }
    if (textured)
        add_member(attributes, "TEXCOORD_0",
                   JsonValue(builder.announce_accessor(8 * count, glb::array_buffer, glb::single, count, "VEC2")), allocator);
    add_member(primitive, "attributes", std::move(attributes), allocator);
    add_member(
        primitive, "indices",
        JsonValue(builder.announce_accessor(4 * corner_count, glb::element_array_buffer, glb::word, corner_count, "SCALAR")),
        allocator);
    add_member(primitive, "mode", JsonValue(glb::triangles_mode), allocator);
    add_member(primitive, "material", JsonValue(0), allocator);
    add_member(mesh, "primitives", in_list(std::move(primitive)), allocator);
    add_member(node, "mesh", JsonValue(0), allocator);
    add_member(scene, "nodes", in_list(JsonValue(0)), allocator);
    add_member(surface, "metallicFactor", JsonValue(0), allocator);
    add_member(surface, "roughnessFactor", JsonValue(1), allocator);
    add_member(material, "pbrMetallicRoughness", std::move(surface), allocator);
    if (translucent) add_member(material, "alphaMode", "BLEND", allocator);
    add_member(material, "doubleSided", JsonValue(true), allocator);
    add_member(root, "scene", JsonValue(0), allocator);
    add_member(root, "scenes", in_list(std::move(scene)), allocator);
    add_member(root, "nodes", in_list(std::move(node)), allocator);
    add_member(root, "meshes", in_list(std::move(mesh)), allocator);
    add_member(root, "materials", in_list(std::move(material)), allocator);
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
        writer.bytes(1 - t);  // the image's first row is at the top in glTF, at the bottom in OBJ and PLY
        writer.flush_if_full();
    }
    for (std::size_t i = 0; i < corner_count; ++i) {
        writer.bytes(split ? static_cast<std::uint32_t>(i) : soup.triangles[i / 3][i % 3]);
        writer.flush_if_full();
    }
    writer.commit();

    Notes notes;
    if (rounded) notes.emplace_back("GLB holds coordinates in single precision; they were rounded");
    if (split) notes.emplace_back("vertices were split so that GLB can hold the data of faces and corners");
    if (!extras.vertex_colours.empty() && !extras.face_colours.empty())
        notes.emplace_back("GLB holds one set of colours; those of faces are left out");
    if (!extras.vertex_texture.empty() && !extras.corner_texture.empty())
        notes.emplace_back("GLB holds one set of texture coordinates here; those of corners are left out");
    if (!extras.vertex_labels.empty() || !extras.face_labels.empty()) notes.emplace_back("GLB does not hold labels");
    return notes;
}

}  // namespace ostraka::io
