// Descriptors of slices.
#include "ostraka/slicing/slice_descriptors.h"
#include "ostraka/core/angles.h"

#include "slicing/contour_classification.h"
#include "slicing/segment_tree.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/planar.h"

#include <fmt/core.h>

#include <array>

namespace ostraka {

namespace {

using detail::add_pieces;

/// Whether an outer contour contains the contour.
bool is_within(const Slice& slice, const Contour& contour) {
    for (int c = contour.parent; c >= 0; c = slice.contours[static_cast<std::size_t>(c)].parent)
        if (!slice.contours[static_cast<std::size_t>(c)].hole) return true;
    return false;
}

/// Mean squared distance of the segments from the sides of the enclosing rectangle. The distance is the minimum of four
/// functions that are linear along a segment: the segment is split where two of them are equal, and Simpson's rule is exact
/// between.
double rectangle_deviation(const PlaneSegments& segments, const PlaneRectangle& rectangle) {
    const Vector2d a = rectangle.along, b(-a.y(), a.x());
    const double x = rectangle.length / 2, y = rectangle.breadth / 2;
    double sum = 0, length = 0;
    for (const auto& [from, to] : segments) {
        const auto sides = [&](const Vector2d& p) {
            const double s = a.dot(p - rectangle.centre), t = b.dot(p - rectangle.centre);
            return std::array<double, 4>{x - s, x + s, y - t, y + t};
        };
        const auto first = sides(from), last = sides(to);
        std::vector<double> cuts{0, 1};
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = i + 1; j < 4; ++j) {
                const double d0 = first.at(i) - first.at(j), d1 = last.at(i) - last.at(j);
                if ((d0 < 0) != (d1 < 0) && d0 != d1) cuts.push_back(std::clamp(d0 / (d0 - d1), 0.0, 1.0));
            }
        std::sort(cuts.begin(), cuts.end());
        const auto square = [&](double t) {
            double minimum = std::numeric_limits<double>::infinity();
            for (std::size_t i = 0; i < 4; ++i) minimum = std::min(minimum, first.at(i) + t * (last.at(i) - first.at(i)));
            return minimum * minimum;
        };
        const double piece = (to - from).norm();
        for (std::size_t k = 0; k + 1 < cuts.size(); ++k)
            sum += piece * (cuts[k + 1] - cuts[k]) / 6 *
                   (square(cuts[k]) + 4 * square((cuts[k] + cuts[k + 1]) / 2) + square(cuts[k + 1]));
        length += piece;
    }
    return length > 0 ? sum / length : 0;
}

/// Moments of the distances from the outer contour of a component to its holes.
struct Walls {
    double length = 0, first = 0, second = 0;
    double minimum = std::numeric_limits<double>::infinity(), maximum = 0;

    void add(const Slice& component) {
        PlaneSegments inner;
        for (std::size_t i = 1; i < component.contours.size(); ++i) add_pieces(inner, component.contours[i]);
        if (inner.empty()) return;
        const detail::SegmentTree tree(std::move(inner));
        const Contour& outer = component.contours[0];
        std::size_t hint = 0;
        for (std::size_t i = 0; i < outer.points.size(); ++i) {
            const Vector2d &a = outer.points[i], &b = outer.points[(i + 1) % outer.points.size()];
            const double piece = (b - a).norm();
            const int parts = std::max(1, static_cast<int>(std::ceil(500 * piece / outer.length)));
            note(tree.distance(a, hint));
            for (int k = 0; k < parts; ++k)
                for (const double t : {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)}) {
                    const double d = tree.distance(a + (k + t) / parts * (b - a), hint), w = piece / parts / 2;
                    length += w, first += w * d, second += w * d * d;
                    note(d);
                }
        }
    }

private:
    void note(double d) { minimum = std::min(minimum, d), maximum = std::max(maximum, d); }
};

void describe_outline(SliceDescriptors& d, const PlaneSegments& outline, const std::vector<Vector2d>& corners) {
    const auto hull = convex_hull(corners);
    const PlaneRectangle box = smallest_rectangle(hull);
    d.box_length = box.length, d.box_breadth = box.breadth;
    d.eccentricity = box.breadth / box.length;
    d.elongation = 1 - d.eccentricity;
    if (!d.counted) return;
    d.solidity = d.area / polygon_moments(hull, hull[0]).area;
    d.rectangular_variance = rectangle_deviation(outline, box) / (box.area() / pi);
}

/// Centroid relative to the first point.
Vector2d polygon_centre(const Contour& contour) {
    const PolygonMoments moments = polygon_moments(contour.points, contour.points[0]);
    return moments.first / moments.area;
}

