// Rendering of the coloured, lit surface to pixels.
#pragma once

#include "ostraka/render/colour_scale.h"
#include "render/camera.h"
#include "render/surface.h"

#include <cstdint>
#include <vector>

namespace ostraka::detail {

struct Shading {
    bool smooth = true;
    double crease_cosine = 0.77;
    int ambient_occlusion = 0;  ///< rays per sample
    int samples = 8;            ///< rays per pixel where colours change
    bool edges = false;
    double edge_width = 1;  ///< pixels
    ColourScale scale;
};

/// Linear red, green, blue, premultiplied by the coverage, and the coverage.
using Light = Eigen::Array4f;

/// Rows from the top; zero coverage where no triangle is visible.
std::vector<Light> shade(const Scene& scene, const Surface& surface, const Camera& camera, int width, int height,
                         const Shading& shading);

/// The means of blocks of `share` by `share` pixels.
std::vector<Light> averaged(const std::vector<Light>& light, int width, int height, int block_size);

/// Pixels 0xAARRGGBB, premultiplied.
std::vector<std::uint32_t> to_pixels(const std::vector<Light>& light);

/// Red, green, blue and alpha, not premultiplied, for a 16-bit sRGB file.
std::array<std::uint16_t, 4> to_deep(const Light& light);

}  // namespace ostraka::detail
