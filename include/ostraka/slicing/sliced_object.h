// An object as a stack of slices: parallel, or across a curve.
#pragma once

#include "ostraka/slicing/medial_axis.h"
#include "ostraka/slicing/slice_axes.h"
#include "ostraka/slicing/slice_descriptors.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Slices, each with a frame; parallel slices have the same frame.
struct SlicedObject {
    bool parallel = true;
    bool reversed = false;  ///< as in SliceStack
    std::vector<SliceFrame> frames;
    std::vector<Slice> slices;
    std::vector<SliceDescriptors> descriptors = {};
    std::vector<MedialAxis> medial = {};  ///< one per slice, or empty
    std::vector<Point> curve;             ///< the curve that was sliced, if not parallel
    double lowest = 0, highest = 0;       ///< height range of the object above the frames' origin; for a curve, its arc length
    std::string reason = {};              ///< why the object could not be sliced; empty if it was

    /// Barycentres of the material of all slices that have one.
    [[nodiscard]] std::vector<Point> centres() const;
    /// Whether any plane intersects the object.
    [[nodiscard]] bool met() const;
    [[nodiscard]] SliceStack stack() const { return {frames.empty() ? SliceFrame{} : frames[0], slices, reversed}; }
    [[nodiscard]] std::vector<double> sorted_heights() const;
};

/// Heights at which an object is sliced: listed, or distributed between two fractions of its height.
struct SliceHeights {
    std::vector<double> heights;    ///< above the lowest point; if not empty, the other members are ignored
    std::optional<double> spacing;  ///< spacing, from the lower fraction upwards; otherwise `count` mid-planes of equal layers
    int count = 50;
    double from = 0, to = 1;

    /// Heights for an object of this height. Throws the errors of slice_heights and slice_heights_spaced.
    [[nodiscard]] std::vector<double> in(double height) const;
};

/// Throws Error (input) unless at least one of the faces (all, if none are given) has an area.
void require_surface(const Mesh& mesh, const std::vector<Index>& faces = {});

/// Slices by parallel planes at these heights above the frame's origin and computes the descriptors. Throws the errors of
/// slice_mesh and require_surface.
SlicedObject slice_parallel(const Mesh& mesh, const SliceFrame& frame, const std::vector<double>& heights,
                            const std::vector<Index>& faces = {});
/// The same across a curve. Throws the errors of slice_along.
SlicedObject slice_across(const Mesh& mesh, const std::vector<Point>& curve, int count, const std::vector<Index>& faces = {});

/// Computes the medial axes of all slices, in parallel; residues as in medial_axis, in any order.
void add_medial_axes(SlicedObject& cut, std::vector<double> residues);

/// Whether at least a quarter of 24 slices across `up` are at least half empty by area.
bool is_hollow(const Mesh& mesh, const Vector& up, const std::vector<Index>& faces = {});

/// The frame of parallel slices, moved to the median of the barycentres of their outlines, which is robust to an arm or a
/// handle.
SliceFrame median_frame(const SlicedObject& cut);

}  // namespace ostraka
