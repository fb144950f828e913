// Slices objects along their axes, and finds the axes with which slices are compared.
#pragma once

#include "ostraka/axis/axis.h"
#include "ostraka/slicing/sliced_object.h"

namespace ostraka {

/// Direction and heights at which an object is sliced.
struct CutOptions {
    /// Method that finds the axis across which slices are cut; the axis is oriented upwards as far as possible, and the skeleton
    /// gives a curve. None: slices are cut across `up`.
    std::optional<AxisMethod> direction;
    Vector up{0, 0, 1};   ///< upward direction of the object
    SliceHeights places;  ///< heights of the slices; across a curve only their number is used
    AxisOptions axis;     ///< options of the axis search
};

/// Slices the mesh, or some of its faces, along its own axis; heights are measured from the lowest point of the sliced surface.
/// If the object has no axis by this method, the result has a reason and no slices. Throws Error (input) for a mesh without
/// surface or a mesh that find_axis or slice_mesh rejects.
SlicedObject cut_object(const Mesh& mesh, const std::vector<Index>& faces, const CutOptions& options = {});

/// An axis with which the barycentres of slices are compared.
struct ComparedAxis {
    std::string name;             ///< name of the axis in reports
    std::string reason;           ///< why the axis does not exist; empty: the axis was found
    SliceLine line;               ///< the straight axis
    std::vector<Point> polyline;  ///< points of a curved axis; empty for a straight axis
    Straightness straightness;    ///< deviation of the barycentres from the axis
};

/// The axes of a sliced object: the line through the mean barycentre along the normal (parallel slices only), the regression line
/// of the barycentres, and the curve across which slices were cut; with `by_shape` also the axes found by `find_axis`: rotation,
/// principal, slices, skeleton. The result is empty for fewer than two barycentres.
std::vector<ComparedAxis> compared_axes(const Mesh& mesh, const std::vector<Index>& faces, const SlicedObject& cut, bool by_shape,
                                        const AxisOptions& options = {});

}  // namespace ostraka
