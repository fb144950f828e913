// Medial axis of a slice at several levels of detail: centres of the maximal discs within the material.
#pragma once

#include "ostraka/slicing/slice.h"

namespace ostraka {

struct MedialAxis {
    struct Branch {
        /// In the slice's frame; a single point if the axis is a point (a disc); a loop repeats its first point.
        std::vector<Eigen::Vector2d> points;
        std::vector<double> radii;  ///< radius of the maximal disc at each point
    };
    struct Level {
        double residue = 0;  ///< minimum chord residue of the kept edges
        double length = 0;   ///< total length of the branches
        std::vector<Branch> branches;
    };
    std::vector<Level> levels;  ///< one per requested residue; levels of larger residues are subsets of levels of smaller ones
};

/// Voronoi edges, within the material, of samples along the closed contours (spaced at most 1 / `samples` of a contour's
/// length, corners included), pruned by the chord residue (Ogniewicz and Kuebler 1995): the contour length between the two
/// samples nearest to a point of the axis, minus their distance, over the length of the contour. It is dimensionless, 0 at the
/// tips of branches, and increases towards the centre (a disc: up to 0.18), so that pruning keeps the axis connected. Between
/// two contours it is 1: loops around holes stay on every level. Points closer than 1e-6 of the slice are merged. Noise of the
/// outline adds branches whose residue is about its square over the product of wavelength and contour length. O(n log n).
/// Throws Error (usage) for a residue outside 0.001 to 1, or samples below 20 or above a million.
MedialAxis medial_axis(const Slice& slice, const std::vector<double>& residues = {0.01, 0.05, 0.15}, int samples = 600);

}  // namespace ostraka
