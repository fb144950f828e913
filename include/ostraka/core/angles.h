// Angles are in radians inside, in degrees outside.
#pragma once

#include <numbers>

namespace ostraka {

inline constexpr double pi = std::numbers::pi;
inline constexpr double degree = pi / 180;  ///< one degree, in radians

}  // namespace ostraka
