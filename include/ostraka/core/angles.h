// Units of angles: radians inside the library, degrees in its input and output.
#pragma once

#include <numbers>

namespace ostraka {

inline constexpr double pi = std::numbers::pi;
inline constexpr double degree = pi / 180;  ///< one degree, in radians

}  // namespace ostraka
