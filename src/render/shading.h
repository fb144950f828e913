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

/// Pixels 0xAARRGGBB, premultiplied, rows from the top; nothing where no triangle is seen.
std::vector<std::uint32_t> shade(const Scene& scene, const Surface& surface, const Camera& camera, int width, int height,
                                 const Shading& shading);

}  // namespace ostraka::detail
