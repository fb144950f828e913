#include "render/shading.h"

#include "ostraka/core/angles.h"
#include "ostraka/execution/parallel.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ostraka::detail {

namespace {
/// Light adds up in linear intensities; files and screens use gamma-coded values (sRGB, IEC 61966-2-1).
double linear(double coded) { return coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4); }
double coded(double intensity) {
    return intensity <= 0.0031308 ? 12.92 * intensity : 1.055 * std::pow(intensity, 1 / 2.4) - 0.055;
}

struct Tables {
    std::array<float, 256> linear_of;
    std::array<std::uint8_t, 4096> code_of;  ///< fine enough that code_of(linear_of(c)) = c
    Tables() {
        for (std::size_t i = 0; i < 256; ++i) linear_of[i] = static_cast<float>(linear(static_cast<double>(i) / 255));
        for (std::size_t i = 0; i < 4096; ++i)
            code_of[i] = static_cast<std::uint8_t>(std::lround(255 * coded(static_cast<double>(i) / 4095)));
    }
};
const Tables& tables() {
    static const Tables instance;
    return instance;
}

std::uint32_t to_pixel(const Light& light) {
    const float coverage = std::min(light[3], 1.0F);
    if (!(coverage > 0)) return 0;
    const auto alpha = static_cast<std::uint32_t>(std::lround(255 * coverage));
    const auto channel = [&](int i) {
        const float intensity = std::clamp(light[i] / light[3], 0.0F, 1.0F);
        const std::uint32_t code = tables().code_of[static_cast<std::size_t>(std::lround(4095 * intensity))];
        return (code * alpha + 127) / 255;
    };
    return alpha << 24 | channel(0) << 16 | channel(1) << 8 | channel(2);
}

/// Whether two colours differ visibly; square roots approximate the gamma code.
bool differs(const Light& a, const Light& b) {
    if (a[3] != b[3]) return true;
    const Light roots = (a.sqrt() - b.sqrt()).abs();
    return roots.head<3>().maxCoeff() > 0.06F;
}

/// A channel at a light strength: proportional up to 1, then smoothly approaching white.
float lit(float channel, float strength) {
    if (strength <= 1 || channel >= 1) return channel * std::min(strength, 1.0F);
    return 1 - (1 - channel) * std::exp(-channel / (1 - channel) * (strength - 1));
}

/// Directions distributed evenly on the sphere (a spherical Fibonacci lattice).
std::vector<Eigen::Vector3d> sphere_directions(int count) {
    std::vector<Eigen::Vector3d> directions;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count;
        const double radius = std::sqrt(std::max(0.0, 1 - z * z));
        const double angle = 2 * pi * std::fmod(i * 0.6180339887498949, 1.0);
        directions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    return directions;
}

class Shader {
public:
    Shader(const Scene& scene, const Surface& surface, const Camera& camera, const Shading& shading)
        : surface_(surface),
          camera_(camera),
          shading_(shading),
          colour_(scene, surface, camera, shading.scale),
          sky_(sphere_directions(2 * shading.ambient_occlusion)) {
        key_ = (-0.55 * camera.right + 0.6 * camera.up + 0.75 * camera.toward).normalized();
    }

