// Numbers from outside: how large places may be, and directions of any length.
#pragma once

#include "ostraka/core/mesh.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

/// Lengths to the fourth power must stay finite and above zero in all that is computed with places.
inline constexpr double largest_coordinate = 1e60;

/// No coordinate is NaN or beyond `largest_coordinate`.
inline bool is_place(double x, double y, double z) {
    // NaN compares as false.
    return std::abs(x) <= largest_coordinate && std::abs(y) <= largest_coordinate && std::abs(z) <= largest_coordinate;
}
inline bool is_place(const Point& p) { return is_place(p.x(), p.y(), p.z()); }

/// A multiple of `v`, of whatever length, whose squares neither overflow nor vanish: the largest component comes to 1/2 to 1, by
/// a power of two, so that nothing is rounded. The null vector for one without length or that is not finite.
inline Vector scaled_vector(const Vector& v) {
    const double largest = std::max({std::abs(v.x()), std::abs(v.y()), std::abs(v.z())});
    if (!(largest > 0 && std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z()))) return CGAL::NULL_VECTOR;
    int exponent = 0;
    (void)std::frexp(largest, &exponent);
    return {std::ldexp(v.x(), -exponent), std::ldexp(v.y(), -exponent), std::ldexp(v.z(), -exponent)};
}

/// The vector of length 1 along `v`, of whatever length; the null vector for one without length or that is not finite.
inline Vector unit_vector(const Vector& v) {
    const Vector scaled = scaled_vector(v);
    return scaled == CGAL::NULL_VECTOR ? scaled : scaled / std::sqrt(scaled.squared_length());
}

}  // namespace ostraka
