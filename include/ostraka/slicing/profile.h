// The profile of a turned object, as drawings of pottery show it.
#pragma once

#include "ostraka/slicing/slice.h"

#include <limits>

namespace ostraka {

/// In the plane of the section: x across the axis, y along it from the object's lowest place on; x = 0 is the axis.
struct Profile {
    SliceFrame frame;                                   ///< of that plane, at height 0
    double angle = 0;                                   ///< of the half plane x <= 0, radians from the axis frame's u on
    Slice section;                                      ///< the mesh cut by the plane
    std::vector<std::vector<Eigen::Vector2d>> outline;  ///< of the whole object, seen across the plane (see silhouette.h)
    double low = 0, high = 0;                           ///< heights of the object
    struct Edge {
        double height, radius;
    };
    std::vector<Edge> edges;  ///< where the outer profile of a turned object breaks by more than 25 degrees
    bool turned = false;      ///< half of 24 slices close and have a relative roundness (fitted circle) below 0.05
    int open = 0;             ///< of these slices: how many have their longer part in open contours, which are not round
    double view_angle = 0;    ///< of the direction that lies to the right in the outline, radians
    double rim_diameter = 0;  ///< largest diameter of the circles that fit slices in the uppermost 3 % of the height best, of
                              ///< those with a relative roundness below 0.1 and a mouth (a hole, open contours, a border of the
                              ///< mesh), or that open contours about the axis tell to a tenth; 0 if there is none
    double rim_share = 1;     ///< of that circle's turn that is there
    double rim_low = 0, rim_high = 0;  ///< of open contours: 95 % interval of the rim's diameter
    /// Points of the section's outer side, half a per cent of the height apart: how far it reaches from the axis, from `low` on.
    std::vector<double> extent;
    bool hides = false;  ///< something of a turned object stands out by more than 5 % of its height and is not seen to

    /// The extent at a height, the largest of its neighbourhood; 0 outside.
    [[nodiscard]] double reach_at(double height) const;
};

/// `axis` has its normal along the object's axis and its origin on it. The section goes along `angle` (radians from u,
/// counter-clockwise seen from above); where that is NaN, along the one of 36 directions whose half section, among those without
/// open contours, has the median area, so that neither a handle nor a spout is cut (the median of the open lengths, if none is
/// complete). Of a turned object the outline is that seen with what stands out farthest from the section's outer side to the
/// right, so that a handle shows, beside the wall or above it; of others it is that of the section's plane. Errors as slice_mesh.
Profile find_profile(const Mesh& mesh, const SliceFrame& axis, double angle = std::numeric_limits<double>::quiet_NaN());

}  // namespace ostraka
