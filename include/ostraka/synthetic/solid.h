// Implicit solids: signed values with gradients, from which synthetic objects are built.
#pragma once

#include <Eigen/Geometry>

#include <memory>
#include <vector>

namespace ostraka {

/// Value (negative inside) and gradient of an implicit function at a point.
struct Sample {
    double value = 0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
};

/// A closed solid given by a function with Lipschitz constant 1 that is zero on its surface.
class Solid {
public:
    Solid() = default;
    virtual ~Solid() = default;
    Solid(const Solid&) = delete;
    Solid& operator=(const Solid&) = delete;

    [[nodiscard]] virtual Sample sample(const Eigen::Vector3d& p) const = 0;
    /// Position of `p` along the generating curve of the solid (tubes, solids of revolution), in units of length; 0 for others.
    [[nodiscard]] virtual double parameter(const Eigen::Vector3d&) const { return 0; }
    /// Bounding box of the solid.
    [[nodiscard]] virtual Eigen::AlignedBox3d box() const = 0;
    /// Outside, the value is at least this fraction of the distance to the solid (1 for true distances).
    [[nodiscard]] virtual double flatness() const { return 1; }
};
using SolidPointer = std::unique_ptr<const Solid>;

/// Pose of a solid: rotation of its own frame, then translation.
struct SolidPose {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
};

/// Value: (|p / radii| - 1) times the smallest radius.
SolidPointer make_ellipsoid(const SolidPose& pose, const Eigen::Vector3d& radii);

/// Box with edges and corners rounded by balls of radius `rounding` (at most the smallest half extent).
SolidPointer make_box(const SolidPose& pose, const Eigen::Vector3d& half_extents, double rounding);

/// Upright cylinder with rounded rims.
SolidPointer make_cylinder(const SolidPose& pose, double radius, double half_height, double rounding);

/// Torus around the vertical axis.
SolidPointer make_torus(const SolidPose& pose, double ring_radius, double tube_radius);

/// A ball on a path.
struct Bead {
    Eigen::Vector3d centre;
    double radius;
};
/// Union of the balls along the cubic spline through the beads (at least two): min over t of |p - c(t)| - r(t), exact outside.
/// `parameter` is the chord length up to the touching ball.
SolidPointer make_tube(const std::vector<Bead>& beads);
/// Chord length from the first bead to each bead: the parameters of the beads on a tube.
std::vector<double> chord_lengths(const std::vector<Bead>& beads);

/// Solid of revolution around the vertical axis. The profile is the cubic spline through points (distance from the axis,
/// height), from the axis at the bottom upwards along the outside back to the axis, which it meets at right angles. True signed
/// distance.
SolidPointer make_revolved(const SolidPose& pose, const std::vector<Eigen::Vector2d>& profile);
std::vector<double> chord_lengths(const std::vector<Eigen::Vector2d>& profile);

}  // namespace ostraka
