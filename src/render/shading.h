// Renders the coloured, lit surface to pixels.
#pragma once

#include "ostraka/render/colour_scale.h"
#include "render/camera.h"
#include "render/surface.h"

#include <cstdint>
#include <vector>

namespace ostraka::detail {

struct Shading {
    bool smooth = true;           ///< interpolate normals across edges
    double crease_cosine = 0.77;  ///< cosine of the crease angle: edges whose face normals differ by a larger angle look sharp
    int ambient_occlusion = 0;    ///< number of ambient occlusion rays per sample
    int samples = 8;              ///< number of rays per pixel where colours change
    bool edges = false;           ///< draw the edges of the mesh
    double edge_width = 1;        ///< width of edges, pixels
    ColourScale scale;            ///< colour scale of values
};

/// Linear red, green and blue, premultiplied by the coverage, followed by the coverage (0 to 1).
using Light = Eigen::Array4f;

/// Light of each pixel, rows from the top; zero coverage where no triangle is visible.
std::vector<Light> shade(const Scene& scene, const Surface& surface, const Camera& camera, int width, int height,
                         const Shading& shading);

/// Means over blocks of `block_size` by `block_size` pixels.
std::vector<Light> averaged(const std::vector<Light>& light, int width, int height, int block_size);

/// Converts light to pixels 0xAARRGGBB, premultiplied.
std::vector<std::uint32_t> to_pixels(const std::vector<Light>& light);

/// Converts light to red, green, blue and alpha, not premultiplied, for a 16-bit sRGB file.
std::array<std::uint16_t, 4> to_deep(const Light& light);

}  // namespace ostraka::detail
