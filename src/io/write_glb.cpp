#include "formats.h"
#include "ostraka/core/error.h"
#include "ostraka/core/json.h"
#include "ostraka/core/provenance.h"
#include "text_writer.h"

#include <rapidjson/stringbuffer.h>
#include <rapidjson/writer.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka::io {

namespace {

// Constants of glTF 2.0 (Khronos, sections 3.6, 3.7, 5.1, 5.11).
constexpr int float_component = 5126, ushort_component = 5123, uint_component = 5125;
constexpr int array_buffer = 34962, element_array_buffer = 34963, triangles_mode = 4;
constexpr std::uint32_t glb_magic = 0x46546C67, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

/// Colours of vertices are linear in glTF (section 3.7.2.1), in our files they are sRGB (IEC 61966-2-1).
std::uint16_t linear_channel(std::uint8_t value) {
    static const auto table = [] {
        std::array<std::uint16_t, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double s = static_cast<double>(i) / 255;
            const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
            values[i] = static_cast<std::uint16_t>(std::lround(65535 * linear));
        }
        return values;
    }();
    return table[value];
}

class GlbDocument {
public:
    explicit GlbDocument(const WriteOptions& options) {
        document_.SetObject();
        JsonValue asset(rapidjson::kObjectType);
        add_member(asset, "version", "2.0", allocator());
        add_member(asset, "generator", "ostraka " + version(), allocator());
        if (!options.comment.empty()) {
            JsonValue extras(rapidjson::kObjectType);
            add_member(extras, "provenance", one_line(options.comment), allocator());
            add_member(asset, "extras", std::move(extras), allocator());
        }
        add_member(document_, "asset", std::move(asset), allocator());
    }
    JsonAllocator& allocator() { return document_.GetAllocator(); }

    /// A new buffer view of `size` bytes with one accessor over it; returns the accessor, to which min and max may be added.
    JsonValue& add_accessor(std::size_t size, int target, int component, std::size_t count, const char* type) {
        JsonValue view(rapidjson::kObjectType);
        add_member(view, "buffer", JsonValue(0), allocator());
        add_member(view, "byteOffset", JsonValue(static_cast<std::uint64_t>(offset_)), allocator());
        add_member(view, "byteLength", JsonValue(static_cast<std::uint64_t>(size)), allocator());
        add_member(view, "target", JsonValue(target), allocator());
        JsonValue accessor(rapidjson::kObjectType);
        add_member(accessor, "bufferView", JsonValue(views_.Size()), allocator());
        add_member(accessor, "componentType", JsonValue(component), allocator());
        add_member(accessor, "count", JsonValue(static_cast<std::uint64_t>(count)), allocator());
        add_member(accessor, "type", type, allocator());
        views_.PushBack(view, allocator());
        accessors_.PushBack(accessor, allocator());
        offset_ += size;
        return accessors_[accessors_.Size() - 1];
    }
    int last_accessor() const { return static_cast<int>(accessors_.Size()) - 1; }
    std::size_t buffer_size() const { return offset_; }

    /// The JSON chunk: one mesh of one primitive with the attributes given, under one node.
    std::string finish(JsonValue attributes, int indices, bool translucent) {
        auto& a = allocator();
        JsonValue primitive(rapidjson::kObjectType);
        add_member(primitive, "attributes", std::move(attributes), a);
        add_member(primitive, "indices", JsonValue(indices), a);
        add_member(primitive, "mode", JsonValue(triangles_mode), a);
        add_member(primitive, "material", JsonValue(0), a);
        JsonValue mesh(rapidjson::kObjectType), node(rapidjson::kObjectType), scene(rapidjson::kObjectType),
            buffer(rapidjson::kObjectType);
        add_member(mesh, "primitives", in_list(std::move(primitive)), a);
        add_member(node, "mesh", JsonValue(0), a);
        add_member(scene, "nodes", in_list(JsonValue(0)), a);
        add_member(buffer, "byteLength", JsonValue(static_cast<std::uint64_t>(offset_)), a);
        JsonValue surface(rapidjson::kObjectType), material(rapidjson::kObjectType);
        add_member(surface, "metallicFactor", JsonValue(0), a);
        add_member(surface, "roughnessFactor", JsonValue(1), a);
        add_member(material, "pbrMetallicRoughness", std::move(surface), a);
        if (translucent) add_member(material, "alphaMode", "BLEND", a);
        add_member(material, "doubleSided", JsonValue(true), a);
        add_member(document_, "scene", JsonValue(0), a);
        add_member(document_, "scenes", in_list(std::move(scene)), a);
        add_member(document_, "nodes", in_list(std::move(node)), a);
        add_member(document_, "meshes", in_list(std::move(mesh)), a);
        add_member(document_, "materials", in_list(std::move(material)), a);
        add_member(document_, "accessors", std::move(accessors_), a);
        add_member(document_, "bufferViews", std::move(views_), a);
        add_member(document_, "buffers", in_list(std::move(buffer)), a);
        rapidjson::StringBuffer text;
        rapidjson::Writer<rapidjson::StringBuffer> json(text);
        document_.Accept(json);
        std::string chunk(text.GetString(), text.GetSize());
        chunk.resize((chunk.size() + 3) / 4 * 4, ' ');
        return chunk;
    }

private:
    JsonValue in_list(JsonValue value) {
        JsonValue list(rapidjson::kArrayType);
        list.PushBack(value, allocator());
        return list;
    }
    Json document_;
    JsonValue views_{rapidjson::kArrayType}, accessors_{rapidjson::kArrayType};
    std::size_t offset_ = 0;
};

