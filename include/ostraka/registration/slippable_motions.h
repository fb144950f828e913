// Slippable motions of a surface: rigid motions along which it slides on itself (Gelfand and Guibas 2004).
#pragma once

#include "ostraka/geom/rigid_fit.h"

#include <string>
#include <vector>

namespace ostraka {

enum class SlippableKind {
    none,         ///< none: the shape determines its pose
    rotation,     ///< about a line: a surface of revolution
    translation,  ///< along a line: a prism
    helix,        ///< along and about a line together
    cylinder,     ///< along and about a line, independently
    sphere,       ///< about a point
    plane,        ///< in a plane and about its normal
    more          ///< more than any surface has: the data is too small or insufficient
};
std::string to_string(SlippableKind kind);

struct SlippableMotions {
    SlippableKind kind = SlippableKind::none;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< point of the line or the plane; centre of the sphere
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< direction of the line; normal of the plane
    double pitch = 0;                                      ///< pitch of a helix: translation per radian

    /// As text, such as "rotation about a line".
    [[nodiscard]] std::string text() const;
    /// Samples of the group: multiples from -1 to 1 of `radians` and `length` along each of its directions.
    struct Step {
        bool rotates = false;
        Motion motion;
        double amount = 0;  ///< radians if it rotates, else a length
    };
    [[nodiscard]] std::vector<std::vector<Step>> ways(double radians, double length, int steps) const;
    /// Whether the motion is in the group, up to an angle and a length (displacement of points within `size` of `around`).
    [[nodiscard]] bool contains(const Motion& motion, const Eigen::Vector3d& around, double angle, double length) const;
};

/// From points with unit normals: the rigid motions that move every point nearly in its tangent plane, i.e. with a root mean
/// square displacement along the normals of at most `tolerance` times that of the whole motion.
SlippableMotions slippable_motions_of(const std::vector<Eigen::Vector3d>& places, const std::vector<Eigen::Vector3d>& normals,
                                      double tolerance = 0.1);

}  // namespace ostraka
