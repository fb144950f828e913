// Medial axis of a slice, that is the centres of the maximal discs within the material, at several levels of detail.
#pragma once

#include "ostraka/slicing/slice.h"

namespace ostraka {

/// Medial axis of a slice at several levels of detail.
struct MedialAxis {
    /// A branch of the medial axis, a poly-line.
    struct Branch {
        /// Coordinates in the slice's plane; a single point if the axis is a point (a disc); a loop repeats its first point.
        std::vector<Eigen::Vector2d> points;
        std::vector<double> radii;  ///< radius of the maximal disc at each point
    };
    /// The medial axis pruned to one level of detail.
    struct Level {
        double residue = 0;            ///< edges with at least this chord residue are kept
        double length = 0;             ///< total length of the branches
        std::vector<Branch> branches;  ///< branches of the axis
    };
    /// One level per requested residue; the branches at a larger residue are a subset of those at a smaller one.
    std::vector<Level> levels;
};

/// Computes the medial axis of a slice. The axis consists of the Voronoi edges, within the material, of samples along the
/// closed contours (at most 1 / `samples` of a contour's length apart, corners included). The axis is pruned by the chord residue
/// (Ogniewicz and Kuebler 1995), which is defined at a point of the axis by its two nearest samples: the contour length between
/// the two samples minus their distance, divided by the length of the contour. The residue is dimensionless, 0 at the tips of
/// branches, and increases towards the centre (a disc: up to 0.18), so that pruning keeps the axis connected. If the two
/// samples lie on different contours, the residue is 1; loops around holes are therefore part of every level. Points closer
/// than 1e-6 of the slice's size are merged. Noise of the outline adds branches whose residue is about the squared amplitude
/// divided by the product of wavelength and contour length. Time: O(n log n). Throws Error (usage) for a residue outside 0.001
/// to 1, or samples below 20 or above a million.
MedialAxis medial_axis(const Slice& slice, const std::vector<double>& residues = {0.01, 0.05, 0.15}, int samples = 600);

}  // namespace ostraka
