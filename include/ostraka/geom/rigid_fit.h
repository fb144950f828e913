// Rigid or similarity motions, and their estimation from corresponding points in closed form.
#pragma once

#include <Eigen/Geometry>

#include <vector>

namespace ostraka {

/// Rigid or similarity motion p -> scale * rotation * p + translation.
struct Motion {
    /// Orthogonal matrix; its determinant is 1, or -1 if the motion includes a reflection.
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< applied after rotation and scaling
    double scale = 1;                                       ///< scale factor; 1 for rigid motions

    [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& p) const { return scale * (rotation * p) + translation; }
    [[nodiscard]] Motion inverse() const;  ///< the motion that undoes this motion
    /// Composition: first `other`, then this motion.
    [[nodiscard]] Motion after(const Motion& other) const;
    [[nodiscard]] bool mirrors() const { return rotation.determinant() < 0; }  ///< true: the motion includes a reflection
    bool operator==(const Motion&) const = default;
};

/// Applies a motion to points. Each sum is computed in twice the precision of a double and rounded once. The shape of an object
/// far from the origin is therefore preserved up to the rounding of its coordinates. Translations, exchanges of axes,
/// reflections in coordinate planes and rotations by right angles about coordinate axes are exact if their results are
/// representable.
class PreciseMotion {
public:
    explicit PreciseMotion(const Motion& motion) : matrix_(motion.scale * motion.rotation), translation_(motion.translation) {}
    [[nodiscard]] Eigen::Vector3d operator()(const Eigen::Vector3d& p) const;

private:
    Eigen::Matrix3d matrix_;
    Eigen::Vector3d translation_;
};

/// Options of fit_motion.
struct FitOptions {
    bool scale = false;                     ///< true: a scale is estimated too
    double min_scale = 0, max_scale = 1e9;  ///< limits of an estimated scale
};

/// The motion T that minimises the weighted sum of |T(from) - to|^2 over corresponding points (Umeyama 1991, by singular value
/// decomposition of the covariance matrix; the result is never a reflection). A scale outside its limits is set to the nearest
/// limit, which is optimal because the sum is quadratic in the scale. Empty `weights`: all weights are 1. If the points do not
/// determine the motion (a single point, collinear or equal points), one of the optimal motions is returned. Throws Error
/// (usage) if the numbers of points differ or are 0.
Motion fit_motion(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to,
                  const std::vector<double>& weights = {}, const FitOptions& options = {});

}  // namespace ostraka
