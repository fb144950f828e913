// What `ostraka slice` found, as JSON, CSV and colours.
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/slicing/medial_axis.h"
#include "ostraka/slicing/slice_axes.h"

#include <string>
#include <vector>

namespace ostraka::app {

/// Slices with a frame each, which is the same for all where the planes are parallel.
struct CutObject {
    bool parallel = true;
    bool reversed = false;
    std::vector<SliceFrame> frames;
    std::vector<Slice> slices;
    std::vector<SliceDescriptors> descriptors;
    std::vector<MedialAxis> medial;  ///< one a slice, or none

    /// All that has a barycentre.
    [[nodiscard]] std::vector<Point> centres() const;
    [[nodiscard]] SliceStack stack() const { return {frames.empty() ? SliceFrame{} : frames[0], slices, reversed}; }
};

struct NamedAxis {
    std::string name, reason;  ///< the reason why there is none
    SliceLine line;
    std::vector<Point> polyline;  ///< of a bent one
    Straightness straightness;
};

JsonValue json_of(const CutObject& cut, JsonAllocator& allocator);
JsonValue json_of(const std::vector<NamedAxis>& axes, JsonAllocator& allocator);
JsonValue json_of(const ThicknessHomogeneity& thickness, JsonAllocator& allocator);
JsonValue json_of(const Tube& tube, const CutObject& cut, JsonAllocator& allocator);

std::string csv_of(const CutObject& cut, const std::string& unit);

/// Faces by what the nearest slice has of `name` (a descriptor, or "height"), those that are cut darker; grey where there is none
/// within half the distance to the next slice, or no value.
std::vector<Colour> slice_colours(const Mesh& mesh, const CutObject& cut, const std::string& name);

/// What a reader has to know of the slices: planes that miss, open contours, parts that cross or are oriented wrongly, and at
/// which heights. `extent`: heights of the mesh over the planes' origin; `one_plane`: it was given as such.
std::vector<std::string> remarks_of(const CutObject& cut, const std::pair<double, double>& extent, bool one_plane);

}  // namespace ostraka::app
