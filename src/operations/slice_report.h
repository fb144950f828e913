// Output of slices: reports, tables, colours, remarks.
#pragma once

#include "ostraka/axis/object_slices.h"
#include "ostraka/framework/report.h"
#include "ostraka/io/mesh_file.h"

#include <string>
#include <vector>

namespace ostraka {

/// The results of slicing an object that are reported.
struct SliceFindings {
    const SlicedObject& cut;  ///< the slices
    std::string unit;         ///< unit of lengths
    bool one_plane = false;   ///< true: a single plane was given, so that there is no tube and heights are relative to the plane
    std::vector<ComparedAxis> axes;  ///< axes to which the axis of the slices is compared
    ThicknessHomogeneity thickness;  ///< evenness of the wall
    Tube tube;                       ///< the tubular part
};

/// Declares the values and tables that `add_slices` fills: the members of a slices file (slices.schema.json).
void declare_slices(ReportLayout& layout);
/// Adds the values and tables of the findings to the report.
void add_slices(Report& report, const SliceFindings& findings);

/// CSV table with completeness and all descriptors, one row per slice.
std::string slice_table(const SlicedObject& cut, const std::string& unit);

/// Names of the quantities that `slice_colours` accepts: "height" and the descriptors of `slice_table`.
std::vector<std::string> slice_quantities();
/// Face colours that show a quantity of the slice nearest to the face; faces crossed by a slice are darker. A face is grey if no
/// slice lies within half the slice spacing or the slice has no value.
std::vector<Colour> slice_colours(const Mesh& mesh, const SlicedObject& cut, const std::string& quantity);

/// Remarks on the slices: planes that miss the object, open contours, crossing or wrongly oriented contours, each with the
/// heights. `one_plane`: a single plane was given.
std::vector<std::string> slice_remarks(const SlicedObject& cut, bool one_plane);

}  // namespace ostraka
