// Perceptual colour space CIELAB, and colour differences.
#pragma once

#include <array>

namespace ostraka {

/// A colour in CIELAB (CIE 15:2004, section 8.2.1): lightness 0 to 100, a (green to red), b (blue to yellow); the white point
/// is that of sRGB (D65).
using Lab = std::array<double, 3>;

/// CIELAB of linear sRGB light, each channel 0 to 1 (IEC 61966-2-1).
Lab lab_from_linear(const std::array<float, 3>& linear);

/// Difference of two colours, CIEDE2000 with unit weights (CIE 142-2001; formulae of Sharma, Wu and Dalal, "The CIEDE2000
/// color-difference formula", 2005). A difference of about 1 is just visible.
double colour_difference(const Lab& a, const Lab& b);

}  // namespace ostraka
