#include "page/geometry.h"

#include "ostraka/files/json_build.h"
#include "ostraka/io/glb.h"

#include <meshoptimizer.h>

#include <cmath>

namespace ostraka {

std::string quantised_glb(const TriangleSoup& soup, const std::array<double, 3>& origin, double largest_side) {
    constexpr double steps = 65535;
    const double step = largest_side > 0 ? largest_side / steps : 1;
    using Quantised = std::array<std::uint16_t, 4>;  // padded by a fourth value to the required stride
    std::vector<Quantised> points(soup.points.size());
    std::array<double, 3> low{steps, steps, steps}, high{0, 0, 0};
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const double value = std::clamp(std::round((soup.points[i][k] - origin[k]) / step), 0.0, steps);
            points[i][k] = static_cast<std::uint16_t>(value);
            low[k] = std::min(low[k], value);
            high[k] = std::max(high[k], value);
        }
    std::vector<unsigned int> corners;
    corners.reserve(3 * soup.triangles.size());
    for (const auto& triangle : soup.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());

    std::string packed_points(meshopt_encodeVertexBufferBound(points.size(), sizeof(Quantised)), '\0');
    packed_points.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed_points.data()), packed_points.size(),
                                                    points.data(), points.size(), sizeof(Quantised)));
    std::string packed_corners(meshopt_encodeIndexBufferBound(corners.size(), points.size()), '\0');
    packed_corners.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(packed_corners.data()),
                                                    packed_corners.size(), corners.data(), corners.size()));

    glb::Builder builder;
    auto& allocator = builder.allocator();
    JsonValue minimum = json_value(low, allocator), maximum = json_value(high, allocator);
    const int position =
        builder.add_compressed_accessor({packed_points, points.size(), sizeof(Quantised), "ATTRIBUTES"}, glb::array_buffer,
                                        glb::short_word, points.size(), "VEC3", &minimum, &maximum);
    const int indices = builder.add_compressed_accessor({packed_corners, corners.size(), sizeof(unsigned int), "TRIANGLES"},
                                                        glb::element_array_buffer, glb::word, corners.size(), "SCALAR");
    const std::array extensions{"KHR_mesh_quantization", "EXT_meshopt_compression"};
    JsonValue primitive = json_object(allocator, "attributes", json_object(allocator, "POSITION", position), "indices", indices,
                                      "mode", glb::triangles_mode);
    add_members(builder.document(), allocator, "extensionsUsed", extensions, "extensionsRequired", extensions, "meshes",
                json_list_of(json_object(allocator, "primitives", json_list_of(std::move(primitive), allocator)), allocator),
                "nodes", json_list_of(json_object(allocator, "mesh", 0, "scale", std::array{step, step, step}), allocator),
                "scenes", json_list_of(json_object(allocator, "nodes", std::array{0}), allocator), "scene", 0);
    return builder.finish("the page", "simplify the mesh");
}

}  // namespace ostraka
