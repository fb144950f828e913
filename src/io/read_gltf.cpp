// GLB and glTF 2.0 (Khronos, 2021) as polygons with colours, texture coordinates and materials.
#include "io/formats.h"
#include "io/gltf_materials.h"
#include "io/gltf_primitive.h"
#include "io/gltf_scene.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/progress.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <ranges>
#include <set>

namespace ostraka::io {

namespace {

/// Extensions whose data are read.
constexpr std::array read_extensions{"KHR_mesh_quantization",      "KHR_texture_transform", "EXT_meshopt_compression",
                                     "KHR_draco_mesh_compression", "EXT_texture_webp",      "KHR_texture_basisu"};
/// Beginnings of the names of extensions that do not change the surface; what they say of materials is passed through.
constexpr std::array harmless_extensions{"KHR_materials_",       "EXT_materials_",    "KHR_texture_",
                                         "EXT_texture_",         "MSFT_texture_",     "KHR_lights_",
                                         "EXT_lights_",          "KHR_xmp",           "KHR_animation_",
                                         "ADOBE_materials_",     "EXT_mesh_features", "EXT_structural_metadata",
                                         "EXT_instance_features"};

bool is_read(std::string_view extension) {
    return std::find(read_extensions.begin(), read_extensions.end(), extension) != read_extensions.end();
}
bool is_harmless(std::string_view extension) {
    return std::any_of(harmless_extensions.begin(), harmless_extensions.end(),
                       [&](const char* beginning) { return extension.starts_with(beginning); });
}

/// Reads the meshes of a glTF scene.
class GltfScene {
public:
    GltfScene(const std::string& bytes, const std::string& file)
        : path_(file),
          reader_(bytes, file, [this](const std::string& uri) { return file_named(uri); }),
          materials_(reader_, path_, soup_) {}

    PolygonSoup read() {
        check_extensions();
        for (const PlacedMesh& mesh : placed_meshes(reader_, soup_.notes)) add_mesh(mesh);
        if (soup_.corners.empty()) add_loose_points();
        materials_.finish();
        add_notes();
        return std::move(soup_);
    }

private:
    std::string file_named(const std::string& uri) const {
        const std::optional<Path> file = file_beside(path_, uri);
        const std::string name = printable(uri, 200);
        if (!file)
            fail_input(path_.string(), fmt::format("its data are in the file '{}', which is not beside it", name),
                       fmt::format("copy '{}' into the folder of the file", name));
        return read_file(*file);
    }

    void check_extensions() {
        for (const JsonValue& name : list_in(reader_.document(), "extensionsRequired")) {
            if (!name.IsString()) reader_.fail("/extensionsRequired", "is not a list of names");
            if (!is_read(text_of(name)) && !is_harmless(text_of(name)))
                fail_input(path_.string(),
                           fmt::format("requires the glTF extension {}, which is not supported", printable(text_of(name), 100)),
                           "export the file without this extension");
        }
        std::vector<std::string> unread;
        for (const JsonValue& name : list_in(reader_.document(), "extensionsUsed"))
            if (name.IsString() && !is_read(text_of(name)) && !is_harmless(text_of(name)))
                unread.push_back(printable(text_of(name), 100));
        if (unread.size() > 20) unread.resize(20);
        if (!unread.empty()) soup_.notes.push_back("glTF extensions that are not read: " + joined(unread));
    }

    void add_mesh(const PlacedMesh& placed) {
        const JsonValue& mesh = reader_.element("meshes", placed.mesh, "/nodes");
        const std::string pointer = fmt::format("/meshes/{}", placed.mesh);
        const auto primitives = list_in(mesh, "primitives");
        const std::size_t first_triangle = soup_.polygon_count();
        first_vertices_.clear();
        for (rapidjson::SizeType i = 0; i < primitives.Size(); ++i) {
            check_cancelled();
            const GltfPrimitive primitive(reader_, primitives[i], fmt::format("{}/primitives/{}", pointer, i), draco_);
            note_attributes(primitive, primitives[i]);
            // Bounds the work on files with many nodes that show meshes of many small primitives.
            reader_.charge(256 + 64.0 * primitive.attributes().MemberCount(), primitive.pointer());
            if (!primitive.accessor("POSITION")) {
                ++without_positions_;
            } else if (primitive.mode() < glb::triangles_mode) {
                (primitive.mode() == glb::points_mode ? points_ : line_corners_) += primitive.corners();
                if (primitive.mode() == glb::points_mode) loose_points_.push_back({placed, i});
            } else {
                add_triangles(primitive, primitives[i], placed.placement);
            }
        }
        restore_order(mesh, first_triangle, pointer);
    }

