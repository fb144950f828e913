// Implicit solids, given by signed functions with gradients; synthetic objects are built from them.
#pragma once

#include <Eigen/Geometry>

#include <memory>
#include <vector>

namespace ostraka {

/// Value (negative inside) and gradient of an implicit function at a point.
struct Sample {
    double value = 0;                                    ///< negative inside, zero on the surface
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< gradient of the implicit function
};

/// A closed solid given by a function with Lipschitz constant 1 that is zero on the surface of the solid.
class Solid {
public:
    Solid() = default;
    virtual ~Solid() = default;
    Solid(const Solid&) = delete;
    Solid& operator=(const Solid&) = delete;

    [[nodiscard]] virtual Sample sample(const Eigen::Vector3d& p) const = 0;  ///< value and gradient of the function at p
    /// Position of `p` along the generating curve of the solid (tubes, solids of revolution), as a length; 0 for other solids.
    [[nodiscard]] virtual double parameter(const Eigen::Vector3d&) const { return 0; }
    /// Bounding box of the solid.
    [[nodiscard]] virtual Eigen::AlignedBox3d box() const = 0;
    /// Lower bound, outside the solid, of the ratio of the function's value to the distance from the solid (1 for true
    /// distances).
    [[nodiscard]] virtual double flatness() const { return 1; }
};
using SolidPointer = std::unique_ptr<const Solid>;

/// Pose of a solid: rotation of its own coordinate system, then translation to `centre`.
struct SolidPose {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
};

/// An ellipsoid. Value of the function: (|p / radii| - 1) times the smallest radius.
SolidPointer make_ellipsoid(const SolidPose& pose, const Eigen::Vector3d& radii);

/// A box with edges and corners rounded by balls of radius `rounding` (at most the smallest half extent).
SolidPointer make_box(const SolidPose& pose, const Eigen::Vector3d& half_extents, double rounding);

/// An upright cylinder with rounded rims.
SolidPointer make_cylinder(const SolidPose& pose, double radius, double half_height, double rounding);

/// A torus around the vertical axis.
SolidPointer make_torus(const SolidPose& pose, double ring_radius, double tube_radius);

/// A ball on the path of a tube.
struct Bead {
    Eigen::Vector3d centre;
    double radius;
};
/// A tube: union of the balls along the cubic spline through the beads (at least two). Value of the function: min over t of |p -
/// c(t)| - r(t), exact outside. `parameter` is the chord length along the path up to the ball that attains the minimum.
SolidPointer make_tube(const std::vector<Bead>& beads);
/// For each bead, the chord length from the first bead: the parameter of the bead on a tube.
std::vector<double> chord_lengths(const std::vector<Bead>& beads);

/// A solid of revolution around the vertical axis. The profile is the cubic spline through points (distance from the axis,
/// height). The profile starts on the axis at the bottom, runs upwards along the outside and ends on the axis, and it meets the
/// axis at right angles. Value of the function: true signed distance.
SolidPointer make_revolved(const SolidPose& pose, const std::vector<Eigen::Vector2d>& profile);
/// For each point of a profile, the chord length from the first point.
std::vector<double> chord_lengths(const std::vector<Eigen::Vector2d>& profile);

}  // namespace ostraka
