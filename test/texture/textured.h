// Meshes whose texture is a known function of the position.
#pragma once

#include "meshes.h"
#include "ostraka/texture/bake.h"

#include <algorithm>
#include <cmath>

namespace ostraka::test {

using ColourFunction = std::function<std::array<double, 3>(const Point&)>;  ///< sRGB channels, 0 to 255

inline std::array<std::uint8_t, 4> rounded(const std::array<double, 3>& colour) {
    std::array<std::uint8_t, 4> result{0, 0, 0, 255};
    for (std::size_t k = 0; k < 3; ++k) result[k] = static_cast<std::uint8_t>(std::lround(std::clamp(colour[k], 0.0, 255.0)));
    return result;
}

/// Waves about a quarter of the box long.
inline std::array<double, 3> waves(const Point& p) {
    return {128 + 100 * std::sin(9 * p.x()), 128 + 100 * std::sin(8 * p.y() + 1), 128 + 100 * std::cos(7 * p.z() + p.x())};
}

/// A cube of side 1 (times `scale`, moved by `by`) with one tile of an image per side, which shows a function of the position in
/// the cube of side 1.
inline MeshFile textured_box(int n, int tile, const ColourFunction& colour, double scale = 1,
                             const std::array<double, 3>& by = {0, 0, 0}) {
    const TriangleSoup soup = box(n);
    MeshFile file;
    file.mesh = build_mesh(moved(soup, scale, by));
    const int margin = 4, width = 6 * (tile + 2 * margin), height = tile + 2 * margin;
    Pixels pixels{width, height, {}};
    pixels.rgba.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    std::array<double, 3> low{1e9, 1e9, 1e9};
    for (const auto& p : soup.points)
        for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]);
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            const int side = column / (tile + 2 * margin);
            const double a = (column % (tile + 2 * margin) - margin + 0.5) / tile, b = (row - margin + 0.5) / tile;
            const auto axis = static_cast<std::size_t>(side / 2);
            std::array<double, 3> p = low;
            p[axis] += side % 2;
            p[(axis + 1) % 3] += a;
            p[(axis + 2) % 3] += b;
            pixels.rgba[static_cast<std::size_t>(row * width + column)] = rounded(colour(Point(p[0], p[1], p[2])));
        }
    const Mesh plain = build_mesh(soup);
    for (const Face face : plain.faces()) {
        const Vector normal = area_vector(plain, face);
        std::size_t axis = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (std::abs(normal[static_cast<int>(k)]) > std::abs(normal[static_cast<int>(axis)])) axis = k;
        const int side = 2 * static_cast<int>(axis) + (normal[static_cast<int>(axis)] > 0 ? 1 : 0);
        for (const Vertex v : corners(plain, face)) {
            const auto& p = soup.points[v];
            const double column = side * (tile + 2 * margin) + margin + (p[(axis + 1) % 3] - low[(axis + 1) % 3]) * tile;
            const double row = margin + (p[(axis + 2) % 3] - low[(axis + 2) % 3]) * tile;
            file.extras.corner_texture.push_back(
                {static_cast<float>(column / width), static_cast<float>(1 - row / height)});
        }
    }
    file.extras.face_materials.assign(plain.number_of_faces(), 0);
    Material material;
    material.image = 0;
    file.extras.appearance.materials.push_back(material);
    file.extras.appearance.images.push_back(std::make_shared<Image>(encode(pixels, ImageFormat::png, "box.png")));
    return file;
}

/// Mean difference of the channels of a texture from a function of the position, over a grid of points in each face.
inline double mean_error(const Mesh& mesh, const MeshExtras& extras, const ColourFunction& colour) {
    const TextureSampler sampler(extras.appearance, "test");
    double sum = 0, weights = 0;
    const int rows = 8;
    for (const Face face : mesh.faces()) {
        const auto v = corners(mesh, face);
        for (int i = 0; i < rows; ++i)
            for (int j = 0; i + j < rows; ++j) {
                const double a = (i + 1.0 / 3) / rows, b = (j + 1.0 / 3) / rows, c = 1 - a - b;
                const Point p = CGAL::barycenter(mesh.point(v[0]), a, mesh.point(v[1]), b, mesh.point(v[2]), c);
                TexturePoint at{};
                for (std::size_t k = 0; k < 2; ++k) {
                    const TexturePoint* corner = &extras.corner_texture[3 * static_cast<std::size_t>(face)];
                    at[k] = static_cast<float>(a * static_cast<double>(corner[0][k]) + b * static_cast<double>(corner[1][k]) +
                                               c * static_cast<double>(corner[2][k]));
                }
                const auto light = sampler.colour(extras.face_materials[face], at);
                const std::array<double, 3> expected = colour(p);
                for (std::size_t k = 0; k < 3; ++k)
                    sum += face_area(mesh, face) * std::abs(static_cast<double>(srgb_from_linear(light[k])) - expected[k]) / 3;
                weights += face_area(mesh, face);
            }
    }
    return sum / weights;
}

/// A mesh with a new atlas and the images baked for it.
struct BakedMesh {
    Atlas atlas;
    BakeResult result;
    MeshExtras extras;
};

inline BakedMesh baked(const Mesh& target, const MeshFile& source, double texel, const BakeOptions& options = {}) {
    BakedMesh baked;
    AtlasOptions atlas_options;
    atlas_options.texel = texel;
    baked.atlas = make_atlas(target, atlas_options);
    baked.result = bake(target, baked.atlas.layout, source, options, "source");
    set_texture(baked.extras, baked.atlas.layout, baked.result.images, {ImageFormat::png, 92, "baked"});
    return baked;
}

}  // namespace ostraka::test
