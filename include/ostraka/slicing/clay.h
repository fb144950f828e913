// How much clay an object holds when its inside was seen in part, or not at all.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/slicing/slice.h"

#include <limits>

namespace ostraka {

struct ClayOptions {
    int slices = 400;
    double wall = 0;

    void describe(OptionList& visit);
};

/// Volumes in the mesh's unit cubed. NaN: not known.
struct ClayVolume {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double maximum = 0;        ///< what is not seen is clay; unknown if no slice has an outline
    double minimum = unknown;  ///< what is not seen is hollow but for a wall; unknown if no wall is seen or given
    double envelope = 0;       ///< within the outer surface, cavities filled; unknown where contours cross
    double wall = unknown;     ///< that `minimum` goes by, in the mesh's unit
    /// The wall where both its sides are seen: mean of the slices' means; of their least and of their largest distances of its
    /// sides the 5 and the 95 % quantile, since a plane that grazes a floor or a rim tells nothing of a wall.
    double wall_mean = unknown, wall_min = unknown, wall_max = unknown;
    int slices = 0;           ///< that meet the object
    int with_cavity = 0;      ///< of them, those with a hole all of whose outline is seen
    int without_outline = 0;  ///< of them, those whose outer contours are all open: taken as between their neighbours for
                              ///< `maximum` and `envelope`, as nothing for `minimum`
    int crossing = 0;  ///< of them, those whose contours cross so that they have no area: `maximum` takes all of them one by one,
                       ///< or their convex hull if that is less; nothing for `minimum`
    int turned = 0;    ///< of them, those with contours that were read against their orientation
    bool reversed = false;  ///< the mesh is closed and inside out, and was read the other way round
};

/// Sums over slices (middles of layers of equal height). In a slice whose cavity is seen the material's area counts. Elsewhere
/// each outer contour of area A may hide a cavity: between its A and A - pi (r - t)^2 of clay, r the radius of the circle of area
/// A and t the wall: by the inequality of Brunn and Minkowski no contour with a wall of t or more all around holds less, and a
/// disc holds just that. What lies within t of the lowest and of the highest place is wall. t is `wall_min` if none is given.
/// Contours within others and open ones count for nothing. Error of the sum: second order in the height of a layer, away from
/// flat tops. Throws as `slice_mesh`, and Error (usage) for options.
ClayVolume clay_volume(const Mesh& mesh, const SliceFrame& frame, const ClayOptions& options = {});

}  // namespace ostraka
