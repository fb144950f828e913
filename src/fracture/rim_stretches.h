// Matching stretches of two rims.
#pragma once

#include "fracture/fracture_side.h"

namespace ostraka {

/// A pose that registers a stretch of the second rim with a stretch of the first.
struct StretchFit {
    Motion pose;           ///< rigid motion that maps the second fragment onto the first
    double length = 0;     ///< length of the matched stretch
    double deviation = 0;  ///< root mean square distance between matched points of the two stretches
    double bend = 0;       ///< root mean square distance of the stretch's points from the straight line fitted to them
    /// Information of the match: sum over the points of log(bend / deviation), above the noise.
    double information = 0;
};

/// Finds all pairs of stretches of two rims whose points and side normals coincide within `tolerance` after a rigid motion. The
/// lengths of stretches double from `shortest` up to half of the shorter rim. The second rim is traversed backwards, because the
/// other side of a fracture is its mirror image (contour matching after Leitao and Stolfi 2002, in 3D and with the normals of the
/// sides). Returns at most `count` pairs, by descending `information`: long, bent and closely matching pairs first. Time: O(n m)
/// for n and m points on the rims.
std::vector<StretchFit> matching_stretches(const std::vector<RimLoop>& first, const std::vector<RimLoop>& second, double shortest,
                                           double tolerance, std::size_t count);

}  // namespace ostraka
