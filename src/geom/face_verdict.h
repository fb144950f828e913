// The two sides of curves in a face.
#pragma once

#include "geom/face_cutter.h"

#include <array>
#include <map>
#include <utility>
#include <vector>

namespace ostraka {

/// A face traversed by curves: the fraction of its area to their left and, for each of its edges (from corner k to k + 1) that
/// no curve crosses, the side on which the adjacent face lies.
struct FaceVerdict {
    double share = 0;
    double area = 0;
    std::array<int, 3> beyond{-1, -1, -1};  ///< 1 left, 0 right, -1 unknown
    double border = 0;                      ///< length of the mesh border on the left
    std::size_t conflicts = 0;
    bool known = true;  ///< false: no piece is a boundary in the face
};

/// `triangles`: the face as the cutter cut it; `net`: for pairs of vertices, the lower first, how often curves run from the first
/// to the second, minus the opposite; `parts`, if given, receives the triangles and whether they are on the left.
FaceVerdict judge_face(const Mesh& mesh, Index face, const FaceCutter& cutter, const std::vector<std::array<Index, 3>>& triangles,
                       const std::map<std::pair<Index, Index>, int>& net,
                       std::vector<std::pair<std::array<Point, 3>, bool>>* parts = nullptr);

}  // namespace ostraka
