// What faces of a fragment show by themselves, and labels that neighbours agree on.
#pragma once

#include "ostraka/core/mesh.h"

#include <vector>

namespace ostraka {

/// Unit normals of the faces, averaged with neighbours that look alike over about `length`, so that sharp edges stay (bilateral
/// normal filtering, Zheng et al. 2011, steps of one ring); the null vector for faces without area.
std::vector<Vector> filtered_normals(const Mesh& mesh, double length);

/// Angle in radians by which the surface turns over an edge, by `normals` of the faces; positive where convex; 0 at borders.
std::vector<double> turns(const Mesh& mesh, const std::vector<Vector>& normals);

/// What rays into the solid meet under each `step`-th face, from the first on.
struct Walls {
    std::vector<double> depth;     ///< median way to where they leave; infinite where fewer than half of them leave at all
    std::vector<double> opposite;  ///< mean of -cos of the angle between the normals there and here, -1 to 1
};
Walls walls_under(const Mesh& mesh, const std::vector<Vector>& normals, std::size_t step = 1);

/// For each face the label with the least sum of `costs[label][face]` and, over edges whose faces have different ones,
/// `boundary[edge]` (alpha expansion from the cheapest labels).
std::vector<std::size_t> min_labels(const Mesh& mesh, const std::vector<std::vector<double>>& costs,
                                    const std::vector<double>& boundary);

/// Parts between which the surface turns outward by more than `sharpest` (radians), averaged over their boundary: small patches
/// joined over the least turns first, then those pairs whose boundary turns least. Number of the part of each face.
std::vector<std::size_t> convex_parts(const Mesh& mesh, const std::vector<double>& areas, const std::vector<double>& turns,
                                      double sharpest);

}  // namespace ostraka
