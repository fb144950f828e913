// Frames and heights of slices.
#include "ostraka/slicing/slice.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/mesh/limits.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

constexpr double max_planes = 1e6;

void check_range(double lowest, double highest) {
    if (!(lowest <= highest) || !std::isfinite(highest - lowest))
        fail_usage(fmt::format("there is no range of heights from {} to {}", digits(lowest, 4), digits(highest, 4)),
                   "give the lower height first");
}

}  // namespace

SliceFrame slice_frame(const Point& origin, const Vector& direction) {
    SliceFrame frame;
    frame.origin = origin;
    frame.normal = unit_vector(direction);
    if (frame.normal == CGAL::NULL_VECTOR)
        fail_usage("the direction of the slices has no length", "give a direction other than 0, 0, 0");
    const Vector side = std::abs(frame.normal.x()) < 0.9 ? Vector(1, 0, 0) : Vector(0, 1, 0);
    frame.u = unit_vector(side - (side * frame.normal) * frame.normal);
    frame.v = CGAL::cross_product(frame.normal, frame.u);
    return frame;
}

std::pair<double, double> height_range(const Mesh& mesh, const SliceFrame& frame, const std::vector<Index>& faces) {
    std::pair<double, double> range(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
    const auto add = [&](Vertex v) {
        const double h = frame.height(mesh.point(v));
        range.first = std::min(range.first, h), range.second = std::max(range.second, h);
    };
    if (faces.empty())
        for (const Vertex v : mesh.vertices())
            if (!mesh.is_isolated(v)) add(v);
    for (const Index f : faces)
        for (const Vertex v : corners(mesh, Face(f))) add(v);
    if (!(range.first <= range.second)) fail_input("mesh", "has no faces to cut", "choose another mesh");
    return range;
}

std::vector<double> slice_heights(double lowest, double highest, int count) {
    check_range(lowest, highest);
    if (count < 1 || count > max_planes) fail_usage(fmt::format("the number of slices is {}", count), "use 1 to a million");
    std::vector<double> heights;
    for (int i = 0; i < count; ++i) heights.push_back(lowest + (highest - lowest) * ((i + 0.5) / count));
    return heights;
}

std::vector<double> slice_heights_spaced(double lowest, double highest, double spacing) {
    check_range(lowest, highest);
    if (!(spacing > 0 && spacing <= max_coordinate))
        fail_usage("the spacing of the slices is " + digits(spacing, 4), "use a length above 0");
    if (const double height = highest - lowest; !(height / spacing < max_planes))
        fail_usage(fmt::format("a spacing of {} gives {} slices over a height of {}", digits(spacing, 4),
                               digits(height / spacing, 4), digits(height, 4)),
                   fmt::format("use at least {} for the maximum number of slices, a million; {} gives two hundred",
                               digits(1.001 * height / max_planes, 4), digits(height / 200, 4)));
    // Includes the last height if only rounding misses it.
    const double steps = std::floor((highest - lowest) / spacing * (1 + 1e-12));
    std::vector<double> heights;
    for (double i = 0; i <= steps; ++i) heights.push_back(std::min(lowest + i * spacing, highest));
    return heights;
}

}  // namespace ostraka
