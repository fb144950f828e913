// Waves of an outline's radius over the angle.
#pragma once

#include "ostraka/slicing/slice.h"

#include <array>

namespace ostraka {

inline constexpr std::size_t max_harmonics = 6;

struct OutlineHarmonics {
    double turn = 0;    ///< share of the directions from the centre that meet the contour
    double radius = 0;  ///< mean of the radius over the angle; 0 where too few directions meet it
    std::array<double, max_harmonics + 1> cosine{}, sine{};  ///< of k times the angle; 0 is not used
};

/// Harmonics of the distance from `centre` over the angle, by least squares over 360 evenly spread directions (the farthest
/// crossing each); a slight damping keeps what a gap leaves open small.
OutlineHarmonics outline_harmonics(const Contour& contour, const Eigen::Vector2d& centre);

}  // namespace ostraka
