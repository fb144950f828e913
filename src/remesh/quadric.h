// Quadratic functions of a point: sums of weighted squared distances to planes and points.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <cmath>
#include <optional>

namespace ostraka {

/// A quadratic function of a point: Q(x) = x^T A x + 2 b^T x + c with symmetric A (Garland and Heckbert 1997, section 5).
struct Quadric {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  ///< entries of A
    Vector b{0, 0, 0};                                      ///< the vector b
    double c = 0;                                           ///< the constant c

    /// Adds weight * (n . (x - p))^2, the squared distance from the plane through p with unit normal n.
    void add_plane(const Vector& n, const Vector& p, double weight) {
        const double d = -(n * p);
        xx += weight * n.x() * n.x(), xy += weight * n.x() * n.y(), xz += weight * n.x() * n.z();
        yy += weight * n.y() * n.y(), yz += weight * n.y() * n.z(), zz += weight * n.z() * n.z();
        b += (weight * d) * n;
        c += weight * d * d;
    }
    /// Adds weight * |x - p|^2, the squared distance from the point p.
    void add_point(const Vector& p, double weight) {
        xx += weight, yy += weight, zz += weight;
        b -= weight * p;
        c += weight * p.squared_length();
    }
    Quadric& operator+=(const Quadric& q) {
        xx += q.xx, xy += q.xy, xz += q.xz, yy += q.yy, yz += q.yz, zz += q.zz;
        b += q.b;
        c += q.c;
        return *this;
    }
    /// Value of the function at x.
    [[nodiscard]] double operator()(const Vector& x) const {
        const Vector Ax(xx * x.x() + xy * x.y() + xz * x.z(), xy * x.x() + yy * x.y() + yz * x.z(),
                        xz * x.x() + yz * x.y() + zz * x.z());
        return x * Ax + 2 * (b * x) + c;
    }
    /// The point where Q is minimal, by Cholesky; none if A is not safely positive definite.
    [[nodiscard]] std::optional<Vector> minimum() const {
        const double tolerance = 1e-10 * (xx + yy + zz);
        if (!(xx > tolerance)) return {};
        const double l11 = std::sqrt(xx), l21 = xy / l11, l31 = xz / l11;
        const double d2 = yy - l21 * l21;
        if (!(d2 > tolerance)) return {};
        const double l22 = std::sqrt(d2), l32 = (yz - l31 * l21) / l22;
        const double d3 = zz - l31 * l31 - l32 * l32;
        if (!(d3 > tolerance)) return {};
        const double l33 = std::sqrt(d3);
        const double y1 = -b.x() / l11, y2 = (-b.y() - l21 * y1) / l22, y3 = (-b.z() - l31 * y1 - l32 * y2) / l33;
        const double z = y3 / l33, y = (y2 - l32 * z) / l22, x = (y1 - l21 * y - l31 * z) / l11;
        return Vector(x, y, z);
    }
};

}  // namespace ostraka
