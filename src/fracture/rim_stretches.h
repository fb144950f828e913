// Matching stretches of two rims.
#pragma once

#include "fracture/fracture_side.h"

namespace ostraka {

/// A pose that registers a stretch of the second rim with a stretch of the first.
struct StretchFit {
    Motion pose;
    double length = 0;       ///< length of the stretch
    double deviation = 0;    ///< root mean square distance between its matched points
    double bend = 0;         ///< root mean square distance of its points from their straight line
    double information = 0;  ///< of the match: sum over the points of log(bend / deviation), above the noise
};

/// All pairs of stretches of the two rims, of lengths from `shortest` on, doubling up to half of the shorter rim, whose points
/// and side normals coincide within `tolerance` after a rigid motion; the second rim is traversed backwards, as the other side
/// of a fracture is its mirror image (contour matching after Leitao and Stolfi 2002, in 3D and with the normals of the sides).
/// Most informative first: long, bent and close; at most `count`. In O(n m) for n and m points on the rims.
std::vector<StretchFit> matching_stretches(const std::vector<RimLoop>& first, const std::vector<RimLoop>& second, double shortest,
                                           double tolerance, std::size_t count);

}  // namespace ostraka
