// Smooth borders of regions for display, where the regions' outlines zigzag along the edges of the mesh.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <array>
#include <vector>

namespace ostraka {

struct SmoothRegions {
    /// The weights of one label in a face with several labels: a point in the face has the label with the largest weight.
    struct Patch {
        Index face = 0;
        int label = 0;
        std::array<float, 3> weights{};  ///< at the corners, linearly interpolated in between
    };
    std::vector<Patch> patches;                ///< by ascending face
    std::vector<std::vector<Point>> outlines;  ///< borders between the labels, as poly-lines
};

/// Each vertex has a weight per label: its fraction of the area around the vertex, smoothed `rounds` times over the one-ring. A
/// point has the label with the largest interpolated weight; outlines lie where the two largest are equal. A border moves by
/// one or two edges at most. A label that would vanish keeps its faces and their outline. `label_of_face`: arbitrary integers,
/// one per face. O(n), except for the sorting of elements on borders.
SmoothRegions smooth_regions(const Mesh& mesh, const std::vector<int>& label_of_face, int rounds = 2);

}  // namespace ostraka
