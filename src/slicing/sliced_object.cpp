#include "ostraka/slicing/sliced_object.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/summary.h"
#include "slicing/curve_slices.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

std::vector<Point> SlicedObject::centres() const {
    std::vector<Point> points;
    for (std::size_t i = 0; i < slices.size(); ++i)
        if (descriptors[i].barycentre.allFinite())
            points.push_back(frames[i].point(descriptors[i].barycentre, parallel ? slices[i].height : 0));
    return points;
}

bool SlicedObject::met() const {
    return std::any_of(slices.begin(), slices.end(), [](const Slice& slice) { return !slice.contours.empty(); });
}

std::vector<double> SlicedObject::sorted_heights() const {
    std::vector<double> heights;
    for (const Slice& slice : slices) heights.push_back(slice.height);
    std::sort(heights.begin(), heights.end());
    return heights;
}

std::vector<double> SliceHeights::in(double height) const {
    if (!heights.empty()) return heights;
    return spacing ? slice_heights_spaced(from * height, to * height, *spacing)
                   : slice_heights(from * height, to * height, count);
}

void require_surface(const Mesh& mesh, const std::vector<Index>& faces) {
    const auto has_area = [&](Index f) { return face_area(mesh, Face(f)) > 0; };
    const std::size_t count = faces.empty() ? mesh.number_of_faces() : faces.size();
    for (Index i = 0; i < count; ++i)
        if (has_area(faces.empty() ? i : faces[i])) return;
    fail_input("mesh", fmt::format("has no surface to slice: all of its {} triangles are lines or points", count),
               "use a mesh with a surface");
}

SlicedObject slice_parallel(const Mesh& mesh, const SliceFrame& frame, const std::vector<double>& heights,
                            const std::vector<Index>& faces) {
    require_surface(mesh, faces);
    SlicedObject cut;
    std::tie(cut.lowest, cut.highest) = height_range(mesh, frame, faces);
    SliceStack stack = slice_mesh(mesh, frame, heights, faces);
    cut.frames.assign(heights.size(), frame);
    cut.slices = std::move(stack.slices);
    cut.reversed = stack.reversed;
    cut.descriptors = describe_slices(cut.slices);
    return cut;
}

SlicedObject slice_across(const Mesh& mesh, const std::vector<Point>& curve, int count, const std::vector<Index>& faces) {
    require_surface(mesh, faces);
    CurveSlices across = slice_along(mesh, curve, count, faces);
    SlicedObject cut{.parallel = false,
                     .reversed = across.reversed,
                     .frames = std::move(across.frames),
                     .slices = std::move(across.slices),
                     .curve = curve,
                     .highest = across.length};
    cut.descriptors = describe_slices(cut.slices);
    return cut;
}

void add_medial_axes(SlicedObject& cut, std::vector<double> residues) {
    std::sort(residues.begin(), residues.end());
    cut.medial.resize(cut.slices.size());
    parallel_for(cut.slices.size(), 1, [&](std::size_t i) { cut.medial[i] = medial_axis(cut.slices[i], residues); });
}

bool is_hollow(const Mesh& mesh, const Vector& up, const std::vector<Index>& faces) {
    const SliceFrame frame = slice_frame(Point(0, 0, 0), up);
    const auto ends = height_range(mesh, frame, faces);
    const auto level = describe_slices(slice_mesh(mesh, frame, slice_heights(ends.first, ends.second, 24), faces).slices);
    return 4 * std::count_if(level.begin(), level.end(), [](const auto& d) { return d.hole_area_ratio > 0.5; }) >= 24;
}

SliceFrame median_frame(const SlicedObject& cut) {
    SliceFrame frame = cut.frames.at(0);
    std::vector<double> x, y;
    for (const auto& d : cut.descriptors)
        if (d.outline_barycentre.allFinite()) x.push_back(d.outline_barycentre.x()), y.push_back(d.outline_barycentre.y());
    // For open contours, the centres of circles determined to a tenth of the radius.
    if (x.empty())
        for (const auto& d : cut.descriptors)
            if (d.fitted_radius_high - d.fitted_radius_low < 0.2 * d.fitted_radius)
                x.push_back(d.fitted_centre.x()), y.push_back(d.fitted_centre.y());
    if (x.empty()) return frame;
    frame.origin = frame.point({upper_median(std::move(x)), upper_median(std::move(y))}, 0);
    return frame;
}

}  // namespace ostraka
