// Profile of a vessel for pottery drawings.
#pragma once

#include "ostraka/slicing/slice.h"

#include <limits>

namespace ostraka {

/// Coordinates in the section plane: x across the axis, y along it from the lowest point of the object; the axis is x = 0.
struct Profile {
    SliceFrame frame;  ///< frame of the section plane, at height 0
    double angle = 0;  ///< direction of the half plane x <= 0, radians from u of the axis frame
    Slice section;     ///< section of the mesh by the plane
    /// Outline of the whole object, viewed across the plane (see silhouette.h).
    std::vector<std::vector<Eigen::Vector2d>> outline;
    double low = 0, high = 0;  ///< height range of the object
    struct Edge {
        double height, radius;
    };
    std::vector<Edge> edges;  ///< where the outer profile of a surface of revolution bends by more than 25 degrees
    /// Surface of revolution: half of 24 slices are closed with relative roundness (fitted circle) below 0.05.
    bool turned = false;
    int open = 0;  ///< number of these slices whose open contours, which have no roundness, are longer than the closed ones
    double view_angle = 0;  ///< direction that points right in the outline, radians
    /// Diameter of the rim: the largest diameter of the circles fitted to slices in the top 3 % of the height, among those with
    /// relative roundness below 0.1 and a mouth (a hole, open contours, a border of the mesh), and those whose open contours
    /// around the axis determine the diameter to a tenth; 0 if there is none.
    double rim_diameter = 0;
    double rim_share = 1;              ///< preserved fraction of the rim circle
    double rim_low = 0, rim_high = 0;  ///< for open contours: 95 % confidence interval of the rim diameter
    /// Distance of the section's outer side from the axis, sampled upwards from `low` at half a per cent of the height.
    std::vector<double> extent;
    /// A part of a surface of revolution protrudes by more than 5 % of its height and is not visible in the view.
    bool hides = false;

    /// The extent at a height, the maximum over its neighbourhood; 0 outside.
    [[nodiscard]] double reach_at(double height) const;
};

/// `axis` has its normal along the object's axis and its origin on it. The section is taken at `angle` (radians from u,
/// counter-clockwise seen from above). If that is NaN, it is the one of 36 directions whose half section has the median area
/// among those without open contours, so that neither a handle nor a spout is cut (the median open length, if none is
/// complete). The outline of a surface of revolution is viewed so that the part that protrudes farthest from the section's
/// outer side points right, so that a handle is visible beside or above the wall; the outline of other objects is viewed across
/// the section plane. Throws the errors of slice_mesh.
Profile find_profile(const Mesh& mesh, const SliceFrame& axis, double angle = std::numeric_limits<double>::quiet_NaN());

}  // namespace ostraka
