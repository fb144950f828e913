// The medial axis of a slice at several levels of detail: centres of the largest discs that the material holds.
#pragma once

#include "ostraka/slicing/slice.h"

namespace ostraka {

struct MedialAxis {
    struct Branch {
        std::vector<Eigen::Vector2d> points;  ///< in the slice's frame; one point alone where the axis is one (a disc); a loop
                                              ///< repeats its first point
        std::vector<double> radii;            ///< of the disc around each point
    };
    struct Level {
        double residue = 0;  ///< least chord residue of what is kept
        double length = 0;   ///< of all branches
        std::vector<Branch> branches;
    };
    std::vector<Level> levels;  ///< as asked for; those of larger residues are parts of those of smaller ones
};

/// The Voronoi edges within the material of samples along the closed contours (at most 1 / `samples` of a contour's length apart,
/// its corners among them), pruned by the chord residue (Ogniewicz and Kuebler 1995): the length of the contour between the two
/// samples that a place of the axis touches, less their distance, over the contour's length. It has no unit, is 0 at the tips of
/// branches and grows towards the middle (a disc: up to 0.18), so that pruning keeps what is connected so; between two contours
/// it counts as 1: what goes around a hole stays on every level. Places nearer to each other than 1e-6 of the slice are one.
/// Noise of the outline makes branches of residues near its square over wave length and contour length. O(n log n). Throws Error
/// (usage) for a residue outside 0.001 to 1, or samples below 20 or above a million.
MedialAxis medial_axis(const Slice& slice, const std::vector<double>& residues = {0.01, 0.05, 0.15}, int samples = 600);

}  // namespace ostraka
