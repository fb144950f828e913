// Profile of a vessel for pottery drawings.
#pragma once

#include "ostraka/slicing/slice.h"

#include <limits>

namespace ostraka {

/// Section and outline of a vessel, in the section plane: x is across the axis, y along the axis from the lowest point of the
/// object; the axis is x = 0.
struct Profile {
    SliceFrame frame;  ///< coordinate system of the section plane, at height 0
    double angle = 0;  ///< direction of the half plane x <= 0, radians counter-clockwise from u of the axis frame
    Slice section;     ///< section of the mesh by the plane
    /// Outline of the whole object, viewed across the plane (see silhouette.h).
    std::vector<std::vector<Eigen::Vector2d>> outline;
    double low = 0, high = 0;  ///< lowest and highest height of the object
    /// A bend of the outer profile.
    struct Edge {
        double height, radius;  ///< position of the bend: height, and distance from the axis
    };
    std::vector<Edge> edges;  ///< places where the outer profile of a surface of revolution bends by more than 25 degrees
    /// True: the object is a surface of revolution: half of 24 slices are closed and have a relative roundness (fitted circle)
    /// below 0.05.
    bool turned = false;
    /// Number of the 24 slices whose open contours, which have no roundness, are longer than their closed contours.
    int open = 0;
    double view_angle = 0;  ///< direction that points right in the outline, radians counter-clockwise from u of the axis frame
    /// Diameter of the rim: the largest diameter of the circles fitted to slices in the top 3 % of the height, among slices with
    /// relative roundness below 0.1 and a mouth (a hole, open contours, a border of the mesh), and slices whose open contours
    /// around the axis determine the diameter to a tenth; 0 if there is no such slice.
    double rim_diameter = 0;
    double rim_share = 1;              ///< preserved share of the rim circle, 0 to 1
    double rim_low = 0, rim_high = 0;  ///< for open contours: bounds of the 95 % confidence interval of the rim diameter
    /// Distance of the section's outer side from the axis, sampled upwards from `low` at half a per cent of the height.
    std::vector<double> extent;
    /// True: a part that protrudes from a surface of revolution by more than 5 % of the height is not visible in the view.
    bool hides = false;

    /// The extent at a height, as the maximum over the neighbouring samples; 0 outside the height range.
    [[nodiscard]] double reach_at(double height) const;
};

/// Profile of a vessel. `axis` has its normal along the object's axis and its origin on the axis. The section is taken at `angle`
/// (radians from u, counter-clockwise seen from above). If `angle` is NaN, it is chosen from 36 directions: the direction whose
/// half section has the median area among the half sections without open contours, so that neither a handle nor a spout is cut
/// (the median open length, if no half section is complete). The outline of a surface of revolution is viewed so that the part
/// that protrudes farthest from the section's outer side points right, so that a handle is visible beside or above the wall; the
/// outline of other objects is viewed across the section plane. Throws the errors of slice_mesh.
Profile find_profile(const Mesh& mesh, const SliceFrame& axis, double angle = std::numeric_limits<double>::quiet_NaN());

}  // namespace ostraka
