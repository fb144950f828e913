#include "io/formats.h"
#include "ostraka/io/glb_materials.h"
#include "io/text_writer.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/files/json_build.h"
#include "ostraka/io/glb.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ostraka::io {

namespace {

/// The origin about which coordinates are written in single precision, so that meshes far away keep their shape.
class SinglePrecision {
public:
    explicit SinglePrecision(const TriangleSoup& soup) {
        std::array<double, 3> low, high;
        low.fill(std::numeric_limits<double>::infinity());
        high.fill(-std::numeric_limits<double>::infinity());
        double rounding = 0;
        for (const auto& point : soup.points)
            for (std::size_t k = 0; k < 3; ++k) {
                low[k] = std::min(low[k], point[k]);
                high[k] = std::max(high[k], point[k]);
                rounding = std::max(rounding, std::fabs(static_cast<double>(static_cast<float>(point[k])) - point[k]));
            }
        if (soup.points.empty() || !std::isfinite(rounding)) return;
        double half = 0, farthest = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            half = std::max(half, (high[k] - low[k]) / 2);
            farthest = std::max(farthest, std::fabs(low[k] + (high[k] - low[k]) / 2));
        }
        constexpr double tolerated = 0.01;  // of the shortest edge
        if (!(half > 0) || farthest < 4 * half || rounding <= tolerated * shortest_edge(soup)) return;
        // A power of two: differences of coordinates and origin are exact.
        const double step = std::exp2(std::floor(std::log2(half)));
        for (std::size_t k = 0; k < 3; ++k) origin[k] = std::round((low[k] + (high[k] - low[k]) / 2) / step) * step;
        shifts = true;
    }

    std::array<double, 3> origin{0, 0, 0};  ///< subtracted from coordinates
    bool shifts = false;                    ///< true if the origin is not zero

private:
    static double shortest_edge(const TriangleSoup& soup) {
        double shortest = std::numeric_limits<double>::infinity();
        for (const auto& triangle : soup.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto &p = soup.points[triangle[k]], &q = soup.points[triangle[(k + 1) % 3]];
                const double length = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
                if (length > 0) shortest = std::min(shortest, length);
            }
        return shortest;
    }
};

/// A mesh as primitives of glTF, one per material, which share the vertices with their colours and texture coordinates.
class GlbMesh {
public:
    GlbMesh(const Path& file, const TriangleSoup& soup, const MeshExtras& extras)
        : file_(file), soup_(soup), extras_(extras), precision_(soup) {
        if (soup.triangles.empty())
            fail_work(file.string(), "glTF cannot store a mesh without triangles", "write PLY, OBJ or OFF");
        if (textured_ && !face_coloured_) pairs_ = textured_vertices(soup, extras.corner_texture);
        count_ = face_coloured_ ? corner_count_ : textured_ ? pairs_.vertex.size() : soup.points.size();
        order_by_material();
        std::vector<Index> used;
        for (const Group& group : groups_) used.push_back(group.material);
        materials_ = std::make_unique<GlbMaterials>(extras.appearance, std::move(used), file.string());
        glb::check_size(count_ * 28 + corner_count_ * 4 + order_.size() * 4 + materials_->bytes(), file.string(), too_large);
        low_.fill(std::numeric_limits<float>::max());
        high_.fill(std::numeric_limits<float>::lowest());
        for (std::size_t i = 0; i < count_; ++i)
            for (std::size_t k = 0; k < 3; ++k) add_coordinate(soup.points[vertex_of(i)][k], k);
    }

