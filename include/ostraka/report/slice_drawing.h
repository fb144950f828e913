// Drawings of slices and of profiles, as SVG or PNG.
#pragma once

#include "ostraka/core/file.h"
#include "ostraka/slicing/profile.h"
#include "ostraka/slicing/slice_descriptors.h"

#include <string>
#include <vector>

namespace ostraka {

/// A slice in a field of its own.
struct DrawnSlice {
    const Slice* slice = nullptr;
    const SliceDescriptors* descriptors = nullptr;
    std::vector<std::vector<Eigen::Vector2d>> lines = {};  ///< drawn over it: a medial axis, say
    std::size_t number = 0;                                ///< that it is called by; 0: its place on the sheet
};

struct SliceSheet {
    std::string title;
    std::string unit;                                     ///< written behind lengths; may be empty
    std::vector<DrawnSlice> slices;                       ///< in the order drawn, all at one scale and about one axis
    std::vector<std::vector<Eigen::Vector2d>> view = {};  ///< the object's outline across the slices, y the height; may be empty
};

/// Writes a sheet of the slices, with the planes across the object's outline beside them, and a scale bar. Material is filled;
/// open contours are drawn in another colour, with their ends marked; the circle that fits best is dashed, the barycentre is a
/// cross. An SVG file, or a PNG of twice the size, by the ending. Throws Error (input) if no slice has a contour, Error (usage)
/// for other endings.
void write_slice_sheet(const Path& file, const SliceSheet& sheet);

/// Writes a profile as pottery is drawn: the section of the wall filled on the left, the outside on the right, what is seen of
/// the other side beyond the section dashed, the axis between them, the rim's diameter and the height, a scale bar. Where the
/// unit is mm, cm or m, an SVG printed at its own size is at the scale written in it. Endings and errors as above.
void write_profile_drawing(const Path& file, const Profile& profile, const std::string& title, const std::string& unit);

}  // namespace ostraka
