// Baking: images and vertex colours of a mesh computed from another mesh of the same object.
#pragma once

#include "ostraka/texture/atlas.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

/// What a baked image shows.
enum class BakedQuantity {
    colour,     ///< colours of the source: image and base colour of the material times the colours of vertices and faces
    occlusion,  ///< ambient occlusion of the source: share of the hemisphere that is open, black 0 to white 1
    curvature,  ///< mean curvature of the source, in 1/length
    relief      ///< height of the source above the target along the normal of the target, in the mesh's unit
};

/// Options of baking.
struct BakeOptions {
    BakedQuantity quantity = BakedQuantity::colour;
    double distance = 0.02;  ///< largest distance of the source from the target, as a fraction of the target's box diagonal
    /// Rays per row and column of a texel; 0: as many as there are texels of the source along a texel, 1 to 4.
    int samples = 0;
    enum class Missing { fill, grey } missing = Missing::fill;  ///< what texels without source show: their neighbourhood, grey
    int gutter = 4;                    ///< width in texels around charts that shows the nearest texel of a chart
    int occlusion_rays = 64;           ///< number of rays per sample
    double occlusion_distance = 0.25;  ///< length of the occlusion rays, as a fraction of the source's box diagonal
    double curvature_scale = 0;        ///< scale of CurvatureOptions
    /// Value shown by white (and its negative by black) for curvature and relief; 0: the absolute value that 99 % of the samples
    /// do not exceed.
    double range = 0;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// How many samples found the source, and how far away it was.
struct BakeCounts {
    std::size_t by_ray = 0;       ///< found along the normal of the target
    std::size_t by_nearest = 0;   ///< found as the nearest point of the source
    std::size_t without = 0;      ///< not found
    double mean_distance = 0;     ///< mean distance of the source where it was found, in the mesh's unit
    double largest_distance = 0;  ///< largest distance of the source where it was found

    /// Number of samples.
    [[nodiscard]] std::size_t total() const { return by_ray + by_nearest + without; }
};

/// Baked images.
struct BakeResult {
    std::vector<Pixels> images;  ///< one per image of the layout; every texel has a colour
    BakeCounts counts;           ///< of the texels in charts and on their borders
    double texel = 0;            ///< length on the target per texel
    int samples = 1;             ///< rays per row and column of a texel
    double low = 0, high = 1;    ///< values shown by black and by white; not for colours
};

/// The mesh from which images are baked, with its colours and images.
using BakeSource = MeshFile;

/// Bakes images of a mesh. For each texel, a ray from its point on the target along the interpolated normal, in both directions,
/// finds the nearest point of the source whose normal agrees with that of the target; without a hit, the nearest point within
/// the distance is taken. Texels whose centres lie beyond the border of a chart by up to one texel show the border. Further
/// texels are filled: near charts with the nearest texel, elsewhere from a pyramid of means, so that smaller versions of the
/// image show no black. The result is the same for any number of threads. `where`: file of the source, for messages. Throws Error
/// (usage) for options out of range or a layout that does not fit the mesh, Error (input) for a source without area or
/// with images that cannot be decoded.
BakeResult bake(const Mesh& target, const TextureLayout& layout, const BakeSource& source, const BakeOptions& options,
                const std::string& where);

/// Baked colours of vertices.
struct BakedVertices {
    std::vector<Colour> colours;  ///< one per vertex; vertices without source are grey
    BakeCounts counts;            ///< of the samples
    double low = 0, high = 1;     ///< values shown by black and by white; not for colours
};

/// Bakes a colour for each vertex: the mean over the vertex's Voronoi share of each of its faces, sampled as densely as the
/// texels of the source (at most 1024 samples per face). Otherwise as `bake`.
BakedVertices bake_vertices(const Mesh& target, const BakeSource& source, const BakeOptions& options, const std::string& where);

/// How baked images are stored.
struct BakedImageOptions {
    ImageFormat format = ImageFormat::png;
    int quality = 92;  ///< of JPEG and WebP, 1 to 100
    std::string name;  ///< name of the images without extension
};

/// Makes images the texture of a mesh: texture coordinates, one material per image and the encoded images replace those of
/// `extras`, and colours of vertices and faces are removed, since the images contain them. `alpha`: how opacity is used.
void set_texture(MeshExtras& extras, const TextureLayout& layout, const std::vector<Pixels>& images,
                 const BakedImageOptions& options, Material::Alpha alpha = Material::Alpha::opaque);

/// How the materials of a mesh use opacity: blend if one does, else mask if one does, else opaque.
Material::Alpha alpha_of(const Appearance& appearance);

}  // namespace ostraka
