// Small meshes with all data that a file may hold.
#pragma once

#include "ostraka/io/mesh_file.h"

#include <gtest/gtest.h>
#include <cmath>

namespace ostraka::test {

/// An octahedron with its vertices in the order in which the faces refer to them.
inline TriangleSoup octahedron() {
    TriangleSoup soup;
    soup.points = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    soup.triangles = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
    return soup;
}

/// A torus of `around` x `along` quadrilaterals cut into triangles, whose coordinates need full precision.
inline TriangleSoup uneven_torus(Index around, Index along) {
    TriangleSoup soup;
    for (Index i = 0; i < around; ++i)
        for (Index j = 0; j < along; ++j) {
            const double a = 2 * M_PI * i / around, b = 2 * M_PI * j / along;
            soup.points.push_back(
                {(3 + std::cos(b)) * std::cos(a) / 3, (3 + std::cos(b)) * std::sin(a) * 1e-3, std::sin(b) * 1e5});
        }
    const auto at = [&](Index i, Index j) { return (i % around) * along + j % along; };
    for (Index i = 0; i < around; ++i)
        for (Index j = 0; j < along; ++j) {
            soup.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            soup.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return soup;
}

/// Distinct values for all elements.
inline MeshExtras full_extras(const TriangleSoup& soup) {
    MeshExtras extras;
    for (std::size_t v = 0; v < soup.points.size(); ++v) {
        const auto k = static_cast<std::uint8_t>(37 * v);
        extras.vertex_colours.push_back({k, static_cast<std::uint8_t>(k + 1), static_cast<std::uint8_t>(255 - k), 255});
        extras.vertex_labels.push_back(static_cast<std::int32_t>(v) * 1000003 - 7);
    }
    for (const char* name : {"quality", "scalar_Intensity"}) {
        NamedValues& column = extras.vertex_values.emplace_back(NamedValues{name, {}});
        for (std::size_t v = 0; v < soup.points.size(); ++v)
            column.values.push_back(static_cast<double>(v) / (column.name == "quality" ? 3 : 4));  // a third is no float
    }
    extras.face_values.push_back({"distance", {}});
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) extras.face_values[0].values.push_back(0.5 * static_cast<double>(t));
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        const auto k = static_cast<std::uint8_t>(11 * t);
        extras.face_colours.push_back({k, 3, static_cast<std::uint8_t>(200 - k), static_cast<std::uint8_t>(100 + k)});
        extras.face_labels.push_back(-static_cast<std::int32_t>(t));
        for (int c = 0; c < 3; ++c) extras.corner_texture.push_back({0.3F * static_cast<float>(t), static_cast<float>(c) / 7});
    }
    return extras;
}

/// Texture coordinates of corners that are those of the vertices.
inline std::vector<TexturePoint> texture_without_seams(const TriangleSoup& soup) {
    std::vector<TexturePoint> texture;
    for (const auto& triangle : soup.triangles)
        for (const Index v : triangle) texture.push_back({0.1F * static_cast<float>(v), 1.0F / static_cast<float>(v + 3)});
    return texture;
}

/// The bytes of a PNG image of one pixel, whose colour depends on `shade`.
inline std::string one_pixel_png(std::uint8_t shade) {
    return encode({1, 1, {{shade, 100, 50, 255}}}, ImageFormat::png, "pixel.png").bytes;
}

/// Names, values and types of two lists of values are equal; NaN equals NaN.
inline void expect_same_values(const std::vector<NamedValues>& actual, const std::vector<NamedValues>& expected) {
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t k = 0; k < actual.size(); ++k) {
        EXPECT_EQ(actual[k].name, expected[k].name);
        ASSERT_EQ(actual[k].values.size(), expected[k].values.size());
        for (std::size_t i = 0; i < actual[k].values.size(); ++i)
            EXPECT_TRUE(actual[k].values[i] == expected[k].values[i] ||
                        (std::isnan(actual[k].values[i]) && std::isnan(expected[k].values[i])));
    }
}

}  // namespace ostraka::test
