// Output of slices: reports, tables, colours, remarks.
#pragma once

#include "ostraka/axis/object_slices.h"
#include "ostraka/framework/report.h"
#include "ostraka/io/mesh_file.h"

#include <string>
#include <vector>

namespace ostraka {

/// The results of slicing that are reported.
struct SliceFindings {
    const SlicedObject& cut;
    std::string unit;
    bool one_plane = false;  ///< a single plane was given: there is no tube, and heights are relative to the plane
    std::vector<ComparedAxis> axes;
    ThicknessHomogeneity thickness;
    Tube tube;
};

/// Declares the values and tables that `add_slices` fills: the members of a slices file (slices.schema.json).
void declare_slices(ReportLayout& layout);
void add_slices(Report& report, const SliceFindings& findings);

/// Completeness and all descriptors, one row per slice.
std::string slice_table(const SlicedObject& cut, const std::string& unit);

/// "height" and the descriptors of slice_table.
std::vector<std::string> slice_quantities();
/// Colours faces by a quantity of the nearest slice; faces crossed by a slice are darker. Grey if there is no slice within half
/// the spacing, or no value.
std::vector<Colour> slice_colours(const Mesh& mesh, const SlicedObject& cut, const std::string& quantity);

/// Remarks on the slices: planes that miss the object, open contours, crossing or wrongly oriented parts, each with the
/// heights. `one_plane`: a single plane was given.
std::vector<std::string> slice_remarks(const SlicedObject& cut, bool one_plane);

}  // namespace ostraka
