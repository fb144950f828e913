// Descriptors of a slice (thesis, sections 3.2 and 3.2.1, with the corrected hole-area ratio).
//
// Descriptors are computed from closed contours only; an open contour encloses no area and is never closed by a straight line.
// Descriptors that need an area are absent (NaN) in a slice without a closed outer contour; if the slice also has open
// contours, `Completeness` gives the missing fraction. Only the fitted circle is also computed for open contours, with a
// confidence interval of its radius. The roundness of open contours is not computed, because the missing part need not be
// round. The material of a slice is the inside of the outer contours without their holes. The outline of a slice consists of
// the outermost contours, filled. Circles are compared with the largest outermost contour, the main outline, so that handles
// and arms beside the body are ignored. If contours intersect (a self-intersecting mesh) by more than `max_doubtful`, only the
// hull, the values derived from the hull, and the lengths of closed and open contours are present. Integrals along contours are
// with respect to arc length, so that the subdivision of segments does not change them.
#pragma once

#include "ostraka/slicing/slice.h"

#include <limits>

namespace ostraka {

/// Descriptors of one slice; NaN: absent.
struct SliceDescriptors {
    static constexpr double absent = std::numeric_limits<double>::quiet_NaN();  ///< value of absent descriptors (NaN)

    double area = absent;                                ///< A, area of the material; unit squared
    double perimeter = absent;                           ///< P, length of the material's boundary including holes; unit
    double hole_area = absent;                           ///< A_H, area of all holes; unit squared
    Eigen::Vector2d barycentre{absent, absent};          ///< barycentre of the material, in the coordinates of the slice; unit
    double outline_area = absent;                        ///< area of the outermost contours, filled; unit squared
    double outline_perimeter = absent;                   ///< length of the outermost contours; unit
    Eigen::Vector2d outline_barycentre{absent, absent};  ///< barycentre of the outermost contours, filled; unit

    /// M >= m: sides of the minimum-area bounding rectangle (MBR) of the outline; unit.
    double box_length = absent, box_breadth = absent;
    double elongation = absent;    ///< 1 - m / M: 0 for a square, towards 1 for a long shape
    double eccentricity = absent;  ///< m / M (thesis, 3.2.1: the ratio of the MBR's axes)
    double solidity = absent;      ///< A / A_CH, where A_CH is the area of the convex hull
    double compactness = absent;   ///< 4 pi A / P^2: 1 only for a disc without holes
    /// Mean over the main outline of (|p - c| - r)^2 / r^2; c is the barycentre of the main outline, pi r^2 its area.
    double circular_variance = absent;
    /// Mean squared distance of the outline from the sides of the MBR, divided by (M m / pi).
    double rectangular_variance = absent;

    /// True: `components`, `holes` and `euler_number` are known; false: contours intersect, and these numbers are 0.
    bool counted = true;
    int components = 0, holes = 0;    ///< number of components, and of holes
    int euler_number = 0;             ///< components - holes
    double hole_area_ratio = absent;  ///< A_H / (A + A_H)

    /// R, radius of the circle around the main outline's barycentre with the main outline's area; unit.
    double equivalent_radius = absent;
    double roundness_equivalent = absent;           ///< mean over the main outline of ||p - c| - R|; unit (thesis, 3.2)
    double roundness_equivalent_relative = absent;  ///< roundness_equivalent / R

    /// Radius of the least squares circle of the main outline or, if they are longer, of all open contours that run
    /// counter-clockwise around their fitted circle. For open contours the radius is given only if they lie on a circle
    /// (`ArcFit::is_round`).
    double fitted_radius = absent;
    /// For open contours: 95 % confidence interval of the radius (`fit_arc`); the upper end is absent if a straight line fits
    /// too.
    double fitted_radius_low = absent, fitted_radius_high = absent;
    Eigen::Vector2d fitted_centre{absent, absent};  ///< centre of the least squares circle, in the coordinates of the slice; unit
    double roundness_fitted = absent;  ///< mean distance of the main outline from the least squares circle; unit (thesis, 3.2.1)
    double roundness_fitted_relative = absent;  ///< roundness_fitted / fitted radius

    /// Wall thickness: distance from the outer contours that have holes to the nearest point of these holes; mean and variance
    /// over the length of the outer contours. Absent without holes.
    double thickness_mean = absent;                         ///< mean wall thickness; unit
    double thickness_variance = absent;                     ///< variance of the wall thickness; unit squared
    double thickness_min = absent, thickness_max = absent;  ///< smallest and largest wall thickness; unit

    double closed_length = 0, open_length = 0;  ///< total length of the closed and of the open contours; unit
};

/// A descriptor with its name and unit, for tables and files.
struct NamedDescriptor {
    const char* name;  ///< name of the member of SliceDescriptors; barycentres as barycentre_x, barycentre_y
    const char* unit;  ///< "length", "area", or empty for a dimensionless value
    double value;      ///< NaN: absent
};
/// All descriptors of a slice, in the order in which SliceDescriptors declares them.
std::vector<NamedDescriptor> list_descriptors(const SliceDescriptors& descriptors);

/// Computes the descriptors of a slice. Time: linear in the number of segments, except for sorting (hull) and searching
/// (thickness). Thickness is integrated by two-point Gauss quadrature on intervals of at most 1/500 of the contour; all other
/// values are exact or accurate to about 1e-12.
SliceDescriptors describe_slice(const Slice& slice);
/// The descriptors of all slices, in parallel.
std::vector<SliceDescriptors> describe_slices(const std::vector<Slice>& slices);

/// Wall thickness around the slice: for `directions` directions, evenly spaced counter-clockwise from u, the length of material
/// on the ray from the barycentre of the largest hole of the largest component; NaN if the ray meets no material. Empty for a
/// slice without holes.
std::vector<double> thickness_profile(const Slice& slice, int directions = 72);

}  // namespace ostraka
