// An object as its slices: parallel ones, or across a curve.
#pragma once

#include "ostraka/slicing/medial_axis.h"
#include "ostraka/slicing/slice_axes.h"
#include "ostraka/slicing/slice_descriptors.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Slices with a frame each, which is the same for all where the planes are parallel.
struct CutObject {
    bool parallel = true;
    bool reversed = false;  ///< as in SliceStack
    std::vector<SliceFrame> frames;
    std::vector<Slice> slices;
    std::vector<SliceDescriptors> descriptors = {};
    std::vector<MedialAxis> medial = {};  ///< one a slice, or none
    std::vector<Point> curve;             ///< what was cut across, if not parallel
    double lowest = 0, highest = 0;       ///< heights of the object over the frames' origin; of a curve its length
    std::string reason = {};              ///< why there is nothing to cut by; empty: it was cut

    /// Of the material, of all slices that have a barycentre.
    [[nodiscard]] std::vector<Point> centres() const;
    /// Some plane met the object.
    [[nodiscard]] bool met() const;
    [[nodiscard]] SliceStack stack() const { return {frames.empty() ? SliceFrame{} : frames[0], slices, reversed}; }
    [[nodiscard]] std::vector<double> sorted_heights() const;
};

/// At which heights an object is cut: listed ones, or some between two shares of its height.
struct SlicePlaces {
    std::vector<double> heights;    ///< over the lowest place; if there are any, nothing else counts
    std::optional<double> spacing;  ///< from the lower share up; else `count` of them, in the middles of equal layers
    int count = 50;
    double from = 0, to = 1;

    /// Of an object of this height. Throws as slice_heights and slice_heights_spaced.
    [[nodiscard]] std::vector<double> in(double height) const;
};

/// Throws Error (input) unless one of the faces (of all, if none are given) has an area.
void require_surface(const Mesh& mesh, const std::vector<Index>& faces = {});

/// Cuts by parallel planes at these heights over the frame's origin and describes the slices. Throws as slice_mesh and
/// require_surface.
CutObject cut_parallel(const Mesh& mesh, const SliceFrame& frame, const std::vector<double>& heights,
                       const std::vector<Index>& faces = {});
/// The same across a curve; throws as slice_along.
CutObject cut_across(const Mesh& mesh, const std::vector<Point>& curve, int count, const std::vector<Index>& faces = {});

/// Medial axes of all slices, in parallel; residues as in medial_axis, in any order.
void add_medial_axes(CutObject& cut, std::vector<double> residues);

/// Whether a quarter of 24 slices across `up` are half empty within, by area.
bool is_hollow(const Mesh& mesh, const Vector& up, const std::vector<Index>& faces = {});

/// The frame of parallel slices, moved to the medians of their outlines' barycentres, which an arm or a handle does not move.
SliceFrame median_frame(const CutObject& cut);

}  // namespace ostraka
