// Slippable motions of a surface: rigid motions along which it slides on itself (Gelfand and Guibas 2004).
#pragma once

#include "ostraka/geom/rigid_fit.h"

#include <string>
#include <vector>

namespace ostraka {

/// Groups of rigid motions under which a surface slides on itself.
enum class SlippableKind {
    none,         ///< no motion: the shape determines its pose
    rotation,     ///< rotation about a line: a surface of revolution
    translation,  ///< translation along a line: a prism
    helix,        ///< coupled rotation about and translation along a line
    cylinder,     ///< independent rotation about and translation along a line
    sphere,       ///< rotation about a point
    plane,        ///< translation in a plane and rotation about its normal
    more          ///< more motions than a surface can have; there are too few data
};
std::string to_string(SlippableKind kind);

/// Group of slippable motions of a surface.
struct SlippableMotions {
    SlippableKind kind = SlippableKind::none;              ///< kind of the group
    Eigen::Vector3d point = Eigen::Vector3d::Zero();       ///< a point of the line or the plane; centre of the sphere
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< direction of the line; normal of the plane
    double pitch = 0;                                      ///< pitch of a helix: translation per radian

    /// Name of the group as text, such as "rotation about a line".
    [[nodiscard]] std::string text() const;
    /// One sampled motion of the group.
    struct Step {
        bool rotates = false;  ///< true: rotation; false: translation
        Motion motion;         ///< the sampled motion
        double amount = 0;     ///< angle in radians for a rotation, else a length
    };
    /// Samples motions of the group: for each of its independent motions, `steps` motions from -1 to 1 times `radians`
    /// (rotations) or `length` (translations).
    [[nodiscard]] std::vector<std::vector<Step>> sampled_motions(double radians, double length, int steps) const;
    /// True if a motion belongs to the group, up to a rotation by `angle` and a displacement of the point `around` by `length`.
    [[nodiscard]] bool contains(const Motion& motion, const Eigen::Vector3d& around, double angle, double length) const;
};

/// Slippable motions of points with unit normals: the rigid motions that move every point nearly in its tangent plane, i.e. with
/// a root mean square displacement along the normals of at most `tolerance` times the root mean square of the whole displacement.
SlippableMotions slippable_motions_of(const std::vector<Eigen::Vector3d>& places, const std::vector<Eigen::Vector3d>& normals,
                                      double tolerance = 0.1);

}  // namespace ostraka
