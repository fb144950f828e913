// Slices of an object by parallel planes, or by planes perpendicular to a curve.
#pragma once

#include "ostraka/slicing/medial_axis.h"
#include "ostraka/slicing/slice_axes.h"
#include "ostraka/slicing/slice_descriptors.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Slices of an object, each with a frame; parallel slices have the same frame.
struct SlicedObject {
    bool parallel = true;                            ///< true: slices by parallel planes; false: slices across a curve
    bool reversed = false;                           ///< true: the mesh is closed and inside out, and all contours were reversed
    std::vector<SliceFrame> frames;                  ///< frame of each slice
    std::vector<Slice> slices;                       ///< slices in the planes of their frames
    std::vector<SliceDescriptors> descriptors = {};  ///< descriptors of each slice
    std::vector<MedialAxis> medial = {};             ///< medial axis of each slice; empty: not computed
    std::vector<Point> curve;                        ///< the curve across which the object was sliced; empty for parallel slices
    double lowest = 0, highest = 0;  ///< height range of the object above the origin of the frames; for a curve, the arc length
    std::string reason = {};         ///< why the object could not be sliced; empty if it was sliced

    /// The barycentres of the material, for all slices that have one.
    [[nodiscard]] std::vector<Point> centres() const;
    /// True if at least one slice has contours.
    [[nodiscard]] bool met() const;
    /// The slices as a stack, for parallel slices.
    [[nodiscard]] SliceStack stack() const { return {frames.empty() ? SliceFrame{} : frames[0], slices, reversed}; }
    [[nodiscard]] std::vector<double> sorted_heights() const;  ///< heights of the slices, ascending
};

/// Heights at which an object is sliced: listed, or distributed between two fractions of its height.
struct SliceHeights {
    std::vector<double> heights;  ///< heights above the lowest point; if not empty, the other members are ignored
    /// Distance between planes, from the lower fraction upwards; empty: `count` mid-planes of equal layers.
    std::optional<double> spacing;
    int count = 50;           ///< number of planes, if neither heights nor spacing are given
    double from = 0, to = 1;  ///< fractions of the object's height between which planes are distributed

    /// The heights, above the lowest point, for an object of height `height`. Throws the errors of slice_heights and
    /// slice_heights_spaced.
    [[nodiscard]] std::vector<double> in(double height) const;
};

/// Throws Error (input) unless at least one of the faces (of all faces if the list is empty) has an area.
void require_surface(const Mesh& mesh, const std::vector<Index>& faces = {});

/// Slices an object by parallel planes at these heights above the frame's origin and computes the descriptors. Throws the errors
/// of slice_mesh and require_surface.
SlicedObject slice_parallel(const Mesh& mesh, const SliceFrame& frame, const std::vector<double>& heights,
                            const std::vector<Index>& faces = {});
/// Slices an object across a curve at `count` places and computes the descriptors. Throws the errors of slice_along.
SlicedObject slice_across(const Mesh& mesh, const std::vector<Point>& curve, int count, const std::vector<Index>& faces = {});

/// Computes the medial axes of all slices, in parallel. `residues`: thresholds for pruning the axis (see medial_axis.h), in any
/// order.
void add_medial_axes(SlicedObject& cut, std::vector<double> residues);

/// True if an object is hollow: in at least a quarter of 24 slices perpendicular to `up`, holes take up at least half of the
/// area.
bool is_hollow(const Mesh& mesh, const Vector& up, const std::vector<Index>& faces = {});

/// The frame of parallel slices, moved to the median of the barycentres of the slices' outlines, which is robust to an arm or a
/// handle.
SliceFrame median_frame(const SlicedObject& cut);

}  // namespace ostraka