    void write(const std::string& comment) const {
        TextWriter writer(file_);
        writer.text(head(comment));
        write_vertices(writer);
        for (std::size_t i = 0; i < corner_count_; ++i) {
            const std::size_t corner = 3 * triangle_at(i / 3) + i % 3;
            writer.bytes(face_coloured_ ? static_cast<std::uint32_t>(corner)
                         : textured_    ? pairs_.pair_of_corner[corner]
                                        : soup_.triangles[corner / 3][corner % 3]);
            writer.flush_if_full();
        }
        for (const Index triangle : order_) {
            writer.bytes(triangle);
            writer.flush_if_full();
        }
        for (const SharedImage& image : materials_->images()) {
            writer.text(image->bytes);
            writer.text(std::string((4 - image->bytes.size() % 4) % 4, '\0'));
        }
        writer.commit();
    }

    [[nodiscard]] Notes notes() const {
        Notes notes;
        if (rounded_) notes.emplace_back("GLB stores coordinates in single precision; they were rounded");
        if (precision_.shifts)
            notes.push_back(
                fmt::format("coordinates were written about their centre; the translation of the node is ({}, {}, {})",
                            digits(precision_.origin[0]), digits(precision_.origin[1]), digits(precision_.origin[2])));
        if (face_coloured_ || count_ > soup_.points.size())
            notes.emplace_back("vertices were split so that GLB can store the data of faces and corners");
        if (!extras_.vertex_colours.empty() && !extras_.face_colours.empty())
            notes.emplace_back("GLB stores one set of colours; those of faces are dropped");
        if (!extras_.vertex_labels.empty() || !extras_.face_labels.empty()) notes.emplace_back("GLB cannot store labels");
        if (!extras_.vertex_values.empty() || !extras_.face_values.empty())
            notes.emplace_back("GLB cannot store further numbers of vertices and faces");
        notes.insert(notes.end(), materials_->notes().begin(), materials_->notes().end());
        return notes;
    }

private:
    static constexpr const char* too_large = "write PLY, or simplify the mesh";

    /// Consecutive triangles of one material.
    struct Group {
        Index material;
        std::size_t triangles;
    };

    [[nodiscard]] Index material_of(std::size_t triangle) const {
        if (extras_.face_materials.empty()) return no_index;
        const Index material = extras_.face_materials[triangle];
        return material < extras_.appearance.materials.size() ? material : no_index;
    }
    /// The triangle that is written at this place.
    [[nodiscard]] std::size_t triangle_at(std::size_t place) const { return order_.empty() ? place : order_[place]; }
    [[nodiscard]] Index vertex_of(std::size_t i) const {
        return face_coloured_ ? soup_.triangles[i / 3][i % 3] : textured_ ? pairs_.vertex[i] : static_cast<Index>(i);
    }
    [[nodiscard]] const Colour& colour_of(std::size_t i) const {
        return face_coloured_ ? extras_.face_colours[i / 3] : extras_.vertex_colours[vertex_of(i)];
    }
    [[nodiscard]] bool is_translucent() const {
        for (std::size_t i = 0; coloured_ && i < count_; ++i)
            if (colour_of(i)[3] != 255) return true;
        return false;
    }

    /// Orders the triangles by material, those without one last, unless they are in this order already.
    void order_by_material() {
        std::vector<Index> order(soup_.triangles.size());
        std::iota(order.begin(), order.end(), Index{0});
        const auto before = [&](Index a, Index b) { return material_of(a) < material_of(b); };
        if (!std::is_sorted(order.begin(), order.end(), before)) {
            std::stable_sort(order.begin(), order.end(), before);
            order_ = order;
        }
        for (const Index triangle : order) {
            if (groups_.empty() || groups_.back().material != material_of(triangle))
                groups_.push_back({material_of(triangle), 0});
            ++groups_.back().triangles;
        }
    }

    void add_coordinate(double x, std::size_t axis) {
        if (std::fabs(x) > static_cast<double>(std::numeric_limits<float>::max()))
            fail_work(file_.string(), "a coordinate does not fit the single precision of glTF",
                      "write PLY, OBJ or OFF, or rescale the mesh");
        const float single = written(x, axis);
        rounded_ = rounded_ || static_cast<double>(single) + precision_.origin[axis] != x;
        low_[axis] = std::min(low_[axis], single);
        high_[axis] = std::max(high_[axis], single);
    }
    [[nodiscard]] float written(double x, std::size_t axis) const { return static_cast<float>(x - precision_.origin[axis]); }