void describe_roundness(SliceDescriptors& d, const Contour& main) {
    PlaneSegments pieces;
    add_pieces(pieces, main);
    d.equivalent_radius = std::sqrt(main.area / pi);
    const CircleDeviation circle = circle_deviation(pieces, {main.points[0] + polygon_centre(main), d.equivalent_radius});
    d.circular_variance = circle.square / (d.equivalent_radius * d.equivalent_radius);
    d.roundness_equivalent = circle.absolute;
    d.roundness_equivalent_relative = circle.absolute / d.equivalent_radius;
}

/// The circle of open contours, without roundness: the missing part need not be round.
void describe_arc(SliceDescriptors& d, const ArcFit& arc) {
    if (!arc.is_round()) return;
    d.fitted_radius = arc.circle.radius, d.fitted_centre = arc.circle.centre;
    d.fitted_radius_low = arc.radius_low;
    if (std::isfinite(arc.radius_high)) d.fitted_radius_high = arc.radius_high;
}

void describe_circle(SliceDescriptors& d, const Contour& main) {
    PlaneSegments pieces;
    add_pieces(pieces, main);
    Circle circle = fit_circle(pieces);
    // Rejects the best circle of a bar, which degenerates to a straight line.
    if (!(circle.radius > 0) || circle.radius > d.box_length)
        circle = {main.points[0] + polygon_centre(main), d.equivalent_radius};
    if (!(circle.radius > 0)) return;
    d.fitted_radius = circle.radius, d.fitted_centre = circle.centre;
    d.roundness_fitted = circle_deviation(pieces, circle).absolute;
    d.roundness_fitted_relative = d.roundness_fitted / circle.radius;
}

/// Descriptors of intersecting contours: only the hull, over all contours.
SliceDescriptors describe_crossing(const Slice& slice) {
    SliceDescriptors d;
    d.counted = false;
    std::vector<Vector2d> corners;
    for (const Contour& contour : slice.contours) {
        (contour.closed ? d.closed_length : d.open_length) += contour.length;
        if (contour.closed) corners.insert(corners.end(), contour.points.begin(), contour.points.end());
    }
    describe_outline(d, {}, corners);
    return d;
}

}  // namespace

SliceDescriptors describe_slice(const Slice& slice) {
    if (!slice.completeness.has_areas()) return describe_crossing(slice);
    SliceDescriptors d;
    PlaneSegments outline;
    const Contour* main = nullptr;
    std::vector<Vector2d> corners;
    PolygonMoments material, filled;
    double perimeter = 0, holes = 0, outline_length = 0;
    Walls walls;
    const auto parts = components(slice);
    const Vector2d reference = parts.empty() ? Vector2d(0, 0) : parts[0].contours[0].points[0];
    const auto add = [](PolygonMoments& sum, const PolygonMoments& m) { sum.area += m.area, sum.first += m.first; };
    for (const Slice& part : parts) {
        ++d.components;
        for (const Contour& contour : part.contours) {
            add(material, polygon_moments(contour.points, reference));
            perimeter += contour.length;
            if (contour.hole) ++d.holes, holes -= contour.area;
        }
        walls.add(part);
    }
    for (const Contour& contour : slice.contours) {
        (contour.closed ? d.closed_length : d.open_length) += contour.length;
        if (contour.closed && !contour.hole && !is_within(slice, contour)) {
            if (main == nullptr) main = &contour;  // the largest comes first
            add(filled, polygon_moments(contour.points, reference));
            outline_length += contour.length;
            add_pieces(outline, contour);
            corners.insert(corners.end(), contour.points.begin(), contour.points.end());
        }
    }
    d.euler_number = d.components - d.holes;
    if (filled.area > 0) {
        d.area = material.area, d.perimeter = perimeter, d.hole_area = holes;
        d.barycentre = reference + material.first / material.area;
        d.outline_area = filled.area, d.outline_perimeter = outline_length;
        d.outline_barycentre = reference + filled.first / filled.area;
        d.hole_area_ratio = holes / (material.area + holes);
        d.compactness = 4 * pi * d.area / (perimeter * perimeter);
        describe_outline(d, outline, corners);
        describe_roundness(d, *main);
    }
    const detail::OpenArc arc = d.open_length > 0 ? detail::open_arc(slice.contours) : detail::OpenArc{};
    if (arc.outside) describe_arc(d, arc.fit);
    else if (main != nullptr && filled.area > 0) describe_circle(d, *main);
    if (walls.length > 0) {
        d.thickness_mean = walls.first / walls.length;
        d.thickness_variance = std::max(0.0, walls.second / walls.length - d.thickness_mean * d.thickness_mean);
        d.thickness_min = walls.minimum, d.thickness_max = walls.maximum;
    }
    return d;
}

