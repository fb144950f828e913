// Objects cut into slices along their axes, and the axes that slices are compared with.
#pragma once

#include "ostraka/axis/axis.h"
#include "ostraka/slicing/cut_object.h"

namespace ostraka {

struct CutOptions {
    /// None: across `up`; else across the axis that this method finds, which points upwards as far as it does at all, or across
    /// the curve of the skeleton.
    std::optional<AxisMethod> direction;
    Vector up{0, 0, 1};
    SlicePlaces places;  ///< across a curve its count alone
    AxisOptions axis;
};

/// Cuts the mesh, or the given faces of it, along its own axis; heights are those over its lowest place. Where the object has no
/// such axis the result has a reason and no slices. Throws Error (input) for a mesh without surface or one that find_axis cannot
/// take, and as slice_mesh.
CutObject cut_object(const Mesh& mesh, const std::vector<Index>& faces, const CutOptions& options = {});

/// An axis that the barycentres of slices are compared with.
struct ComparedAxis {
    std::string name;
    std::string reason;  ///< why there is none; empty: it was found
    SliceLine line;
    std::vector<Point> polyline;  ///< of a bent one
    Straightness straightness;
};

/// The mean of the barycentres along the normal (of parallel slices), their regression, and the curve that was cut across; with
/// `by_shape` also what `find_axis` finds: rotation, principal, slices, skeleton. None for fewer than two barycentres.
std::vector<ComparedAxis> compared_axes(const Mesh& mesh, const std::vector<Index>& faces, const CutObject& cut, bool by_shape,
                                        const AxisOptions& options = {});

}  // namespace ostraka