    /// Calls visit(i, numbers) for each element of an attribute; reads single precision where it lies in the file.
    template <std::size_t width, class Visit>
    void for_each_element(const GltfPrimitive& primitive, const std::string& attribute, std::size_t count, const Visit& visit) {
        std::array<double, width> numbers{};
        if (const auto floats = primitive.floats(attribute, width, count)) {
            std::array<float, width> stored{};
            for (std::size_t i = 0; i < count; ++i) {
                std::memcpy(stored.data(), floats->bytes + i * floats->stride, sizeof stored);
                std::copy(stored.begin(), stored.end(), numbers.begin());
                visit(i, numbers);
            }
            return;
        }
        const auto values = primitive.values(attribute, width, count);
        for (std::size_t i = 0; i < count; ++i) {
            std::copy_n(values->data() + width * i, width, numbers.begin());
            visit(i, numbers);
        }
    }

    /// Appends the vertices of a primitive, unless another primitive of this mesh has the same; returns the first of them.
    Index add_vertices(const GltfPrimitive& primitive, const AffineMap& placement) {
        const auto [place, is_new] = first_vertices_.try_emplace(primitive.key(), static_cast<Index>(soup_.points.size()));
        if (!is_new) return place->second;
        const std::size_t count = primitive.vertices(), first = soup_.points.size();
        if (first + count >= no_index) fail_work(path_.string(), "has more than four thousand million vertices", "split it");
        reader_.charge(static_cast<double>((sizeof(std::array<double, 3>) + sizeof(Colour)) * count), primitive.pointer());
        if (soup_.points.capacity() < first + count) soup_.points.reserve(std::max(first + count, 2 * first));
        const bool moves = placement != AffineMap{};
        for_each_element<3>(primitive, "POSITION", count, [&](std::size_t i, std::array<double, 3> point) {
            if (moves) point = placement(point);
            if (!std::isfinite(point[0]) || !std::isfinite(point[1]) || !std::isfinite(point[2]))
                reader_.fail(primitive.pointer() + "/attributes/POSITION", fmt::format("vertex {} is not finite", i));
            soup_.points.push_back(point);
        });
        if (primitive.accessor("COLOR_0")) add_colours(primitive, first, count);
        else if (!soup_.extras.vertex_colours.empty()) soup_.extras.vertex_colours.resize(soup_.points.size(), white);
        return place->second;
    }

    void add_colours(const GltfPrimitive& primitive, std::size_t first, std::size_t count) {
        const glb::Reader::Shape shape = primitive.shape("COLOR_0");
        if (shape.width != 3 && shape.width != 4)
            reader_.fail(primitive.pointer() + "/attributes/COLOR_0", "has not three or four channels");
        const auto values = primitive.values("COLOR_0", shape.width, count);
        // Integers are always fractions, also where a writer forgot to say so.
        const double largest = shape.normalised || shape.component == glb::single ? 1
                               : shape.component == glb::byte                     ? 255
                                                                                  : 65535;
        std::vector<Colour>& colours = soup_.extras.vertex_colours;
        colours.resize(first, white);
        colours.reserve(first + count);
        for (std::size_t i = 0; i < count; ++i) {
            Colour colour = white;
            for (std::size_t k = 0; k < shape.width; ++k) {
                const double value = (*values)[shape.width * i + k] / largest;
                const double light = value >= 0 ? std::min(value, 1.0) : 0;
                colour[k] =
                    k == 3 ? static_cast<std::uint8_t>(std::lround(255 * light)) : srgb_from_linear(static_cast<float>(light));
            }
            colours.push_back(colour);
        }
    }

