// Smooth borders of regions for display; the outlines of regions zigzag along the edges of the mesh.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <array>
#include <vector>

namespace ostraka {

/// Regions with smooth borders, as weights inside faces and as poly-lines.
struct SmoothRegions {
    /// The weights of one label in a face with several labels: a point in the face has the label with the largest weight.
    struct Patch {
        Index face = 0;  ///< index of the face
        int label = 0;   ///< label that the weights belong to
        /// Weight of the label at each corner of the face; linearly interpolated in between.
        std::array<float, 3> weights{};
    };
    std::vector<Patch> patches;                ///< sorted by face index
    std::vector<std::vector<Point>> outlines;  ///< borders between the labels, as poly-lines on the surface
};

/// Smooths the borders between labels. Each vertex gets a weight per label: the fraction of the area around the vertex that has
/// the label, smoothed `rounds` times over the one-ring. A point has the label with the largest interpolated weight; outlines lie
/// where the two largest weights are equal. A border moves by one or two edges at most. A label that would vanish keeps its faces
/// and their outline. `label_of_face`: arbitrary integers, one per face. Time: O(n), except for the sorting of elements on
/// borders.
SmoothRegions smooth_regions(const Mesh& mesh, const std::vector<int>& label_of_face, int rounds = 2);

}  // namespace ostraka
