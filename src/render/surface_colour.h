// The colour of the surface at a point: values, patches, textures and colours of triangles and points.
#pragma once

#include "ostraka/render/colour_scale.h"
#include "render/camera.h"
#include "render/surface.h"

#include <unordered_map>

namespace ostraka::detail {

/// Linear red, green and blue, premultiplied by the coverage, followed by the coverage (0 to 1).
using Light = Eigen::Array4f;

/// An opaque sRGB colour as light.
Light to_light(const Rgb& colour);

class SurfaceColour {
public:
    /// The arguments must outlive this object.
    SurfaceColour(const Scene& scene, const Surface& surface, const Camera& camera, const ColourScale& scale);

    /// Linear colour, not premultiplied, and opacity of the surface at a hit of the ray through the pixel coordinates x, y. A
    /// texture is averaged over the area on the surface that belongs to the ray, if the rays of the picture are `spacing` pixels
    /// apart.
    [[nodiscard]] Light operator()(const Surface::Hit& hit, double x, double y, double spacing) const;

    /// Whether a texture is shown.
    [[nodiscard]] bool is_textured() const { return textured_; }
    /// Linear colour of the texture, times the surface's own colour, at a corner (0, 1, 2) of a triangle.
    [[nodiscard]] Light at_corner(Index triangle, std::size_t corner) const;

private:
    [[nodiscard]] Index material_of(Index triangle) const;
    /// The colour of triangles and points; `otherwise`: colour if there is none.
    [[nodiscard]] Light own_colour(const Surface::Hit& hit, const Light& otherwise) const;
    [[nodiscard]] Light textured(const Surface::Hit& hit, Index material, double x, double y, double spacing) const;
    /// Colour of the patches of a triangle, which start at index `first`.
    [[nodiscard]] Rgb patch_colour(std::size_t first, const Surface::Hit& hit) const;

    const Scene& scene_;
    const Surface& surface_;
    const Camera& camera_;
    const ColourScale& scale_;
    bool textured_;
    std::unordered_map<Index, std::size_t> patches_;  ///< index of the first patch of a triangle
};

}  // namespace ostraka::detail
