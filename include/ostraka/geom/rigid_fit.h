// The motion that carries one set of points onto another, in closed form.
#pragma once

#include <Eigen/Geometry>

#include <vector>

namespace ostraka {

/// p -> scale rotation p + translation.
struct Motion {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< determinant 1
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();
    double scale = 1;

    [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& p) const { return scale * (rotation * p) + translation; }
    [[nodiscard]] Motion inverse() const;
    /// First `other`, then this.
    [[nodiscard]] Motion after(const Motion& other) const;
    bool operator==(const Motion&) const = default;
};

struct FitOptions {
    bool scale = false;                     ///< a free scale as well
    double min_scale = 0, max_scale = 1e9;  ///< a free scale is held within these
};

/// The motion with the least sum of weights |T(from) - to|^2 (Umeyama 1991: singular values of the covariance, never a
/// reflection; a scale held within limits is the clamped one, as the sum is a parabola in it). `weights` empty: all 1. Points
/// that leave the motion open (one point, all on a line or equal) get one of the best ones. Throws Error (usage) if the numbers
/// of points differ or there is none.
Motion fit_motion(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to,
                  const std::vector<double>& weights = {}, const FitOptions& options = {});

}  // namespace ostraka
