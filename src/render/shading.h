// The coloured, lit surface as pixels.
#pragma once

#include "camera.h"
#include "ostraka/render/colour_scale.h"
#include "surface.h"

#include <cstdint>
#include <vector>

namespace ostraka::detail {

struct Shading {
    bool smooth = true;
    double crease_cosine = 0.77;
    int ambient_occlusion = 0;  ///< rays a sample
    int samples = 8;            ///< rays a pixel where colours change
    bool edges = false;
    double edge_width = 1;  ///< pixels
    ColourScale scale;
};

/// Linear red, green, blue, multiplied by the coverage, and the coverage.
using Light = Eigen::Array4f;

/// Rows from the top; nothing where no triangle is seen.
std::vector<Light> shade(const Scene& scene, const Surface& surface, const Camera& camera, int width, int height,
                         const Shading& shading);

/// Each the mean of `share` by `share`.
std::vector<Light> averaged(const std::vector<Light>& light, int width, int height, int share);

/// Pixels 0xAARRGGBB, premultiplied.
std::vector<std::uint32_t> to_pixels(const std::vector<Light>& light);

/// Red, green, blue and alpha, not premultiplied, as an sRGB file of 16 bits holds them.
std::array<std::uint16_t, 4> to_deep(const Light& light);

}  // namespace ostraka::detail
