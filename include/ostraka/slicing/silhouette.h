// The outline of a mesh as it is seen along a direction.
#pragma once

#include "ostraka/slicing/slice.h"

namespace ostraka {

/// The outline of the mesh (or of the given faces) projected along the frame's normal: closed curves, outer ones
/// counter-clockwise, what shows through clockwise. Traced through a grid whose cells are 1 / `cells` of the longer side, each
/// with 16 samples, so that it is about half a cell exact; curves are thinned to a quarter of a cell. Throws Error
/// (usage) below 8 or above 4000 cells, Error (input) for a mesh without faces.
std::vector<std::vector<Eigen::Vector2d>> silhouette(const Mesh& mesh, const SliceFrame& frame, int cells = 500,
                                                     const std::vector<Index>& faces = {});

}  // namespace ostraka