    void add_triangles(const GltfPrimitive& primitive, const JsonValue& object, const AffineMap& placement) {
        constexpr std::size_t no_material = static_cast<std::size_t>(-1);
        const std::size_t material = reader_.number(object, "material", primitive.pointer(), no_material);
        GltfMaterials::Coordinates coordinates;
        if (material != no_material) coordinates = materials_.coordinates(material, primitive.pointer() + "/material");
        const Index first = add_vertices(primitive, placement);
        std::vector<std::uint32_t> corners = primitive.triangles();
        if (soup_.corners.size() + corners.size() >= no_index)
            fail_work(path_.string(), "has more than four thousand million face corners", "split it");
        incomplete_ += primitive.mode() == glb::triangles_mode && primitive.corners() != corners.size() ? 1 : 0;
        reader_.charge(7.0 * static_cast<double>(corners.size()), primitive.pointer());
        if (placement.mirrors())
            for (std::size_t c = 0; c < corners.size(); c += 3) std::swap(corners[c + 1], corners[c + 2]);
        add_texture(primitive, coordinates, corners);
        if (first > 0)
            for (std::uint32_t& corner : corners) corner += first;
        const std::size_t triangles = corners.size() / 3, before = soup_.polygon_begin.size();
        if (soup_.corners.empty()) soup_.corners = std::move(corners);
        else soup_.corners.insert(soup_.corners.end(), corners.begin(), corners.end());
        soup_.polygon_begin.resize(before + triangles);
        for (std::size_t t = before; t < before + triangles; ++t) soup_.polygon_begin[t] = soup_.polygon_begin[t - 1] + 3;
        soup_.extras.face_materials.resize(soup_.polygon_count(),
                                           material == no_material ? no_index : static_cast<Index>(material));
    }

    /// Appends the texture coordinates of the corners of a primitive; zeros if it has none, but others have.
    void add_texture(const GltfPrimitive& primitive, const GltfMaterials::Coordinates& coordinates,
                     const std::vector<std::uint32_t>& corners) {
        std::vector<TexturePoint>& texture = soup_.extras.corner_texture;
        const std::string attribute = "TEXCOORD_" + std::to_string(coordinates.set);
        const bool has_texture = primitive.accessor(attribute).has_value();
        if (!has_texture && texture.empty()) return;
        texture.resize(soup_.corners.size(), TexturePoint{0, 0});
        reader_.charge(static_cast<double>(sizeof(TexturePoint) * corners.size()), primitive.pointer());
        if (!has_texture) {
            texture.resize(soup_.corners.size() + corners.size(), TexturePoint{0, 0});
            return;
        }
        const std::size_t count = primitive.vertices(), first = soup_.corners.size();
        reader_.charge(static_cast<double>(sizeof(TexturePoint) * count), primitive.pointer());
        std::vector<TexturePoint> of_vertex(count);
        bool all_finite = true;
        const bool is_plain = coordinates.map == TextureMap{};
        for_each_element<2>(primitive, attribute, count, [&](std::size_t i, const std::array<double, 2>& numbers) {
            of_vertex[i] = is_plain ? TexturePoint{static_cast<float>(numbers[0]), static_cast<float>(1 - numbers[1])}
                                    : coordinates.map(numbers[0], numbers[1]);
            all_finite = all_finite && std::isfinite(of_vertex[i][0]) && std::isfinite(of_vertex[i][1]);
        });
        const auto at_corner = [&](std::uint32_t v) -> const TexturePoint& { return of_vertex[v]; };
        const auto of_corner = corners | std::views::transform(at_corner);
        texture.insert(texture.end(), of_corner.begin(), of_corner.end());
        const auto is_finite = [](const TexturePoint& point) { return std::isfinite(point[0]) && std::isfinite(point[1]); };
        if (!all_finite && !std::all_of(texture.begin() + static_cast<std::ptrdiff_t>(first), texture.end(), is_finite))
            reader_.fail(primitive.pointer() + "/attributes/" + attribute, "a coordinate is not finite");
    }

    /// Puts the triangles of a mesh back into the order that they had before the writer ordered them by material.
    void restore_order(const JsonValue& mesh, std::size_t first, const std::string& pointer) {
        const JsonValue* extras = find_member(mesh, "extras");
        if (extras == nullptr || find_member(*extras, glb::triangle_order) == nullptr) return;
        const std::string place = fmt::format("{}/extras/{}", pointer, glb::triangle_order);
        const std::vector<std::uint32_t> order = reader_.integers(reader_.number(*extras, glb::triangle_order, place, 0), place);
        const std::size_t count = soup_.polygon_count() - first;
        std::vector<bool> is_taken(order.size(), false);
        for (const std::uint32_t triangle : order)
            if (triangle < order.size()) is_taken[triangle] = true;
        if (order.size() != count || std::find(is_taken.begin(), is_taken.end(), false) != is_taken.end())
            reader_.fail(place, "is not an order of the triangles of the mesh");
        const auto reorder = [&](auto& list, std::size_t width) {
            if (list.empty()) return;
            const auto begin = list.begin() + static_cast<std::ptrdiff_t>(width * first);
            const std::vector written(begin, list.end());
            for (std::size_t t = 0; t < count; ++t)
                std::copy_n(written.begin() + static_cast<std::ptrdiff_t>(width * t), width,
                            begin + static_cast<std::ptrdiff_t>(width * order[t]));
        };
        reorder(soup_.corners, 3);
        reorder(soup_.extras.corner_texture, 3);
        reorder(soup_.extras.face_materials, 1);
    }

