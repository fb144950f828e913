#include "render/surface_colour.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>

namespace ostraka::detail {

namespace {

constexpr int max_probes = 4;  ///< texture samples per ray along each side of a pixel

/// Barycentric coordinates of the point where a ray meets the plane of a triangle; empty for a ray along the plane.
std::optional<Eigen::Vector3d> plane_weights(const Surface& surface, Index triangle, const Camera::Ray& ray) {
    const auto& [a, b, c] = surface.corners(triangle);
    const Eigen::Vector3d start = surface.point(a), side_b = surface.point(b) - start, side_c = surface.point(c) - start;
    const Eigen::Vector3d p = ray.direction.cross(side_c), offset = ray.origin - start, q = offset.cross(side_b);
    const double determinant = side_b.dot(p);
    if (determinant == 0) return std::nullopt;
    const double u = offset.dot(p) / determinant, v = ray.direction.dot(q) / determinant;
    if (!std::isfinite(u) || !std::isfinite(v)) return std::nullopt;
    return Eigen::Vector3d(1 - u - v, u, v);
}

/// Moves barycentric coordinates outside of the triangle to a point on its border: a texture must not be read beyond the chart of
/// the triangle.
Eigen::Vector3d inside_triangle(const Eigen::Vector3d& weights) {
    const Eigen::Vector3d positive = weights.cwiseMax(0.0);
    return positive / positive.sum();
}

}  // namespace

SurfaceColour::SurfaceColour(const Scene& scene, const Surface& surface, const Camera& camera, const ColourScale& scale)
    : scene_(scene),
      surface_(surface),
      camera_(camera),
      scale_(scale),
      textured_(scene.texture && !scene.texture->materials().empty() && scene.vertex_values.empty() &&
                scene.face_values.empty()) {
    for (std::size_t i = 0; i < scene.patches.size(); ++i)
        if (i == 0 || scene.patches[i].triangle != scene.patches[i - 1].triangle) patches_[scene.patches[i].triangle] = i;
}

Light SurfaceColour::operator()(const Surface::Hit& hit, double x, double y, double spacing) const {
    if (!scene_.vertex_values.empty()) {
        const auto& corners = surface_.corners(hit.triangle);
        double value = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double weight = hit.weights[static_cast<int>(k)];
            if (weight != 0) value += weight * scene_.vertex_values[corners[k]];
        }
        return to_light(colour_of(scale_, value));
    }
    if (!patches_.empty())
        if (const auto patch = patches_.find(hit.triangle); patch != patches_.end())
            return to_light(patch_colour(patch->second, hit));
    if (!scene_.face_values.empty()) return to_light(colour_of(scale_, scene_.face_values[hit.triangle]));
    if (const Index material = material_of(hit.triangle); material != no_index) {
        const Light texture = textured(hit, material, x, y, spacing);
        Light colour = texture * own_colour(hit, Light::Ones());
        const Material& used = scene_.texture->materials()[material];
        if (used.alpha == Material::Alpha::opaque) colour[3] = 1;
        else if (used.alpha == Material::Alpha::mask) colour[3] = texture[3] >= used.alpha_cutoff ? 1.0F : 0.0F;
        return colour;
    }
    return own_colour(hit, to_light(clay));
}

Index SurfaceColour::material_of(Index triangle) const {
    if (!textured_) return no_index;
    return scene_.face_materials.empty() ? 0 : scene_.face_materials[triangle];
}

Light SurfaceColour::own_colour(const Surface::Hit& hit, const Light& otherwise) const {
    if (!scene_.face_colours.empty()) return to_light(scene_.face_colours[hit.triangle]);
    if (scene_.vertex_colours.empty()) return otherwise;
    const auto& corners = surface_.corners(hit.triangle);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
        const Rgb& colour = scene_.vertex_colours[corners[k]];
        sum += hit.weights[static_cast<int>(k)] * Eigen::Vector3d(colour.red, colour.green, colour.blue);
    }
    return to_light({static_cast<std::uint8_t>(std::lround(sum[0])), static_cast<std::uint8_t>(std::lround(sum[1])),
                     static_cast<std::uint8_t>(std::lround(sum[2]))});
}