std::vector<NamedDescriptor> list_descriptors(const SliceDescriptors& d) {
    const auto counted = [&](int number) { return d.counted ? double(number) : SliceDescriptors::absent; };
    return {{"area", "area", d.area},
            {"perimeter", "length", d.perimeter},
            {"hole_area", "area", d.hole_area},
            {"barycentre_x", "length", d.barycentre.x()},
            {"barycentre_y", "length", d.barycentre.y()},
            {"outline_area", "area", d.outline_area},
            {"outline_perimeter", "length", d.outline_perimeter},
            {"outline_barycentre_x", "length", d.outline_barycentre.x()},
            {"outline_barycentre_y", "length", d.outline_barycentre.y()},
            {"box_length", "length", d.box_length},
            {"box_breadth", "length", d.box_breadth},
            {"elongation", "", d.elongation},
            {"eccentricity", "", d.eccentricity},
            {"solidity", "", d.solidity},
            {"compactness", "", d.compactness},
            {"circular_variance", "", d.circular_variance},
            {"rectangular_variance", "", d.rectangular_variance},
            {"components", "", counted(d.components)},
            {"holes", "", counted(d.holes)},
            {"euler_number", "", counted(d.euler_number)},
            {"hole_area_ratio", "", d.hole_area_ratio},
            {"equivalent_radius", "length", d.equivalent_radius},
            {"roundness_equivalent", "length", d.roundness_equivalent},
            {"roundness_equivalent_relative", "", d.roundness_equivalent_relative},
            {"fitted_radius", "length", d.fitted_radius},
            {"fitted_radius_low", "length", d.fitted_radius_low},
            {"fitted_radius_high", "length", d.fitted_radius_high},
            {"fitted_centre_x", "length", d.fitted_centre.x()},
            {"fitted_centre_y", "length", d.fitted_centre.y()},
            {"roundness_fitted", "length", d.roundness_fitted},
            {"roundness_fitted_relative", "", d.roundness_fitted_relative},
            {"thickness_mean", "length", d.thickness_mean},
            {"thickness_variance", "area", d.thickness_variance},
            {"thickness_least", "length", d.thickness_min},
            {"thickness_most", "length", d.thickness_max},
            {"closed_length", "length", d.closed_length},
            {"open_length", "length", d.open_length}};
}

std::vector<SliceDescriptors> describe_slices(const std::vector<Slice>& slices) {
    std::vector<SliceDescriptors> descriptors(slices.size());
    parallel_for(slices.size(), 1, [&](std::size_t i) { descriptors[i] = describe_slice(slices[i]); });
    return descriptors;
}

std::vector<double> thickness_profile(const Slice& slice, int directions) {
    if (directions < 1 || directions > 1000000)
        fail_usage(fmt::format("the number of directions of the profile is {}", directions), "use 1 to a million");
    if (!slice.completeness.has_areas()) return {};
    // Components and holes are sorted by decreasing size.
    const auto parts = components(slice);
    if (parts.empty() || parts[0].contours.size() < 2) return {};
    const Contour& hole = parts[0].contours[1];
    const PolygonMoments moments = polygon_moments(hole.points, hole.points[0]);
    const Vector2d centre = hole.points[0] + moments.first / moments.area;
    PlaneSegments pieces;
    for (const Contour& contour : parts[0].contours) add_pieces(pieces, contour);
    const double step = 2 * pi / directions;
    std::vector<Vector2d> rays;
    for (int k = 0; k < directions; ++k) rays.emplace_back(std::cos(k * step), std::sin(k * step));
    // A crossing out of the material adds its distance, a crossing into it subtracts it.
    std::vector<double> sums(rays.size(), 0);
    std::vector<bool> met(rays.size(), false);
    for (const auto& [from, to] : pieces) {
        const Vector2d a = from - centre, b = to - centre;
        double low = std::atan2(a.y(), a.x()), high = std::atan2(b.y(), b.x());
        if (low > high) std::swap(low, high);
        if (high - low > pi) low += 2 * pi, std::swap(low, high);
        const auto first = static_cast<long>(std::floor(low / step)), last = static_cast<long>(std::ceil(high / step));
        for (long k = first; k <= std::min(last, first + directions - 1); ++k) {
            const auto i = static_cast<std::size_t>(((k % directions) + directions) % directions);
            const Vector2d& ray = rays[i];
            const double s = ray.x() * a.y() - ray.y() * a.x(), t = ray.x() * b.y() - ray.y() * b.x();
            // A point on the ray counts as left of it.
            if ((s >= 0) == (t >= 0)) continue;
            const double distance = ray.dot(a + s / (s - t) * (b - a));
            if (distance < 0) continue;
            sums[i] += t > s ? distance : -distance;
            met[i] = true;
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (!met[i]) sums[i] = SliceDescriptors::absent;
    return sums;
}

}  // namespace ostraka
