// Drawings of slices and of profiles, as SVG or PNG.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/slicing/profile.h"
#include "ostraka/slicing/slice_descriptors.h"

#include <string>
#include <vector>

namespace ostraka {

/// A slice in its own cell of the sheet.
struct DrawnSlice {
    const Slice* slice = nullptr;
    const SliceDescriptors* descriptors = nullptr;
    std::vector<std::vector<Eigen::Vector2d>> lines = {};  ///< drawn over the slice: for example a medial axis
    std::size_t number = 0;                                ///< displayed number; 0: its position on the sheet
};

struct SliceSheet {
    std::string title;
    std::string unit;                ///< written after lengths; may be empty
    std::vector<DrawnSlice> slices;  ///< in drawing order, all at the same scale and about the same axis
    /// Outline of the object across the slices, y is the height; may be empty.
    std::vector<std::vector<Eigen::Vector2d>> view = {};
};

/// Writes a sheet of the slices, with the slice planes across the object's outline and a scale bar. Material is filled; open
/// contours have a different colour and marked ends; the fitted circle is dashed, the barycentre is a cross. An SVG file, or a
/// PNG of twice the size, by the extension. Throws Error (input) if no slice has a contour, Error (usage) for any other
/// extension.
void write_slice_sheet(const Path& file, const SliceSheet& sheet);

/// Writes a pottery drawing of a profile: the section of the wall filled on the left, the outside on the right, visible parts
/// beyond the section dashed, the axis in the middle, the rim diameter and the height, a scale bar. If the unit is mm, cm or m,
/// an SVG printed at its own size has the stated scale. Extensions and errors as above.
void write_profile_drawing(const Path& file, const Profile& profile, const std::string& title, const std::string& unit);

}  // namespace ostraka
