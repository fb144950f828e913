// What slices tell: in reports, as a table, as colours, in words.
#pragma once

#include "ostraka/axis/object_slices.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/operation/report.h"

#include <string>
#include <vector>

namespace ostraka {

/// What is reported of a cut object.
struct SliceFindings {
    const CutObject& cut;
    std::string unit;
    bool one_plane = false;  ///< it was given as such: there is no tube, and heights are over it
    std::vector<ComparedAxis> axes;
    ThicknessHomogeneity thickness;
    Tube tube;
};

/// The values and tables that `add_slices` adds: the members of a slices file (slices.schema.json).
void declare_slices(ReportLayout& layout);
void add_slices(Report& report, const SliceFindings& found);

/// Completeness and every descriptor, a row a slice.
std::string slice_table(const CutObject& cut, const std::string& unit);

/// "height", and the descriptors that slice_table has.
std::vector<std::string> slice_quantities();
/// Faces by what the nearest slice has of one of these, those that are cut darker; grey where there is none within half the
/// distance to the next slice, or no value.
std::vector<Colour> slice_colours(const Mesh& mesh, const CutObject& cut, const std::string& quantity);

/// What a reader has to know of the slices: planes that miss, open contours, parts that cross or are oriented wrongly, and at
/// which heights. `one_plane`: it was given as such.
std::vector<std::string> slice_remarks(const CutObject& cut, bool one_plane);

}  // namespace ostraka
