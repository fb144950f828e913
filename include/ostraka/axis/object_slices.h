// Slices objects along their axes, and finds the axes with which slices are compared.
#pragma once

#include "ostraka/axis/axis.h"
#include "ostraka/slicing/sliced_object.h"

namespace ostraka {

struct CutOptions {
    /// None: across `up`; otherwise across the axis found by this method, oriented upwards as far as possible, or across the
    /// curve of the skeleton.
    std::optional<AxisMethod> direction;
    Vector up{0, 0, 1};
    SliceHeights places;  ///< only the count applies across a curve
    AxisOptions axis;
};

/// Slices the mesh, or the given faces of it, along its own axis; heights are above its lowest point. If the object has no such
/// axis, the result has a reason and no slices. Throws Error (input) for a mesh without surface or one that find_axis rejects,
/// and as slice_mesh.
SlicedObject cut_object(const Mesh& mesh, const std::vector<Index>& faces, const CutOptions& options = {});

/// An axis with which the barycentres of slices are compared.
struct ComparedAxis {
    std::string name;
    std::string reason;  ///< why it does not exist; empty: it was found
    SliceLine line;
    std::vector<Point> polyline;  ///< course of a curved axis
    Straightness straightness;
};

/// The mean of the barycentres along the normal (of parallel slices), their regression line, and the curve of the slices; with
/// `by_shape` also the axes of `find_axis`: rotation, principal, slices, skeleton. Empty for fewer than two barycentres.
std::vector<ComparedAxis> compared_axes(const Mesh& mesh, const std::vector<Index>& faces, const SlicedObject& cut, bool by_shape,
                                        const AxisOptions& options = {});

}  // namespace ostraka
