// Renders the coloured, lit surface to pixels.
#pragma once

#include "ostraka/render/colour_scale.h"
#include "render/camera.h"
#include "render/surface.h"
#include "render/surface_colour.h"

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
    bool flat_light = false;      ///< colours without light and shade
    ColourScale scale;            ///< colour scale of values
};

/// Light of each pixel, rows from the top; zero coverage where no triangle is visible.
std::vector<Light> shade(const Scene& scene, const Surface& surface, const Camera& camera, int width, int height,
                         const Shading& shading);

/// Colours the points that are corners of textured triangles by the texture there.
void add_textured_points(std::vector<Rgb>& colours, const Scene& scene, const Surface& surface, const Camera& camera);

/// Means over blocks of `block_size` by `block_size` pixels.
std::vector<Light> averaged(const std::vector<Light>& light, int width, int height, int block_size);

/// Converts light to pixels 0xAARRGGBB, premultiplied.
std::vector<std::uint32_t> to_pixels(const std::vector<Light>& light);

/// Converts light to red, green, blue and alpha, not premultiplied, for a 16-bit sRGB file.
std::array<std::uint16_t, 4> to_deep(const Light& light);

}  // namespace ostraka::detail
