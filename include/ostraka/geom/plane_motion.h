// Point-to-plane registration steps.
#pragma once

#include "ostraka/algebra/dense.h"
#include "ostraka/geom/rigid_fit.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace ostraka {

/// One step of iterative closest points, point to plane (Chen and Medioni 1991): finds the linearised rotation, translation and
/// scaling about a centre that minimise the weighted sum of squared distances of the moved points from their planes.
class PlaneMotion {
public:
    /// `unit`: length scale of the data, by which distances from the centre are divided.
    PlaneMotion(const Eigen::Vector3d& centre, double unit) : centre_(centre), unit_(unit) {
        normal_.setZero();
        right_.setZero();
    }

    /// Adds a point and its plane. `off`: distance of the point below the plane, measured against the unit normal.
    void add(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double off, double weight = 1) {
        const Eigen::Vector3d arm = (point - centre_) / unit_;
        Row row;
        row << arm.cross(normal), normal, arm.dot(normal);
        normal_ += weight * row * row.transpose();
        right_ += weight * off / unit_ * row;
    }

    /// Parameters of a small motion about the centre.
    struct Step {
        Eigen::Vector3d rotation = Eigen::Vector3d::Zero();     ///< rotation axis times angle in radians
        Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< translation in the mesh's unit
        double growth = 0;                                      ///< natural logarithm of the scale
    };
    /// Computes the step of minimum error; `scaled`: true to estimate a scale too. `damping` (a fraction of the trace of the
    /// normal equations) suppresses motions that the planes do not determine (slippable motions of a sphere, a plane or a
    /// cylinder).
    [[nodiscard]] Step solve(double damping, bool scaled = false) const {
        const int n = scaled ? 7 : 6;
        Eigen::Matrix<double, 7, 7> damped = normal_;
        damped.diagonal().array() += damping * damped.topLeftCorner(n, n).trace() + 1e-30;
        const Eigen::VectorXd x = solve_ldlt<Eigen::Dynamic>(damped.topLeftCorner(n, n), right_.head(n));
        Step step;
        step.rotation = x.head<3>();
        step.translation = unit_ * x.segment<3>(3);
        if (scaled) step.growth = x[6];
        return step;
    }

    /// Converts a step to a motion.
    [[nodiscard]] Motion motion(const Step& step) const {
        Motion move;
        const double angle = step.rotation.norm();
        if (angle > 0) move.rotation = Eigen::AngleAxisd(angle, step.rotation / angle).toRotationMatrix();
        move.scale = std::exp(step.growth);
        move.translation = centre_ + step.translation - move.scale * (move.rotation * centre_);
        return move;
    }

private:
    using Row = Eigen::Matrix<double, 7, 1>;
    Eigen::Vector3d centre_;
    double unit_;
    Eigen::Matrix<double, 7, 7> normal_;
    Row right_;
};

/// A point that should be moved onto a plane.
struct PlanePoint {
    Eigen::Vector3d point, normal;  ///< the point; unit normal of the plane
    double off, weight;             ///< distance of the point below the plane, against the normal; weight
};

/// Size of one registration step: the larger of the rotation angle (radians) and the translation divided by the spread of the
/// points; nullopt if the spread or the sum of the weights is 0.
using StepLength = std::optional<double>;

/// Updates a rigid pose by one point-to-plane step about the weighted centroid of the points. The damping is a thousandth of the
/// mean eigenvalue of the normal equations.
inline StepLength step_onto_planes(const std::vector<PlanePoint>& points, Motion& pose) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double total = 0, unit = 0;
    for (const PlanePoint& one : points) centre += one.weight * one.point, total += one.weight;
    if (!(total > 0)) return std::nullopt;
    centre /= total;
    for (const PlanePoint& one : points) unit += one.weight / total * (one.point - centre).squaredNorm();
    unit = std::sqrt(unit);
    if (!(unit > 0)) return std::nullopt;
    PlaneMotion system(centre, unit);
    for (const PlanePoint& one : points) system.add(one.point, one.normal, one.off, one.weight);
    const PlaneMotion::Step move = system.solve(1e-3 / 6);
    pose = system.motion(move).after(pose);
    pose.rotation = Eigen::Quaterniond(pose.rotation).normalized().toRotationMatrix();
    return std::max(move.rotation.norm(), move.translation.norm() / unit);
}

}  // namespace ostraka
