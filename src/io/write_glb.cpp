#include "io/formats.h"
#include "io/text_writer.h"
#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"
#include "ostraka/io/glb.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka::io {

namespace {

/// A mesh as one primitive of glTF: vertices with colours and texture coordinates, and the triangles.
class GlbMesh {
public:
    GlbMesh(const Path& file, const TriangleSoup& soup, const MeshExtras& extras) : file_(file), soup_(soup), extras_(extras) {
        if (soup.triangles.empty())
            fail_work(file.string(), "glTF cannot store a mesh without triangles", "write PLY, OBJ or OFF");
        glb::check_size(count_ * 28 + corner_count_ * 4, file.string(), too_large);
        low_.fill(std::numeric_limits<float>::max());
        high_.fill(std::numeric_limits<float>::lowest());
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t k = 0; k < 3; ++k) add_coordinate(soup.points[vertex_of(i)][k], k);
    }

    void write(const std::string& comment) const {
        TextWriter writer(file_);
        writer.text(head(comment));
        for (std::size_t i = 0; i < count_; ++i) {
            for (const double x : soup_.points[vertex_of(i)]) writer.bytes(static_cast<float>(x));
            writer.flush_if_full();
        }
        for (std::size_t i = 0; coloured_ && i < count_; ++i) {
            const Colour& colour = colour_of(i);
            for (std::size_t k = 0; k < 3; ++k) writer.bytes(glb::linear_channel(colour[k]));
            writer.bytes(static_cast<std::uint16_t>(257 * colour[3]));
            writer.flush_if_full();
        }
        for (std::size_t i = 0; textured_ && i < count_; ++i) {
            const auto& [s, t] = corner_texture_ ? extras_.corner_texture[i] : extras_.vertex_texture[vertex_of(i)];
            writer.bytes(s);
            writer.bytes(1 - t);  // the first row of an image is at the top in glTF, at the bottom in OBJ and PLY
            writer.flush_if_full();
        }
        for (std::size_t i = 0; i < corner_count_; ++i) {
            writer.bytes(split_ ? static_cast<std::uint32_t>(i) : soup_.triangles[i / 3][i % 3]);
            writer.flush_if_full();
        }
        writer.commit();
    }

    [[nodiscard]] Notes notes() const {
        Notes notes;
        if (rounded_) notes.emplace_back("GLB stores coordinates in single precision; they were rounded");
        if (split_) notes.emplace_back("vertices were split so that GLB can store the data of faces and corners");
        if (!extras_.vertex_colours.empty() && !extras_.face_colours.empty())
            notes.emplace_back("GLB stores one set of colours; those of faces are dropped");
        if (!extras_.vertex_texture.empty() && !extras_.corner_texture.empty())
            notes.emplace_back("GLB stores one set of texture coordinates; those of corners are dropped");
        if (!extras_.vertex_labels.empty() || !extras_.face_labels.empty()) notes.emplace_back("GLB cannot store labels");
        return notes;
    }

private:
    static constexpr const char* too_large = "write PLY, or simplify the mesh";

    [[nodiscard]] Index vertex_of(std::size_t i) const { return split_ ? soup_.triangles[i / 3][i % 3] : static_cast<Index>(i); }
    [[nodiscard]] const Colour& colour_of(std::size_t i) const {
        return face_coloured_ ? extras_.face_colours[i / 3] : extras_.vertex_colours[vertex_of(i)];
    }
    [[nodiscard]] bool is_translucent() const {
        for (std::size_t i = 0; coloured_ && i < count_; ++i)
            if (colour_of(i)[3] != 255) return true;
        return false;
    }

    void add_coordinate(double x, std::size_t axis) {
        if (std::fabs(x) > static_cast<double>(std::numeric_limits<float>::max()))
            fail_work(file_.string(), "a coordinate does not fit the single precision of glTF",
                      "write PLY, OBJ or OFF, or rescale the mesh");
        const auto single = static_cast<float>(x);
        rounded_ = rounded_ || static_cast<double>(single) != x;
        low_[axis] = std::min(low_[axis], single);
        high_[axis] = std::max(high_[axis], single);
    }

    [[nodiscard]] std::string head(const std::string& comment) const {
        glb::Builder builder;
        auto& allocator = builder.allocator();
        Json& root = builder.document();
        const auto in_list = [&](JsonValue value) { return json_list_of(std::move(value), allocator); };
        if (!comment.empty())
            add_members(root["asset"], allocator, "extras", json_object(allocator, "provenance", one_line(comment)));
        JsonValue minimum = json_value(low_, allocator), maximum = json_value(high_, allocator);
        JsonValue attributes = json_object(
            allocator, "POSITION",
            builder.announce_accessor(12 * count_, glb::array_buffer, glb::single, count_, "VEC3", &minimum, &maximum));
        if (coloured_) {
            const int colours = builder.announce_accessor(8 * count_, glb::array_buffer, glb::short_word, count_, "VEC4");
            builder.mark_normalised(colours);
            add_members(attributes, allocator, "COLOR_0", colours);
        }
        if (textured_)
            add_members(attributes, allocator, "TEXCOORD_0",
                        builder.announce_accessor(8 * count_, glb::array_buffer, glb::single, count_, "VEC2"));
        const int indices =
            builder.announce_accessor(4 * corner_count_, glb::element_array_buffer, glb::word, corner_count_, "SCALAR");
        JsonValue primitive = json_object(allocator, "attributes", std::move(attributes), "indices", indices, "mode",
                                          glb::triangles_mode, "material", 0);
        JsonValue mesh = json_object(allocator, "primitives", in_list(std::move(primitive)));
        JsonValue material =
            json_object(allocator, "pbrMetallicRoughness", json_object(allocator, "metallicFactor", 0, "roughnessFactor", 1));
        add_nonempty_members(material, allocator, "alphaMode", std::string(is_translucent() ? "BLEND" : ""), "doubleSided", true);
        add_members(root, allocator, "scene", 0, "scenes", in_list(json_object(allocator, "nodes", std::array{0})), "nodes",
                    in_list(json_object(allocator, "mesh", 0)), "meshes", in_list(std::move(mesh)), "materials",
                    in_list(std::move(material)));
        return builder.head(file_.string(), too_large);
    }

    const Path& file_;
    const TriangleSoup& soup_;
    const MeshExtras& extras_;
    bool corner_texture_ = extras_.vertex_texture.empty() && !extras_.corner_texture.empty();
    bool textured_ = corner_texture_ || !extras_.vertex_texture.empty();
    bool face_coloured_ = extras_.vertex_colours.empty() && !extras_.face_colours.empty();
    bool coloured_ = face_coloured_ || !extras_.vertex_colours.empty();
    bool split_ = corner_texture_ || face_coloured_;  ///< one vertex per corner of a triangle
    std::size_t corner_count_ = 3 * soup_.triangles.size();
    std::size_t count_ = split_ ? corner_count_ : soup_.points.size();  ///< number of vertices in the file
    std::array<float, 3> low_, high_;
    bool rounded_ = false;
};

}  // namespace

Notes write_glb(const Path& file, const TriangleSoup& soup, const MeshExtras& extras, const WriteOptions& options) {
    const GlbMesh mesh(file, soup, extras);
    mesh.write(options.comment);
    return mesh.notes();
}

}  // namespace ostraka::io
