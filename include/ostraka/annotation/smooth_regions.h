// Borders of regions for the eye: smooth where the regions' own run in steps along the edges of the mesh.
#pragma once

#include "ostraka/core/mesh.h"

#include <array>
#include <vector>

namespace ostraka {

struct SmoothRegions {
    /// What a face that has several labels has of one of them: a place in the face belongs to the label of the largest weight.
    struct Patch {
        Index face = 0;
        int label = 0;
        std::array<float, 3> weights{};  ///< at the corners, linear between them
    };
    std::vector<Patch> patches;                ///< by ascending face
    std::vector<std::vector<Point>> outlines;  ///< between the labels, as poly-lines
};

/// Each vertex has of each label the share of the area around it, smoothed `rounds` times with its neighbours; a place has the
/// label of the largest of the weights interpolated there, and outlines are where two of them are equal. A border moves by less
/// than an edge or two. A label that so would vanish keeps its faces as they are, with their outline. Labels are any numbers, one
/// a face. O(n) but for the sorting of what lies on borders.
SmoothRegions smooth_regions(const Mesh& mesh, const std::vector<int>& label_of_face, int rounds = 2);

}  // namespace ostraka