void check_size(const Path& file, std::size_t bytes) {
    if (bytes > std::numeric_limits<std::uint32_t>::max())
        throw Error(ErrorKind::failure, file.string(), "would exceed the four gigabytes of a GLB file",
                    "write PLY, or simplify the mesh");
}

}  // namespace

Notes write_glb(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options) {
    if (soup.triangles.empty())
        throw Error(ErrorKind::failure, file.string(), "glTF does not hold a mesh without triangles", "write PLY, OBJ or OFF");
    const bool corner_texture = extras.vertex_texture.empty() && !extras.corner_texture.empty();
    const bool textured = corner_texture || !extras.vertex_texture.empty();
    const bool face_coloured = extras.vertex_colours.empty() && !extras.face_colours.empty();
    const bool coloured = face_coloured || !extras.vertex_colours.empty();
    const bool split = corner_texture || face_coloured;
    const std::size_t corner_count = 3 * soup.triangles.size(), count = split ? corner_count : soup.points.size();
    check_size(file, count * 28 + corner_count * 4);
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

    GlbDocument document(options);
    auto& allocator = document.allocator();
    JsonValue attributes(rapidjson::kObjectType);
    JsonValue& positions = document.add_accessor(12 * count, array_buffer, float_component, count, "VEC3");
    for (const auto& [name, bound] : {std::pair{"min", low}, std::pair{"max", high}}) {
        JsonValue list(rapidjson::kArrayType);
        for (const float x : bound) list.PushBack(static_cast<double>(x), allocator);
        add_member(positions, name, std::move(list), allocator);
    }
    add_member(attributes, "POSITION", JsonValue(document.last_accessor()), allocator);
    if (coloured) {
        add_member(document.add_accessor(8 * count, array_buffer, ushort_component, count, "VEC4"), "normalized", JsonValue(true),
                   allocator);
        add_member(attributes, "COLOR_0", JsonValue(document.last_accessor()), allocator);
    }
    if (textured) {
        document.add_accessor(8 * count, array_buffer, float_component, count, "VEC2");
        add_member(attributes, "TEXCOORD_0", JsonValue(document.last_accessor()), allocator);
    }
    document.add_accessor(4 * corner_count, element_array_buffer, uint_component, corner_count, "SCALAR");
    const std::string json = document.finish(std::move(attributes), document.last_accessor(), translucent);
    const std::size_t total = 12 + 8 + json.size() + 8 + document.buffer_size();
    check_size(file, total);

    TextWriter writer(file);
    for (const std::uint32_t word :
         {glb_magic, 2U, static_cast<std::uint32_t>(total), static_cast<std::uint32_t>(json.size()), json_chunk})
        writer.bytes(word);
    writer.text(json);
    writer.bytes(static_cast<std::uint32_t>(document.buffer_size()));
    writer.bytes(binary_chunk);
    for (std::size_t i = 0; i < count; ++i) {
        for (const double x : soup.points[vertex_of(i)]) writer.bytes(static_cast<float>(x));
        writer.flush_if_full();
    }
    for (std::size_t i = 0; coloured && i < count; ++i) {
        const Colour& colour = colour_of(i);
        for (std::size_t k = 0; k < 3; ++k) writer.bytes(linear_channel(colour[k]));
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