    void write_vertices(TextWriter& writer) const {
        for (std::size_t i = 0; i < count_; ++i) {
            const auto& point = soup_.points[vertex_of(i)];
            for (std::size_t k = 0; k < 3; ++k) writer.bytes(written(point[k], k));
            writer.flush_if_full();
        }
        for (std::size_t i = 0; coloured_ && i < count_; ++i) {
            const Colour& colour = colour_of(i);
            for (std::size_t k = 0; k < 3; ++k) writer.bytes(glb::linear_channel(colour[k]));
            writer.bytes(static_cast<std::uint16_t>(257 * colour[3]));
            writer.flush_if_full();
        }
        for (std::size_t i = 0; textured_ && i < count_; ++i) {
            const auto& [s, t] = face_coloured_ ? extras_.corner_texture[i] : pairs_.texture[i];
            writer.bytes(s);
            writer.bytes(1 - t);  // the first row of an image is at the top in glTF, at the bottom in OBJ and PLY
            writer.flush_if_full();
        }
    }

    [[nodiscard]] std::string head(const std::string& comment) const {
        glb::Builder builder;
        auto& allocator = builder.allocator();
        Json& root = builder.document();
        const auto in_list = [&](JsonValue value) { return json_list_of(std::move(value), allocator); };
        if (!comment.empty())
            add_members(root["asset"], allocator, "extras", json_object(allocator, "provenance", one_line(comment)));
        JsonValue mesh = json_object(allocator, "primitives", primitives(builder));
        if (!order_.empty()) {
            const int order = builder.announce_accessor(4 * order_.size(), 0, glb::word, order_.size(), "SCALAR");
            add_members(mesh, allocator, "extras", json_object(allocator, glb::triangle_order, order));
        }
        JsonValue node = json_object(allocator, "mesh", 0);
        if (precision_.shifts) add_members(node, allocator, "translation", precision_.origin);
        add_members(root, allocator, "scene", 0, "scenes", in_list(json_object(allocator, "nodes", std::array{0})), "nodes",
                    in_list(std::move(node)), "meshes", in_list(std::move(mesh)));
        materials_->add_to(builder, is_translucent());
        return builder.head(file_.string(), too_large);
    }

    /// Announces the accessors; returns the primitives, one per group.
    [[nodiscard]] JsonValue primitives(glb::Builder& builder) const {
        auto& allocator = builder.allocator();
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
        JsonValue list(rapidjson::kArrayType);
        for (std::size_t i = 0; i < groups_.size(); ++i) {
            const std::size_t corners = 3 * groups_[i].triangles;
            const int indices = builder.announce_accessor(4 * corners, glb::element_array_buffer, glb::word, corners, "SCALAR");
            list.PushBack(json_object(allocator, "attributes", JsonValue(attributes, allocator), "indices", indices, "mode",
                                      glb::triangles_mode, "material", i),
                          allocator);
        }
        return list;
    }

    const Path& file_;
    const TriangleSoup& soup_;
    const MeshExtras& extras_;
    SinglePrecision precision_;
    bool textured_ = !extras_.corner_texture.empty();
    bool face_coloured_ = extras_.vertex_colours.empty() && !extras_.face_colours.empty();  ///< one vertex per corner
    bool coloured_ = face_coloured_ || !extras_.vertex_colours.empty();
    TexturedVertices pairs_;
    std::size_t corner_count_ = 3 * soup_.triangles.size(), count_ = 0;  ///< number of corners, of vertices in the file
    std::vector<Index> order_;  ///< triangles in the order of writing; empty: as they are
    std::vector<Group> groups_;
    std::unique_ptr<GlbMaterials> materials_;
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
