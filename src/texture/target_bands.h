// The texels of a layout, band by band, with the faces that they show.
#pragma once

#include "ostraka/texture/atlas.h"
#include "texture/raster.h"

#include <cstdint>
#include <vector>

namespace ostraka::texture {

/// A place of a target: a face and barycentric weights.
struct TargetPlace {
    Index face;
    std::array<double, 3> barycentric;
};

/// Texels of one image in rows [first_row, beyond_row).
struct Band {
    std::size_t image = 0;
    int first_row = 0, beyond_row = 0;
    std::vector<Index> faces{};  ///< faces near the band, ascending
};

/// Throws Error (usage) for a layout that does not fit the mesh.
void check_layout(const Mesh& mesh, const TextureLayout& layout);

/// The faces that texels show. Texels are divided into `samples` x `samples` parts.
class TargetBands {
public:
    /// `layout`: as check_layout permits.
    TargetBands(const Mesh& mesh, const TextureLayout& layout, int samples);

    [[nodiscard]] const std::vector<Band>& bands() const { return bands_; }
    /// For each part of each texel of a band, row by row, the face on which its centre lies, or no_index.
    [[nodiscard]] std::vector<Index> faces_of_parts(const Band& band) const;
    /// For each texel of a band no part of which lies on a face, the face whose border is nearest, up to 1.5 texels from the texel's
    /// centre, or no_index; `parts`: result of faces_of_parts.
    [[nodiscard]] std::vector<Index> faces_of_fringe(const Band& band, const std::vector<Index>& parts) const;
    /// Place in a face of a point of the image, in texels from its upper left corner: the nearest point of the face.
    [[nodiscard]] TargetPlace place(Index face, double x, double y) const;

private:
    [[nodiscard]] Vector2d texel_point(Index face, std::size_t corner) const;
    void make_bands();
    void find_borders();

    const Mesh& mesh_;
    const TextureLayout& layout_;
    int samples_;
    std::vector<Band> bands_;
    std::vector<std::uint8_t> borders_;  ///< for each face, bit k: its edge from corner k is a border in the image
};

}  // namespace ostraka::texture
