// Profile of a vessel for pottery drawings.
#pragma once

#include "ostraka/slicing/slice.h"

#include <limits>

namespace ostraka {

/// Section and outline of a vessel in the section plane. x is the distance from the axis (negative to the left), y the height
/// along the axis above the lowest point of the object.
struct Profile {
    SliceFrame frame;  ///< coordinate system of the section plane, at height 0
    double angle = 0;  ///< direction of the drawn half plane x <= 0, in radians counter-clockwise from u of the axis frame
    Slice section;     ///< section of the mesh by the plane
    /// Outline of the whole object, viewed across the plane (see silhouette.h).
    std::vector<std::vector<Eigen::Vector2d>> outline;
    double low = 0, high = 0;  ///< lowest and highest height of the object
    /// A bend of the outer profile.
    struct Edge {
        double height, radius;  ///< position of the bend: height, and distance from the axis
    };
    std::vector<Edge> edges;  ///< points where the outer profile of a surface of revolution bends by more than 25 degrees
    /// True: the object is a surface of revolution. The criterion: at least half of 24 slices are closed and deviate from their
    /// fitted circle by less than 0.05 of the radius in the mean (relative roundness).
    bool is_revolved = false;
    /// Number of the 24 slices whose open contours are longer than their closed contours; the roundness of open contours is
    /// unknown.
    int open = 0;
    /// Direction that points to the right in the view of the outline, in radians counter-clockwise from u of the axis frame.
    double view_angle = 0;
    /// Diameter of the rim: the largest diameter of the circles fitted to slices in the top 3 % of the height. A slice is used
    /// if its relative roundness is below 0.1 and it shows a mouth (a hole, open contours or a border of the mesh), or if its
    /// open contours around the axis determine the diameter to a tenth. 0 if there is no such slice.
    double rim_diameter = 0;
    double rim_share = 1;              ///< preserved share of the rim circle, 0 to 1
    double rim_low = 0, rim_high = 0;  ///< for open contours: bounds of the 95 % confidence interval of the rim diameter
    /// Distance of the outer side of the section from the axis, sampled from `low` upwards at steps of half a per cent of the
    /// height.
    std::vector<double> extent;
    /// True: a part that protrudes from a surface of revolution by more than 5 % of the height is hidden in the view of the
    /// outline.
    bool hides = false;

    /// The value of `extent` at a height: the maximum of the neighbouring samples; 0 outside the height range.
    [[nodiscard]] double extent_at(double height) const;
};

/// Profile of a vessel. `axis` has its normal along the object's axis and its origin on the axis. The section is taken at `angle`
/// (radians from u, counter-clockwise seen from above). If `angle` is NaN, one of 36 directions is chosen: among the half
/// sections without open contours, the one with the median area, so that the plane cuts neither a handle nor a spout (if all
/// half sections have open contours, the one with the median open length). The view of a surface of revolution is rotated so
/// that the part that protrudes farthest from the outer side of the section, such as a handle, points to the right. Other
/// objects are viewed perpendicular to the section plane. Throws the errors of slice_mesh.
Profile find_profile(const Mesh& mesh, const SliceFrame& axis, double angle = std::numeric_limits<double>::quiet_NaN());

}  // namespace ostraka
