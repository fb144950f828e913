// Limits of coordinates read from files, and normalisation of vectors of any length.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

/// Largest allowed absolute value of a coordinate; products of four lengths then do not overflow.
inline constexpr double max_coordinate = 1e60;

/// True if no coordinate is NaN or beyond `max_coordinate` in absolute value.
inline bool is_place(double x, double y, double z) {
    // NaN compares as false.
    return std::abs(x) <= max_coordinate && std::abs(y) <= max_coordinate && std::abs(z) <= max_coordinate;
}
inline bool is_place(const Point& p) { return is_place(p.x(), p.y(), p.z()); }

/// The vector `v` scaled by a power of two (hence without rounding) so that its largest component lies between 1/2 and 1 and
/// squares neither overflow nor underflow. The result is the null vector if `v` is null or not finite.
inline Vector scaled_vector(const Vector& v) {
    const double largest = std::max({std::abs(v.x()), std::abs(v.y()), std::abs(v.z())});
    if (!(largest > 0 && std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z()))) return CGAL::NULL_VECTOR;
    int exponent = 0;
    (void)std::frexp(largest, &exponent);
    return {std::ldexp(v.x(), -exponent), std::ldexp(v.y(), -exponent), std::ldexp(v.z(), -exponent)};
}

/// The unit vector along `v`; the null vector if `v` is null or not finite. Works for vectors of any length.
inline Vector unit_vector(const Vector& v) {
    const Vector scaled = scaled_vector(v);
    return scaled == CGAL::NULL_VECTOR ? scaled : scaled / std::sqrt(scaled.squared_length());
}

}  // namespace ostraka