Light SurfaceColour::textured(const Surface::Hit& hit, Index material, double x, double y, double spacing) const {
    const TextureSampler& sampler = *scene_.texture;
    const auto& base = sampler.materials()[material].base_colour;
    const Light untextured(base[0], base[1], base[2], base[3]);
    const auto [width, height] = sampler.size(material);
    if (width == 0 || scene_.corner_texture.empty()) return untextured;
    Eigen::Matrix<double, 2, 3> corners;
    for (int k = 0; k < 3; ++k) {
        const TexturePoint& at = scene_.corner_texture[3 * std::size_t{hit.triangle} + static_cast<std::size_t>(k)];
        corners.col(k) << at[0], at[1];
    }
    if (!corners.allFinite()) return untextured;

    // The area of a pixel is a parallelogram on the triangle, spanned by the steps to the next rays. It is divided into cells of
    // about one pixel of the image, as far as max_probes allows; each cell is read with its own width.
    const Eigen::Vector2d size(width, height);
    std::array<Eigen::Vector3d, 2> step{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    std::array<int, 2> probes{1, 1};
    double texels = 0;  ///< width of a cell in pixels of the image
    const auto here = plane_weights(surface_, hit.triangle, camera_.ray(x, y));
    for (std::size_t side = 0; side < 2; ++side) {
        const auto next =
            plane_weights(surface_, hit.triangle, side == 0 ? camera_.ray(x + spacing, y) : camera_.ray(x, y + spacing));
        if (!here || !next) continue;
        step[side] = *next - *here;
        const double length = (corners * step[side]).cwiseProduct(size).norm();
        probes[side] = static_cast<int>(std::clamp(std::ceil(length), 1.0, double(max_probes)));
        texels = std::max(texels, length / probes[side]);
    }
    // A cell wider than a pixel of the image is read from one level of the pyramid, the first that is no finer: between two
    // levels the finer one would be seen with gaps.
    if (texels > 1) texels = std::exp2(std::ceil(std::log2(texels) - 1e-6));
    const auto footprint = static_cast<float>(texels / std::max(width, height));
    Light sum = Light::Zero();
    for (int i = 0; i < probes[0]; ++i)
        for (int j = 0; j < probes[1]; ++j) {
            const double across = (i + 0.5) / probes[0] - 0.5, along = (j + 0.5) / probes[1] - 0.5;
            const Eigen::Vector2d at = corners * inside_triangle(hit.weights + across * step[0] + along * step[1]);
            const auto colour = sampler.colour(material, {static_cast<float>(at.x()), static_cast<float>(at.y())}, footprint);
            sum += Light(colour[0], colour[1], colour[2], colour[3]);
        }
    return sum / static_cast<float>(probes[0] * probes[1]);
}

Light SurfaceColour::at_corner(Index triangle, std::size_t corner) const {
    Surface::Hit hit;
    hit.triangle = triangle;
    hit.weights = Eigen::Vector3d::Unit(static_cast<int>(corner));
    const Index material = material_of(triangle);
    if (material == no_index) return own_colour(hit, to_light(clay));
    return textured(hit, material, 0, 0, 0) * own_colour(hit, Light::Ones());
}

Rgb SurfaceColour::patch_colour(std::size_t first, const Surface::Hit& hit) const {
    Rgb colour;
    double max_weight = -1;
    for (std::size_t i = first; i < scene_.patches.size() && scene_.patches[i].triangle == hit.triangle; ++i) {
        double weight = 0;
        for (std::size_t k = 0; k < 3; ++k) weight += hit.weights[static_cast<int>(k)] * double(scene_.patches[i].weights[k]);
        if (weight > max_weight) max_weight = weight, colour = scene_.patches[i].colour;
    }
    return colour;
}

}  // namespace ostraka::detail
