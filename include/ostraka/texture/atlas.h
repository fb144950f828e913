// Texture atlases: the surface of a mesh cut into charts, and the charts packed into square images.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/image/appearance.h"
#include "ostraka/io/mesh_file.h"

#include <vector>

namespace ostraka {

/// Where the faces of a mesh lie in images, all of one size.
struct TextureLayout {
    /// Texture coordinates of the corners, three per face, in the order of corners(mesh, face).
    std::vector<TexturePoint> corner_texture;
    std::vector<Index> face_image;  ///< for each face the index of its image; no_index: none. Empty: all in image 0
    int width = 0, height = 0;      ///< size of each image, in texels
    std::size_t images = 0;         ///< number of images

    /// Image of a face.
    [[nodiscard]] Index image_of(std::size_t face) const { return face_image.empty() ? 0 : face_image[face]; }
};

/// Largest number of images of an atlas; larger surfaces get larger texels.
inline constexpr std::size_t max_atlas_images = 4;

/// Options of `make_atlas`.
struct AtlasOptions {
    double texel = 0;     ///< texel size: length on the surface per texel, in the mesh's unit; must be positive
    int max_size = 8192;  ///< largest width and height of an image, in texels
    int gutter = 2;       ///< number of texels left free around each chart
    double cone = 40;     ///< largest angle between the normals of a chart and its axis that charts grow to, in degrees

    /// Adds every member but `texel` to a list of options.
    void declare_options(OptionList& list);
};

/// An atlas of a mesh.
struct Atlas {
    TextureLayout layout;           ///< texture coordinates; width and height are equal
    std::vector<Index> face_chart;  ///< for each face the index of its chart
    std::size_t charts = 0;         ///< number of charts
    /// Texel size reached: the requested size, or a larger one if the surface did not fit into the images.
    double texel = 0;
    /// Largest length on the surface of one texel in any direction, divided by `texel`; faces thinner than a thousandth of a
    /// texel are not counted.
    double largest_stretch = 1;
    double used = 0;  ///< share of the images that charts cover, 0 to 1
};

/// Makes an atlas. Faces are joined into charts by hierarchical clustering (Garland, Willmott and Heckbert, "Hierarchical face
/// clustering on polygonal surfaces", 2001) with a merging cost of deviation of normals per length of the common border, while a
/// cone of at most `cone` contains the normals (charts below 16 x 16 texels: 75 degrees). A chart is projected along its axis and
/// scaled to its area on the surface; a chart whose projection overlaps itself (checked at texel centres) is divided. Charts are
/// turned into their smallest rectangles and packed. Every corner is at least `gutter` texels away from the border of its image
/// and twice as far from other charts. Takes O(n log n) time for n faces. The result is deterministic. Throws Error (usage) for
/// options out of range, Error (input) for a mesh without faces or with coordinates beyond `max_coordinate`.
Atlas make_atlas(const Mesh& mesh, const AtlasOptions& options);

/// The texture coordinates that a mesh file has. Faces of material i lie in image i if the material has an image; all
/// images get the size of the largest. Throws Error (input), with `where`, for a file without texture coordinates or images.
TextureLayout layout_of(const MeshFile& file, const std::string& where);

/// Texel size of the images of a mesh: root of the area of its faces with images, in the mesh's unit, per texel. Without images:
/// half the mean edge length of the mesh.
double texel_size(const MeshFile& file);

/// Length on the surface per texel of a layout: root of the area on the surface per area in texels; 0 without any area.
double texel_size(const Mesh& mesh, const TextureLayout& layout);

}  // namespace ostraka
