// Objects for the tests of rendering.
#pragma once

#include "ostraka/render/render.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

namespace ostraka::test {

/// A unit sphere about the origin: `count` rings of 2 x `count` faces.
inline Scene sphere(int count) {
    Scene scene;
    auto& mesh = scene.mesh;
    const auto columns = static_cast<Index>(2 * count);
    mesh.points.push_back({0, 0, 1});
    for (int ring = 1; ring < count; ++ring)
        for (Index column = 0; column < columns; ++column) {
            const double polar = std::numbers::pi * ring / count, turn = 2 * std::numbers::pi * column / columns;
            mesh.points.push_back({std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)});
        }
    const auto last = static_cast<Index>(mesh.points.size());
    mesh.points.push_back({0, 0, -1});
    for (Index column = 0; column < columns; ++column) {
        const Index next = (column + 1) % columns;
        mesh.triangles.push_back({0, 1 + column, 1 + next});
        for (Index ring = 0; ring + 2 < static_cast<Index>(count); ++ring) {
            const Index upper = 1 + ring * columns, lower = upper + columns;
            mesh.triangles.push_back({upper + column, lower + column, lower + next});
            mesh.triangles.push_back({upper + column, lower + next, upper + next});
        }
        mesh.triangles.push_back({last, last - columns + next, last - columns + column});
    }
    return scene;
}

/// [-1, 1]^3, two triangles per side: front (-y), back, left (-x), right, bottom, top.
inline Scene cube() {
    Scene scene;
    for (int i = 0; i < 8; ++i) scene.mesh.points.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
    const std::array<std::array<Index, 4>, 6> sides{
        {{0, 1, 5, 4}, {3, 2, 6, 7}, {2, 0, 4, 6}, {1, 3, 7, 5}, {2, 3, 1, 0}, {4, 5, 7, 6}}};
    for (const auto& s : sides) {
        scene.mesh.triangles.push_back({s[0], s[1], s[2]});
        scene.mesh.triangles.push_back({s[0], s[2], s[3]});
    }
    return scene;
}
inline constexpr std::size_t front_of_cube = 0;  ///< the first of the two triangles

inline Scene moved(Scene scene, double size, const std::array<double, 3>& translation) {
    for (auto& point : scene.mesh.points)
        for (std::size_t k = 0; k < 3; ++k) point[k] = point[k] * size + translation[k];
    return scene;
}

/// Area in pixels, from the coverage.
inline double covered(const Picture& picture) {
    double sum = 0;
    for (const std::uint32_t pixel : picture.argb) sum += (pixel >> 24) / 255.0;
    return sum;
}

/// Number of pixels whose channels differ by more than rounding errors.
inline double differing_pixels(const Picture& a, const Picture& b) {
    double count = 0;
    for (std::size_t i = 0; i < a.argb.size(); ++i) {
        bool equal = true;
        for (const int shift : {0, 8, 16, 24})
            equal =
                equal && std::abs(static_cast<int>(a.argb[i] >> shift & 0xFF) - static_cast<int>(b.argb[i] >> shift & 0xFF)) <= 8;
        count += equal ? 0 : 1;
    }
    return count;
}

}  // namespace ostraka::test
