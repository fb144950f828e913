// Silhouette of a mesh in a viewing direction.
#pragma once

#include "ostraka/slicing/slice.h"

namespace ostraka {

/// The silhouette of the mesh (or of the given faces) projected along the frame's normal: closed curves, outer boundaries
/// counter-clockwise, see-through holes clockwise. The silhouette is traced on a grid with `cells` cells along the longer side
/// and 16 samples per cell, so that the accuracy is about half a cell; curves are simplified with a tolerance of a quarter of a
/// cell. Throws Error (usage) for fewer than 8 or more than 4000 cells, Error (input) for a mesh without faces.
std::vector<std::vector<Eigen::Vector2d>> silhouette(const Mesh& mesh, const SliceFrame& frame, int cells = 500,
                                                     const std::vector<Index>& faces = {});

}  // namespace ostraka