    /// Light along the ray through the pixel coordinates x, y; `spacing`: distance of neighbouring rays in pixels.
    [[nodiscard]] Light sample(double x, double y, double spacing) const {
        constexpr int max_layers = 16;           // translucent triangles that are drawn over each other
        constexpr float invisible = 1.0F / 512;  // opacity left over that no longer changes a pixel
        constexpr double beyond = 1e-5;          // distance of the next layer
        Camera::Ray ray = camera_.ray(x, y);
        Light sum = Light::Zero();
        float remaining = 1;
        Surface::Hit hit;
        for (int layer = 0; layer < max_layers && remaining > invisible; ++layer) {
            if (!surface_.first_hit(ray.origin, ray.direction, hit)) break;
            Light light = colour_(hit, x, y, spacing);
            const float opacity = light[3];
            if (opacity > 0) {
                light[3] = 1;
                sum += remaining * opacity * lit_by_lamp(light, hit, -ray.direction, x, y);
                remaining *= 1 - opacity;
            }
            ray.origin = hit.point + beyond * ray.direction;
        }
        return sum;
    }

private:
    /// The colour of an opaque surface under the lamp, with the edges of the mesh.
    [[nodiscard]] Light lit_by_lamp(Light light, const Surface::Hit& hit, const Eigen::Vector3d& viewer, double x,
                                    double y) const {
        if (!shading_.flat_light) {
            Eigen::Vector3d flat = surface_.face_normal(hit.triangle);
            Eigen::Vector3d normal = shading_.smooth ? surface_.smooth_normal(hit, shading_.crease_cosine) : flat;
            const bool inside = flat.dot(viewer) < 0;
            if (inside) {
                flat = -flat;
                normal = -normal;
                light *= Light(0.42F, 0.46F, 0.52F, 1);
            }
            double strength = brightness(normal, viewer);
            if (!sky_.empty()) strength *= 0.25 + 0.75 * openness(hit.point, flat);
            light.head<3>() = light.head<3>().unaryExpr([&](float c) { return lit(c, static_cast<float>(strength)); });
        }
        if (shading_.edges) light.head<3>() *= static_cast<float>(1 - 0.75 * edge_coverage(hit, x, y));
        return light;
    }

    /// 1 for a surface that faces the viewer, so that it has its own colour.
    [[nodiscard]] double brightness(const Eigen::Vector3d& normal, const Eigen::Vector3d& viewer) const {
        const auto sum = [&](double facing, double key, double up) {
            return 0.14 + 0.07 * up + 0.25 * std::max(0.0, facing) + 0.75 * std::max(0.0, key);
        };
        return sum(normal.dot(viewer), normal.dot(key_), normal.dot(camera_.up)) /
               sum(1, viewer.dot(key_), viewer.dot(camera_.up));
    }

    /// Cosine-weighted fraction of the sky above the surface that is not occluded.
    [[nodiscard]] double openness(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
        constexpr double max_distance = 0.6;
        double open = 0, total = 0;
        for (const auto& direction : sky_) {
            const double cosine = direction.dot(normal);
            if (cosine <= 0.05) continue;
            total += cosine;
            if (!surface_.blocked(point + 1e-3 * normal, direction, 0, max_distance)) open += cosine;
        }
        return total > 0 ? open / total : 1;
    }

    /// Coverage of the pixel by an edge line: 1 on the edge, 0 beyond its width.
    [[nodiscard]] double edge_coverage(const Surface::Hit& hit, double x, double y) const {
        std::array<Eigen::Vector2d, 3> screen;
        for (std::size_t k = 0; k < 3; ++k)
            if (!camera_.project(surface_.point(surface_.corners(hit.triangle)[k]), screen[k].x(), screen[k].y())) return 0;
        const Eigen::Vector2d first_side = screen[1] - screen[0], second_side = screen[2] - screen[0];
        const double twice_area = std::abs(first_side.x() * second_side.y() - first_side.y() * second_side.x());
        double nearest = std::numeric_limits<double>::infinity(), longest = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Eigen::Vector2d side = screen[(k + 1) % 3] - screen[k], offset = Eigen::Vector2d(x, y) - screen[k];
            const double length = side.norm();
            if (length > 0) nearest = std::min(nearest, std::abs(side.x() * offset.y() - side.y() * offset.x()) / length);
            longest = std::max(longest, length);
        }
        // Triangles of a few pixels would consist of edge only: their lines fade.
        const double height = longest > 0 ? twice_area / longest : 0;
        return std::clamp(shading_.edge_width / 2 + 0.5 - nearest, 0.0, 1.0) * std::clamp(height / 3, 0.0, 1.0);
    }

    const Surface& surface_;
    const Camera& camera_;
    const Shading& shading_;
    SurfaceColour colour_;
    std::vector<Eigen::Vector3d> sky_;
    Eigen::Vector3d key_;
};
}  // namespace

