#include "page/geometry.h"

#include "ostraka/files/json_build.h"
#include "ostraka/io/glb.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

constexpr double quantised_steps = 65535;

/// The elements of a vertex attribute, encoded; an element has a multiple of four bytes.
template <class Element>
std::string packed_vertices(const std::vector<Element>& elements) {
    std::string packed(meshopt_encodeVertexBufferBound(elements.size(), sizeof(Element)), '\0');
    packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()), packed.size(), elements.data(),
                                             elements.size(), sizeof(Element)));
    return packed;
}

/// The attributes of textured vertices, added to those of a primitive.
void add_texture(glb::Builder& builder, JsonValue& attributes, const io::TexturedVertices& textured) {
    const std::size_t count = textured.vertex.size();
    std::array<float, 2> low{0, 0}, high{0, 0};
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < 2; ++k) {
            const float value = textured.texture[i][k];
            if (!std::isfinite(value)) continue;
            low[k] = std::min(low[k], value);
            high[k] = std::max(high[k], value);
        }
    auto& allocator = builder.allocator();
    int texture = 0;
    if (low[0] >= 0 && low[1] >= 0 && high[0] <= 1 && high[1] <= 1) {
        std::vector<std::array<std::uint16_t, 2>> places(count);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = 0; k < 2; ++k) {
                const float value = textured.texture[i][k];
                if (std::isfinite(value)) places[i][k] = static_cast<std::uint16_t>(std::lround(quantised_steps * double{value}));
            }
        texture = builder.add_compressed_accessor({packed_vertices(places), count, 4, "ATTRIBUTES"}, glb::array_buffer,
                                                  glb::short_word, count, "VEC2");
        builder.mark_normalised(texture);
    } else {
        std::vector<TexturePoint> places = textured.texture;
        for (TexturePoint& at : places)
            for (float& value : at)
                if (!std::isfinite(value)) value = 0;
        texture = builder.add_compressed_accessor({packed_vertices(places), count, 8, "ATTRIBUTES"}, glb::array_buffer,
                                                  glb::single, count, "VEC2");
    }
    const int vertex = builder.add_compressed_accessor({packed_vertices(textured.vertex), count, 4, "ATTRIBUTES"},
                                                       glb::array_buffer, glb::word, count, "SCALAR");
    add_members(attributes, allocator, "TEXCOORD_0", texture, "_VERTEX", vertex);
}

}  // namespace

std::string quantised_glb(const TriangleSoup& soup, const std::array<double, 3>& origin, double largest_side,
                          const io::TexturedVertices* textured) {
    const double step = largest_side > 0 ? largest_side / quantised_steps : 1;
    using Quantised = std::array<std::uint16_t, 4>;  // padded by a fourth value to the required stride
    std::vector<Quantised> points(textured != nullptr ? textured->vertex.size() : soup.points.size());
    std::array<double, 3> low{quantised_steps, quantised_steps, quantised_steps}, high{0, 0, 0};
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& point = soup.points[textured != nullptr ? textured->vertex[i] : i];
            const double value = std::clamp(std::round((point[k] - origin[k]) / step), 0.0, quantised_steps);
            points[i][k] = static_cast<std::uint16_t>(value);
            low[k] = std::min(low[k], value);
            high[k] = std::max(high[k], value);
        }
    std::vector<unsigned int> corners;
    corners.reserve(3 * soup.triangles.size());
    if (textured != nullptr) corners.assign(textured->pair_of_corner.begin(), textured->pair_of_corner.end());
    else
        for (const auto& triangle : soup.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
    std::string packed_corners(meshopt_encodeIndexBufferBound(corners.size(), points.size()), '\0');
    packed_corners.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(packed_corners.data()),
                                                    packed_corners.size(), corners.data(), corners.size()));

    glb::Builder builder;
    auto& allocator = builder.allocator();
    JsonValue minimum = json_value(low, allocator), maximum = json_value(high, allocator);
    const int position =
        builder.add_compressed_accessor({packed_vertices(points), points.size(), sizeof(Quantised), "ATTRIBUTES"},
                                        glb::array_buffer, glb::short_word, points.size(), "VEC3", &minimum, &maximum);
    const int indices = builder.add_compressed_accessor({packed_corners, corners.size(), sizeof(unsigned int), "TRIANGLES"},
                                                        glb::element_array_buffer, glb::word, corners.size(), "SCALAR");
    JsonValue attributes = json_object(allocator, "POSITION", position);
    if (textured != nullptr) add_texture(builder, attributes, *textured);
    const std::array extensions{"KHR_mesh_quantization", "EXT_meshopt_compression"};
    JsonValue primitive =
        json_object(allocator, "attributes", std::move(attributes), "indices", indices, "mode", glb::triangles_mode);
    add_members(builder.document(), allocator, "extensionsUsed", extensions, "extensionsRequired", extensions, "meshes",
                json_list_of(json_object(allocator, "primitives", json_list_of(std::move(primitive), allocator)), allocator),
                "nodes", json_list_of(json_object(allocator, "mesh", 0, "scale", std::array{step, step, step}), allocator),
                "scenes", json_list_of(json_object(allocator, "nodes", std::array{0}), allocator), "scene", 0);
    return builder.finish("the page", "simplify the mesh");
}

}  // namespace ostraka