    /// A file without triangles: its points become vertices.
    void add_loose_points() {
        for (const auto& [placed, i] : loose_points_) {
            const JsonValue& mesh = reader_.element("meshes", placed.mesh, "/nodes");
            first_vertices_.clear();
            add_vertices(GltfPrimitive(reader_, list_in(mesh, "primitives")[i],
                                       fmt::format("/meshes/{}/primitives/{}", placed.mesh, i), draco_),
                         placed.placement);
        }
    }

    void note_attributes(const GltfPrimitive& primitive, const JsonValue& object) {
        for (const auto& attribute : primitive.attributes().GetObject()) {
            const std::string name = text_of(attribute.name);
            if (name != "POSITION" && name != "COLOR_0" && !name.starts_with("TEXCOORD_") && dropped_.size() < 20)
                dropped_.insert(printable(name, 40));
            if (name == "TEXCOORD_1") has_second_texture_ = true;
        }
        has_targets_ = has_targets_ || find_member(object, "targets") != nullptr;
    }

    void add_notes() {
        auto& notes = soup_.notes;
        if (points_ > 0)
            notes.push_back(soup_.corners.empty()
                                ? fmt::format("contains {} and no triangles: a point cloud", counted(points_, "point"))
                                : fmt::format("{} not kept", counted(points_, "point")));
        if (line_corners_ > 0) notes.push_back(fmt::format("lines with {} not kept", counted(line_corners_, "corner")));
        if (without_positions_ > 0)
            notes.push_back(fmt::format("{} without positions skipped", counted(without_positions_, "primitive")));
        if (incomplete_ > 0)
            notes.push_back(fmt::format("{} with corners that complete no triangle", counted(incomplete_, "primitive")));
        if (!dropped_.empty()) notes.push_back("attributes that are not kept: " + joined(dropped_));
        if (has_second_texture_) notes.emplace_back("one set of texture coordinates per material is kept");
        if (has_targets_) notes.emplace_back("morph targets are not read");
        for (const char* list : {"skins", "animations", "cameras"})
            if (const std::size_t count = list_in(reader_.document(), list).Size(); count > 0)
                notes.push_back(fmt::format("{} not read: {}", list, count));
        add_asset_notes();
    }

    /// Author and licence, as the file states them.
    void add_asset_notes() {
        const JsonValue* asset = find_member(reader_.document(), "asset");
        if (asset == nullptr) return;
        std::vector<std::string> statements;
        const auto add = [&](const JsonValue& object, const char* name) {
            if (const std::string text = text_in(object, name); !text.empty())
                statements.push_back(fmt::format("{}: {}", name, printable(text, 200)));
        };
        add(*asset, "copyright");
        if (const JsonValue* extras = find_member(*asset, "extras"); extras != nullptr)
            for (const char* name : {"title", "author", "license", "source"}) add(*extras, name);
        if (!statements.empty()) soup_.notes.push_back("the file states, which is not kept: " + joined(statements, "; "));
    }

    struct LoosePoints {
        PlacedMesh placed;
        rapidjson::SizeType primitive;
    };
    Path path_;
    PolygonSoup soup_;
    glb::Reader reader_;
    GltfMaterials materials_;
    DracoCache draco_;
    std::map<std::array<std::size_t, 3>, Index> first_vertices_;  ///< first vertex of each key, within one placed mesh
    std::vector<LoosePoints> loose_points_;
    std::size_t points_ = 0, line_corners_ = 0, without_positions_ = 0, incomplete_ = 0;
    std::set<std::string> dropped_;
    bool has_second_texture_ = false, has_targets_ = false;
};

}  // namespace

bool looks_like_glb(std::string_view bytes) { return bytes.starts_with("glTF"); }

PolygonSoup read_gltf(const std::string& bytes, const std::string& file) { return GltfScene(bytes, file).read(); }

}  // namespace ostraka::io
