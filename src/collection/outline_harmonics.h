// Fourier harmonics of an outline: its radius as a function of the angle.
#pragma once

#include "ostraka/slicing/slice.h"

#include <array>

namespace ostraka {

inline constexpr std::size_t max_harmonics = 6;  ///< number of harmonics computed

/// Fourier coefficients of the radius of an outline.
struct OutlineHarmonics {
    double turn = 0;    ///< fraction of the directions from the centre that meet the contour
    double radius = 0;  ///< mean radius over the angle; 0 if too few directions meet the contour
    /// Entry k: cosine and sine coefficient of harmonic k; entry 0 is unused.
    std::array<double, max_harmonics + 1> cosine{}, sine{};
};

/// Harmonics of the distance from `centre` over the angle, by least squares over 360 evenly spaced directions (in each direction
/// the farthest crossing of the outline counts). Slight damping keeps small those coefficients that a gap in the outline leaves
/// undetermined.
OutlineHarmonics outline_harmonics(const Contour& contour, const Eigen::Vector2d& centre);

}  // namespace ostraka
