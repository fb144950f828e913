// Bounds of the clay volume of an object whose inside was scanned only in part, or not at all.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"
#include "ostraka/slicing/slice.h"

#include <limits>

namespace ostraka {

struct ClayOptions {
    int slices = 400;  ///< number of layers
    /// Min wall thickness where the inside is not visible, in the mesh's unit; 0: derived from the visible walls.
    double wall = 0;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Volumes in the cubed unit of the mesh. NaN: unknown.
struct ClayVolume {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();  ///< value of unknown volumes and lengths (NaN)
    /// Volume under the assumption that regions that were not scanned are solid clay; unknown if no slice has an outline.
    double maximum = 0;
    /// Volume under the assumption that regions that were not scanned are hollow except for a wall; unknown if no wall
    /// thickness is visible or given.
    double minimum = unknown;
    double envelope = 0;    ///< volume within the outer surface, including cavities; unknown where contours cross
    double wall = unknown;  ///< wall thickness with which `minimum` was computed, in the mesh's unit
    /// Wall thickness where both sides of the wall are visible: mean of the slices' mean thickness, 5 % quantile of the slices'
    /// minima, 95 % quantile of the slices' maxima. Quantiles are used because a plane that grazes a floor or a rim does not show
    /// the wall thickness.
    double wall_mean = unknown, wall_min = unknown, wall_max = unknown;
    int slices = 0;       ///< number of slices that intersect the object
    int with_cavity = 0;  ///< number of slices with a hole whose outline is completely visible
    /// Number of slices whose outer contours are all open; the areas of such slices are interpolated from their neighbours for
    /// `maximum` and `envelope`, and are zero for `minimum`.
    int without_outline = 0;
    /// Number of slices whose contours cross, so that areas are undefined; for `maximum` the smaller of the sum of all contours
    /// and of their convex hull is used; for `minimum` the area of such slices is zero.
    int crossing = 0;
    int reversed_slices = 0;  ///< number of slices with contours whose orientation was reversed
    bool reversed = false;    ///< true: the given mesh was closed and inside out, and its orientation was reversed
};

/// Sums the areas of slices, which are the mid-planes of layers of equal height. In a slice whose cavity is visible, the area
/// is the area of the material. In other slices each outer contour of area A may hide a cavity. The area of clay is then
/// between A - pi (r - t)^2 and A, where r is the radius of the circle of area A and t is the wall thickness: by the
/// Brunn-Minkowski inequality a contour with a wall of at least t all around cannot contain less clay, and a disc attains the
/// bound. All material within t of the lowest and of the highest point is wall. If the options give no wall thickness, t is
/// `wall_min`. Nested and open contours are ignored. The error of the sum is of second order in the layer height, except at
/// flat tops. Throws the errors of `slice_mesh`, and Error (usage) for invalid options.
ClayVolume clay_volume(const Mesh& mesh, const SliceFrame& frame, const ClayOptions& options = {});

}  // namespace ostraka
