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

    template <class Visitor>
    void describe(Visitor& visit) {
        visit("slices", slices, "layers that the object is cut into", Range{2, 1000000});
        visit("wall", wall,
              "least wall that the clay is taken to have where it is not seen, in the mesh's unit; 0: the thinnest that is seen",
              Range{0, 1e60});
    }
};

/// Volumes in the mesh's unit cubed. NaN: not known.
struct ClayVolume {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double most = 0;         ///< what is not seen is clay
    double least = unknown;  ///< what is not seen is hollow but for a wall; unknown if no wall is seen or given
    double envelope = 0;     ///< within the outer surface, cavities filled
    double wall = unknown;   ///< that `least` goes by, in the mesh's unit
    /// The wall where both its sides are seen: mean over slices, their least and largest mean; the mesh's unit.
    double wall_mean = unknown, wall_least = unknown, wall_most = unknown;
    int slices = 0;           ///< that meet the object
    int with_cavity = 0;      ///< of them, those with a hole all of whose outline is seen
    int without_outline = 0;  ///< of them, those whose outer contours are all open: taken as between their neighbours for `most`
                              ///< and `envelope`, as nothing for `least`
};

/// Sums over slices (middles of layers of equal height). In a slice whose cavity is seen the material's area counts. Elsewhere
/// each outer contour of area A and perimeter P may hide a cavity: between its A and min(A, P t - pi t^2) of clay, t the wall: by
/// Steiner's formula no convex contour with a wall of t or more all around has less; A where t is not below 2 A / P. t is the
/// least mean wall over slices with a cavity, if none is given. Contours within others and open ones count for nothing. Error of
/// the sum: second order in the height of a layer, away from flat tops. Throws as `slice_mesh`, and Error (usage) for options.
ClayVolume clay_volume(const Mesh& mesh, const SliceFrame& frame, const ClayOptions& options = {});

}  // namespace ostraka