Light to_light(const Rgb& colour) {
    const auto& t = tables();
    return {t.linear_of[colour.red], t.linear_of[colour.green], t.linear_of[colour.blue], 1};
}

std::vector<Light> shade(const Scene& scene, const Surface& surface, const Camera& camera, int width, int height,
                         const Shading& shading) {
    const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
    const Shader shader(scene, surface, camera, shading);
    std::vector<Light> light(columns * rows, Light::Zero());
    parallel_for(rows, 4, [&](std::size_t row) {
        for (std::size_t column = 0; column < columns; ++column)
            light[row * columns + column] = shader.sample(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5, 1);
    });

    const double spacing = 1 / std::sqrt(static_cast<double>(shading.samples));
    std::vector<Light> finer(columns * rows);
    parallel_for(rows, 4, [&](std::size_t row) {
        for (std::size_t column = 0; column < columns; ++column) {
            const std::size_t index = row * columns + column;
            Light sum = light[index];
            const bool refine =
                shading.samples > 1 &&
                ((column > 0 && differs(sum, light[index - 1])) || (column + 1 < columns && differs(sum, light[index + 1])) ||
                 (row > 0 && differs(sum, light[index - columns])) || (row + 1 < rows && differs(sum, light[index + columns])));
            if (refine) {
                // The plastic-number sequence (Roberts 2018): any number of its points is distributed evenly over the
                // pixel.
                for (int i = 1; i < shading.samples; ++i)
                    sum += shader.sample(static_cast<double>(column) + std::fmod(0.5 + i * 0.7548776662466927, 1.0),
                                         static_cast<double>(row) + std::fmod(0.5 + i * 0.5698402909980532, 1.0), spacing);
                sum /= static_cast<float>(shading.samples);
            }
            finer[index] = sum;
        }
    });
    return finer;
}

void add_textured_points(std::vector<Rgb>& colours, const Scene& scene, const Surface& surface, const Camera& camera) {
    const ColourScale no_scale;
    const SurfaceColour colour(scene, surface, camera, no_scale);
    std::vector<char> done(colours.size(), 0);
    for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const Index point = scene.mesh.triangles[t][k];
            if (done[point] != 0) continue;
            done[point] = 1;
            Light light = colour.at_corner(static_cast<Index>(t), k);
            light[3] = 1;
            const std::uint32_t pixel = to_pixel(light);
            colours[point] = {static_cast<std::uint8_t>(pixel >> 16U & 255U), static_cast<std::uint8_t>(pixel >> 8U & 255U),
                              static_cast<std::uint8_t>(pixel & 255U)};
        }
}

std::vector<Light> averaged(const std::vector<Light>& light, int width, int height, int block_size) {
    const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height),
               n = static_cast<std::size_t>(block_size);
    std::vector<Light> means(columns * rows, Light::Zero());
    parallel_for(rows, [&](std::size_t row) {
        for (std::size_t column = 0; column < columns; ++column) {
            Light& sum = means[row * columns + column];
            for (std::size_t y = 0; y < n; ++y)
                for (std::size_t x = 0; x < n; ++x) sum += light[(row * n + y) * columns * n + column * n + x];
            sum /= static_cast<float>(n * n);
        }
    });
    return means;
}

std::vector<std::uint32_t> to_pixels(const std::vector<Light>& light) {
    std::vector<std::uint32_t> pixels(light.size());
    parallel_for(light.size(), 4096, [&](std::size_t i) { pixels[i] = to_pixel(light[i]); });
    return pixels;
}

std::array<std::uint16_t, 4> to_deep(const Light& light) {
    const float coverage = std::min(light[3], 1.0F);
    if (!(coverage > 0)) return {0, 0, 0, 0};
    const auto step = [](double fraction) {
        return static_cast<std::uint16_t>(std::lround(65535 * std::clamp(fraction, 0.0, 1.0)));
    };
    const auto channel = [&](int i) { return step(coded(std::clamp(static_cast<double>(light[i]) / light[3], 0.0, 1.0))); };
    return {channel(0), channel(1), channel(2), step(coverage)};
}

}  // namespace ostraka::detail
