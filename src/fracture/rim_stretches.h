// Stretches of two rims that run alike.
#pragma once

#include "break_side.h"

namespace ostraka {

/// A pose that lays a stretch of the second rim onto one of the first.
struct StretchFit {
    Motion pose;
    double length = 0;     ///< of the stretch
    double deviation = 0;  ///< root mean square distance of its places
    double bend = 0;       ///< root mean square distance of its places from their straight line
    double told = 0;       ///< what the match says: of each place the logarithm of bend by deviation, above the noise
};

/// All stretches of rims of several lengths, from `shortest` on, each twice the one before, up to half of the shorter rim, the
/// second run backwards (the other side of a break is its mirror), whose places and side normals come together within
/// `tolerance` by a rigid motion (contour matching after Leitao and Stolfi 2002, in space and with the sides' normals). Those
/// that say most first: long, bent and close; at most `count`. In O(n m) for n and m places on the rims.
std::vector<StretchFit> matching_stretches(const std::vector<RimLoop>& first, const std::vector<RimLoop>& second, double shortest,
                                           double tolerance, std::size_t count);

}  // namespace ostraka
