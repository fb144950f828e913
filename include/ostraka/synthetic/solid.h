// Implicit solids: signed values with gradients, of which synthetic objects are built.
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

/// A closed solid given by a function that changes by at most 1 per unit of length and is zero on its surface.
class Solid {
public:
    Solid() = default;
    virtual ~Solid() = default;
    Solid(const Solid&) = delete;
    Solid& operator=(const Solid&) = delete;

    [[nodiscard]] virtual Sample sample(const Eigen::Vector3d& p) const = 0;
    /// Where `p` stands along the curve that makes the solid (tubes, lathes), in units of length; 0 for others.
    [[nodiscard]] virtual double parameter(const Eigen::Vector3d&) const { return 0; }
    /// Box that holds the solid.
    [[nodiscard]] virtual Eigen::AlignedBox3d box() const = 0;
    /// Outside, the value is at least this share of the distance to the solid (1 for true distances).
    [[nodiscard]] virtual double flatness() const { return 1; }
};
using SolidPointer = std::unique_ptr<const Solid>;

/// Where a solid stands: its own frame is turned, then moved.
struct SolidPose {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
};

/// Value: (|p / radii| - 1) times the smallest radius.
SolidPointer make_ellipsoid(const SolidPose& pose, const Eigen::Vector3d& radii);

/// Box with edges and corners rounded by balls of radius `rounding` (at most the smallest half extent).
SolidPointer make_box(const SolidPose& pose, const Eigen::Vector3d& half_extents, double rounding);

/// Upright cylinder whose two rims are rounded.
SolidPointer make_cylinder(const SolidPose& pose, double radius, double half_height, double rounding);

/// Ring around the vertical axis.
SolidPointer make_torus(const SolidPose& pose, double ring_radius, double tube_radius);

/// A ball on a path.
struct Bead {
    Eigen::Vector3d centre;
    double radius;
};
/// Union of the balls that run along the cubic spline through the beads (at least two): min over t of |p - c(t)| - r(t),
/// hence exact outside. `parameter` is the chord length up to the touching ball's place.
SolidPointer make_tube(const std::vector<Bead>& beads);
/// Chord length from the first bead to each bead: the parameters at which a tube passes its beads.
std::vector<double> chord_lengths(const std::vector<Bead>& beads);

/// Solid of revolution around the vertical axis; the profile is the cubic spline through points (distance from the axis,
/// height), from the axis at the bottom, outside upward, to the axis again, which it meets at right angles. True signed distance.
SolidPointer make_revolved(const SolidPose& pose, const std::vector<Eigen::Vector2d>& profile);
std::vector<double> chord_lengths(const std::vector<Eigen::Vector2d>& profile);

}  // namespace ostraka
