// Classifies the two sides of curves in a face.
#pragma once

#include "geom/face_cutter.h"

#include <array>
#include <map>
#include <utility>
#include <vector>

namespace ostraka {

/// A face traversed by curves, and on which side of the curves its parts and adjacent faces lie.
struct FaceClassification {
    double share = 0;  ///< fraction of the face's area to the left of the curves
    double area = 0;   ///< area of the face
    /// For the adjacent face at edge k (from corner k to k + 1): 1 left, 0 right, -1 unknown or crossed.
    std::array<int, 3> beyond{-1, -1, -1};
    double border = 0;          ///< length of the face's mesh border to the left of the curves
    std::size_t conflicts = 0;  ///< number of contradictions between curves
    bool known = true;          ///< false: no piece of a curve is a boundary in the face
};

/// Classifies a face. `triangles`: the triangles into which the cutter divided the face. `net`: for pairs of vertices (smaller
/// index first), number of curve pieces from the first to the second minus the number in the opposite direction. `parts`, if
/// given, receives the triangles, each with true if it lies on the left.
FaceClassification classify_face(const Mesh& mesh, Index face, const FaceCutter& cutter,
                                 const std::vector<std::array<Index, 3>>& triangles,
                                 const std::map<std::pair<Index, Index>, int>& net,
                                 std::vector<std::pair<std::array<Point, 3>, bool>>* parts = nullptr);

}  // namespace ostraka
