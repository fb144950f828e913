// Computes the axis of a surface of revolution from its normals.
#pragma once

#include "ostraka/algebra/dense.h"
#include "ostraka/geom/rigid_fit.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

/// Normal equations of the linear line complex of normals (Pottmann and Wallner, Computational Line Geometry, 2001): every normal
/// n at a point p of a surface of revolution intersects the axis, n . m + (p x n) . a = 0 for the axis with direction a and
/// moment m. Points should be centred at the origin: the loss of precision grows with the square of the points' distance from the
/// origin.
class LineComplex {
public:
    /// Adds the equation of a point with its unit normal.
    void add(const Eigen::Vector3d& place, const Eigen::Vector3d& normal, double weight = 1) {
        const Eigen::Vector3d q = place.cross(normal);
        weight_ += weight;
        n_ += weight * normal * normal.transpose();
        b_ += weight * normal * q.transpose();
        d_ += weight * q * q.transpose();
    }
    /// Adds all equations of `other`.
    void add(const LineComplex& other) {
        weight_ += other.weight_;
        n_ += other.n_;
        b_ += other.b_;
        d_ += other.d_;
    }
    /// The equations of the same points after a rigid motion.
    [[nodiscard]] LineComplex moved(const Motion& motion) const {
        const Eigen::Matrix3d &r = motion.rotation, n = r * n_ * r.transpose(), b = r * b_ * r.transpose();
        Eigen::Matrix3d t;
        t << 0, -motion.translation[2], motion.translation[1], motion.translation[2], 0, -motion.translation[0],
            -motion.translation[1], motion.translation[0], 0;
        LineComplex result;
        result.weight_ = weight_;
        result.n_ = n;
        result.b_ = b + n * t.transpose();
        result.d_ = r * d_ * r.transpose() + t * b + (t * b).transpose() + t * n * t.transpose();
        return result;
    }

    /// The axis of minimum error with |a| = 1; the pitch of the line complex is ignored.
    struct Axis {
        Eigen::Vector3d place, direction;  ///< point on the axis, and unit direction
        /// Weighted sum of squares of (distance between normal and axis, times the sine of the angle between them).
        double error = 0;
    };
    /// Solves the normal equations for the axis.
    [[nodiscard]] Axis solve() const {
        const SymmetricEigen3 of_n(n_);
        Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
        for (int k = 0; k < 3; ++k)
            if (of_n.eigenvalues()[k] > 1e-6 * n_.trace())
                inverse += of_n.eigenvectors().col(k) * of_n.eigenvectors().col(k).transpose() / of_n.eigenvalues()[k];
        const SymmetricEigen3 solver(d_ - b_.transpose() * inverse * b_);
        const Eigen::Vector3d a = solver.eigenvectors().col(0);
        return {a.cross(-inverse * b_ * a), a, std::max(0.0, solver.eigenvalues()[0])};
    }
    /// Root mean square distance between the axis and the normals (each distance times the sine of the angle between them).
    [[nodiscard]] double off_axis() const { return weight_ > 0 ? std::sqrt(solve().error / weight_) : 0; }

private:
    double weight_ = 0;
    Eigen::Matrix3d n_ = Eigen::Matrix3d::Zero(), b_ = Eigen::Matrix3d::Zero(), d_ = Eigen::Matrix3d::Zero();
};

}  // namespace ostraka
