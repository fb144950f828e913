// Numbers that describe a slice (thesis, sections 3.2 and 3.2.1, with the hole-area ratio as corrected).
//
// They are of the closed contours only: an open contour bounds nothing and is never closed by a straight line. What needs an area
// is absent (NaN) in a slice without a closed outer contour; where open contours are there besides, `Completeness` says how much
// is missing. Only the fitted circle may be one of open
// contours, with the interval within which they tell its radius; they have no roundness, since what is not there need not be
// round. The shape is the material: outer contours without their holes.
// Its outline are the outermost contours, with what is in them filled; circles are compared with the largest of these, the main
// outline, so that handles and arms beside the body do not count. Where contours cross (a mesh that passes through itself) by
// more than `max_doubtful`, only the hull and what is made of it, and the lengths of closed and open contours, are there.
// Integrals along contours go by length, so that cutting their pieces in two changes nothing.
#pragma once

#include "ostraka/slicing/slice.h"

#include <limits>

namespace ostraka {

struct SliceDescriptors {
    static constexpr double absent = std::numeric_limits<double>::quiet_NaN();

    double area = absent;                        ///< A, of the material; unit squared
    double perimeter = absent;                   ///< P, length of its whole boundary, holes too; unit
    double hole_area = absent;                   ///< A_H, of all holes; unit squared
    Eigen::Vector2d barycentre{absent, absent};  ///< of the material, in the frame; unit
    double outline_area = absent;                ///< of the outermost contours, filled; unit squared
    double outline_perimeter = absent;           ///< their length; unit
    Eigen::Vector2d outline_barycentre{absent, absent};

    double box_length = absent,
           box_breadth = absent;   ///< M >= m: sides of the smallest rectangle (by area, MBR) around the outline
    double elongation = absent;    ///< 1 - m / M: 0 square, to 1 long
    double eccentricity = absent;  ///< m / M (thesis, 3.2.1: the ratio between the axes of the MBR)
    double solidity = absent;      ///< A / A_CH, A_CH the area of the convex hull
    double compactness = absent;   ///< 4 pi A / P^2: 1 for a disc only; a disc with a hole has less
    double circular_variance =
        absent;  ///< mean of (|p - c| - r)^2 over the main outline / r^2; c its barycentre, pi r^2 its area
    double rectangular_variance = absent;  ///< mean squared distance of the outline to the rectangle's sides / (M m / pi)

    bool counted = true;  ///< whether the next three are known; they are 0 where contours cross
    int components = 0, holes = 0;
    int euler_number = 0;             ///< components - holes
    double hole_area_ratio = absent;  ///< A_H / (A + A_H)

    double equivalent_radius = absent;              ///< r of the circle around the main outline's barycentre with its area; unit
    double roundness_equivalent = absent;           ///< mean of ||p - c| - r| over the main outline; unit (thesis, 3.2)
    double roundness_equivalent_relative = absent;  ///< that / r

    /// The circle of least mean squared distance from the main outline, or from all open contours that run counter-clockwise
    /// around their own circle, whichever is longer; of open ones only if they run along a circle (`ArcFit::is_round`).
    double fitted_radius = absent;
    /// Of open contours: 95 % interval of the radius (`fit_arc`); the upper end absent where a straight line fits too.
    double fitted_radius_low = absent, fitted_radius_high = absent;
    Eigen::Vector2d fitted_centre{absent, absent};
    double roundness_fitted = absent;           ///< of the main outline: mean distance from it; unit (thesis, 3.2.1)
    double roundness_fitted_relative = absent;  ///< that / its radius

    /// Wall thickness: the distance from the outer contours that have holes to the nearest point of those, mean over the outer
    /// contours' length. Absent without holes.
    double thickness_mean = absent;      ///< unit
    double thickness_variance = absent;  ///< unit squared
    double thickness_min = absent, thickness_max = absent;

    double closed_length = 0, open_length = 0;  ///< of closed and of open contours; unit
};

/// A descriptor by its name, for tables and files.
struct NamedDescriptor {
    const char* name;  ///< as in the structure; barycentres as barycentre_x, barycentre_y
    const char* unit;  ///< "length", "area", or empty for a number without unit
    double value;      ///< NaN: absent
};
std::vector<NamedDescriptor> list_descriptors(const SliceDescriptors& descriptors);

/// Linear in the number of pieces but for sorting (hull) and searching (thickness). Thickness is integrated by Gauss quadrature
/// with two points on pieces of at most 1/500 of the contour, all else exactly or to about 1e-12.
SliceDescriptors describe_slice(const Slice& slice);
/// Of all slices, in parallel.
std::vector<SliceDescriptors> describe_slices(const std::vector<Slice>& slices);

/// Wall thickness around the slice: for `directions` directions, evenly spread from u on counter-clockwise, the length of
/// material on the ray from the barycentre of the largest hole of the largest component; NaN where the ray meets none. Empty
/// without holes.
std::vector<double> thickness_profile(const Slice& slice, int directions = 72);

}  // namespace ostraka
