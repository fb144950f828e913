// Vectors of three numbers, alone and in lanes of eight.
#pragma once

#include "coords/lanes.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace ostraka::coords {

using Vector3 = std::array<double, 3>;

OSTRAKA_INLINE Vector3 operator+(const Vector3& a, const Vector3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
OSTRAKA_INLINE Vector3 operator-(const Vector3& a, const Vector3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
OSTRAKA_INLINE Vector3 operator*(double s, const Vector3& a) { return {s * a[0], s * a[1], s * a[2]}; }
OSTRAKA_INLINE double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
OSTRAKA_INLINE Vector3 cross(const Vector3& a, const Vector3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Vector3& a) { return std::sqrt(dot(a, a)); }

/// Returns `a` if the condition holds, else `b`; components are selected one by one so that loops over lanes are vectorised.
OSTRAKA_INLINE Vector3 select(bool condition, const Vector3& a, const Vector3& b) {
    return {condition ? a[0] : b[0], condition ? a[1] : b[1], condition ? a[2] : b[2]};
}

/// Eight vectors, one per lane, stored by component.
struct VectorLanes {
    Lanes component[3];
    [[nodiscard]] OSTRAKA_INLINE Vector3 at(int lane) const {
        return {component[0][lane], component[1][lane], component[2][lane]};
    }
    OSTRAKA_INLINE void set(int lane, const Vector3& v) {
        component[0][lane] = v[0];
        component[1][lane] = v[1];
        component[2][lane] = v[2];
    }
};

}  // namespace ostraka::coords
