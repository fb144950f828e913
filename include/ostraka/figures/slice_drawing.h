// Drawings of slices and of profiles, as SVG or PNG.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/slicing/profile.h"
#include "ostraka/slicing/slice_descriptors.h"

#include <string>
#include <vector>

namespace ostraka {

/// A slice drawn in its own cell of a sheet.
struct DrawnSlice {
    const Slice* slice = nullptr;                   ///< the slice to draw; must not be null
    const SliceDescriptors* descriptors = nullptr;  ///< fitted circle and barycentre; null: not drawn
    /// Poly-lines drawn over the slice, for example a medial axis.
    std::vector<std::vector<Eigen::Vector2d>> lines = {};
    std::size_t number = 0;  ///< number displayed beside the slice; 0: the slice's position on the sheet is displayed
};

/// A sheet of drawn slices.
struct SliceSheet {
    std::string title;  ///< title of the sheet
    std::string unit;   ///< unit written after lengths; may be empty
    /// The slices in drawing order, all at the same scale and about the same axis.
    std::vector<DrawnSlice> slices;
    /// Outline of the object seen from the side, as curves whose y is the height; may be empty.
    std::vector<std::vector<Eigen::Vector2d>> view = {};
};

/// Writes a sheet of the slices, with the slice planes across the object's outline and a scale bar. Material is filled; open
/// contours have a different colour and marked ends; the fitted circle is dashed, the barycentre is a cross. The extension
/// selects SVG, or PNG of twice the size. Throws Error (input) if no slice has a contour, Error (usage) for any other extension.
void write_slice_sheet(const Path& file, const SliceSheet& sheet);

/// Writes a pottery drawing of a profile: the section of the wall filled on the left, the outside on the right, visible parts
/// beyond the section dashed, the axis in the middle, the rim diameter and the height, a scale bar. If the unit is mm, cm or m,
/// an SVG printed at its own size has the stated scale. The extension selects SVG, or PNG of twice the size; Error (usage) for
/// any other extension.
void write_profile_drawing(const Path& file, const Profile& profile, const std::string& title, const std::string& unit);

}  // namespace ostraka
