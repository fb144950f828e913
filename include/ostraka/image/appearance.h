// Appearance of a mesh: materials with images, and the colour of a material at texture coordinates.
#pragma once

#include "ostraka/image/image.h"
#include "ostraka/mesh/mesh.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// Colour at texture coordinates outside 0 to 1: the image is repeated (repeat), its border pixels are extended (clamp), or the
/// image is mirrored at each border (mirror).
enum class TextureWrap { repeat, clamp, mirror };

/// Texture coordinates: u increases from left to right, v from the bottom to the top of the image (as in OBJ and PLY; in glTF v
/// increases downwards). Both are 0 to 1 over the image.
using TexturePoint = std::array<float, 2>;

/// A material of a surface. The colour of a point is base_colour times the image's colour there, in linear light.
struct Material {
    std::string name;                              ///< may be empty
    std::array<float, 4> base_colour{1, 1, 1, 1};  ///< linear red, green, blue and opacity, 0 to 1
    Index image = no_index;                        ///< index of the base colour image in Appearance::images; no_index: none
    TextureWrap wrap_u = TextureWrap::repeat, wrap_v = TextureWrap::repeat;
    bool nearest = false;                                            ///< true: pixels of the image are not interpolated
    enum class Alpha { opaque, mask, blend } alpha = Alpha::opaque;  ///< how the opacity is used (glTF 2.0, section 3.9.4)
    float alpha_cutoff = 0.5F;                                       ///< mask: opacity below which nothing is drawn
    bool double_sided = true;                                        ///< true: the back of a face is drawn too
    /// Further properties of the material in a glTF file, which are kept and written to glTF files again: a JSON object, whose
    /// texture indices are indices of Appearance::images. Empty: no further properties.
    std::string gltf_rest;
    /// Further properties of the material in an MTL file, as lines; they refer to images by file names.
    std::vector<std::string> mtl_rest;
};

/// The materials of a mesh and their images.
struct Appearance {
    std::vector<Material> materials;
    std::vector<SharedImage> images;  ///< null: the image is missing or unreadable, and a note reports it
    [[nodiscard]] bool empty() const { return materials.empty(); }  ///< true if there is no material
};

/// One sRGB channel (IEC 61966-2-1), 0 to 255, as linear light, 0 to 1.
float linear_from_srgb(std::uint8_t channel);
/// Linear light, clamped to 0 to 1, as the nearest sRGB channel.
std::uint8_t srgb_from_linear(float light);

/// Reads the colour of a material at texture coordinates from decoded images. At construction the images are decoded, and a
/// pyramid of reduced images is built (mipmaps: each level has half the size and holds the means of each channel in linear
/// light). May be used by several threads.
class TextureSampler {
public:
    /// Decodes the images of materials. `where`: file for messages. Throws Error (input) as `decode` does, and Error (failure) if
    /// the images do not fit into memory: 6.7 bytes per pixel are needed.
    TextureSampler(const Appearance& appearance, const std::string& where);

    /// Linear red, green, blue and opacity of a material at the texture coordinates `at`, multiplied by the base colour.
    /// `footprint`: width, in texture coordinates, of the area over which the colour is averaged. If the footprint is at most
    /// one pixel, the image is interpolated bilinearly (or its nearest pixel is used, if Material::nearest is set); otherwise
    /// trilinearly in the pyramid. The base colour is returned if there is no readable image, and white if `material` is
    /// no_index.
    [[nodiscard]] std::array<float, 4> colour(Index material, TexturePoint at, float footprint = 0) const;
    /// Size of the material's image in pixels; {0, 0} without an image.
    [[nodiscard]] std::array<int, 2> size(Index material) const;
    /// The materials, as in the appearance.
    [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }

private:
    struct Level {
        int width = 0, height = 0;
        std::vector<std::array<std::uint16_t, 4>> rgba;  ///< linear light and opacity, 0 to 65535
    };
    struct Pyramid {
        Pixels full;                ///< no pixels: no image
        std::vector<Level> levels;  ///< the reduced images, down to 1 x 1 pixel
    };
    [[nodiscard]] const Pyramid* pyramid_of(Index material) const;  ///< null without an image

    std::vector<Material> materials_;
    std::vector<Pyramid> pyramids_;  ///< one per image
};

}  // namespace ostraka
