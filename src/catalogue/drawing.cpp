#include "catalogue/drawing.h"

#include "catalogue/ribs.h"
#include "catalogue/section.h"
#include "catalogue/views.h"
#include "ostraka/core/angles.h"
#include "ostraka/geom/circle.h"
#include "ostraka/slicing/profile.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka::detail {

namespace {

using Line = CatalogueDrawing::Line;

/// Row of the grid at a height.
std::size_t row_at(const WallGrid& grid, double height) {
    const double row = (height - grid.low()) / grid.step();
    return static_cast<std::size_t>(std::clamp(row, 0.0, double(grid.rows()) - 1));
}

/// The circle of an end of the wall: the row within 3 % of the height (or 2 mm) of the level end where it is largest.
std::size_t largest_row(const WallGrid& grid, const LevelEnd& end, bool top) {
    const double depth = std::max(0.03 * (grid.high() - grid.low()), 2 * grid.step());
    std::size_t best = row_at(grid, end.height);
    double largest = 0;
    for (std::size_t row = 0; row < grid.rows(); ++row) {
        const double inward = top ? end.height - grid.height(row) : grid.height(row) - end.height;
        if (inward < -grid.step() || inward > depth) continue;
        if (const double r = grid.radius(row, end.bins); r > largest) largest = r, best = row;
    }
    return best;
}

/// Smallest and largest diameter over opposite directions of a whole circle (5 % and 95 % quantiles), without directions beyond
/// one and a half interquartile ranges of the quartiles, such as those of handles and spouts.
std::pair<double, double> range_across(const WallGrid& grid, std::size_t row) {
    std::vector<double> diameters;
    constexpr std::size_t half = WallGrid::bins / 2;
    for (std::size_t bin = 0; bin < half; ++bin)
        if (grid.outer(row, bin) > 0 && grid.outer(row, bin + half) > 0)
            diameters.push_back(grid.outer(row, bin) + grid.outer(row, bin + half));
    if (diameters.empty()) return {0, 0};
    const double low = sample_quantile(diameters, 0.25), high = sample_quantile(diameters, 0.75);
    const double fence = 1.5 * (high - low) + 1e-9 * high;
    std::erase_if(diameters, [&](double d) { return d < low - fence || d > high + fence; });
    return {sample_quantile(diameters, 0.05), sample_quantile(diameters, 0.95)};
}

/// The diameter at a row: about the axis, with the interval of the axis and that of the circle fitted to the arc alone.
CatalogueDiameter diameter_at(const Pose& pose, const CatalogueAxis& axis, double factor, std::size_t row, const LevelEnd* end) {
    const WallGrid& grid = pose.grid;
    CatalogueDiameter result;
    const double radius = end != nullptr ? grid.radius(row, end->bins) : grid.radius(row);
    if (!(radius > 0)) return result;
    result.value = 2 * radius;
    result.height = grid.height(row);
    result.share = end != nullptr ? end->share : grid.coverage(row);
    constexpr double whole = 0.9;
    if (grid.coverage(row) > whole) {
        std::tie(result.low, result.high) = range_across(grid, row);
        result.is_range = true;
        return result;
    }
    result.low = std::max(0.0, result.value + factor * axis.diameter_low);
    result.high = result.value + factor * axis.diameter_high;
    if (axis.is_sherd()) return result;
    // A circle about no given axis is less certain, and does not depend on the model of a surface of revolution.
    const ArcFit fit = fit_arc(grid.arc(row));
    if (fit.circle.radius > 0 && fit.is_round()) {
        result.low = std::min(result.low, 2 * fit.radius_low);
        result.high = std::max(result.high, 2 * fit.radius_high);
    }
    return result;
}

/// Replaces the diameter read off the drawing by that of the estimator, if it has one of this name.
void take_estimate(CatalogueDiameter& diameter, const CatalogueAxis& axis, const std::string& name, double factor) {
    const auto estimate = std::find_if(axis.diameters.begin(), axis.diameters.end(),
                                       [&](const DiameterEstimate& candidate) { return candidate.name == name; });
    if (diameter.is_range || estimate == axis.diameters.end()) return;
    diameter.value = factor * estimate->value;
    diameter.low = factor * estimate->low;
    diameter.high = factor * estimate->high;
}

std::string length_words(double value) { return fmt::format("{:.3g} mm", value); }

void set_diameter(CatalogueEntry& entry, const Pose& pose, const CatalogueAxis& axis, double factor, double max_error) {
    const WallGrid& grid = pose.grid;
    std::size_t widest = 0;
    for (std::size_t row = 0; row < grid.rows(); ++row)
        if (grid.radius(row) > 0 && !(grid.radius(widest) >= grid.radius(row))) widest = row;
    CatalogueDiameter& diameter = entry.diameter;
    std::string name = "largest diameter";
    if (entry.kind == CatalogueKind::vessel || entry.kind == CatalogueKind::rim) {
        name = "rim diameter";
        diameter = diameter_at(pose, axis, factor, largest_row(grid, pose.top, true), &pose.top);
    } else if (entry.kind == CatalogueKind::base && pose.bottom.is_level()) {
        name = "base diameter";
        diameter = diameter_at(pose, axis, factor, largest_row(grid, pose.bottom, false), &pose.bottom);
    } else {
        diameter = diameter_at(pose, axis, factor, widest, nullptr);
    }
    if (!(diameter.value > 0)) {
        entry.unknown.emplace_back("the diameter cannot be told: no wall that faces away from the axis is preserved");
        return;
    }
    take_estimate(diameter, axis, name, factor);
    diameter.name = name;
    diameter.known = diameter.is_range || diameter.high - diameter.low <= 2 * max_error * diameter.value;
    if (diameter.known) return;
    if (!std::isfinite(diameter.high) || diameter.high > 10 * diameter.value)
        entry.unknown.push_back(fmt::format("the {} cannot be told: more than {}", name, length_words(diameter.low)));
    else
        entry.unknown.push_back(fmt::format("the {} cannot be told: between {} and {}", name, length_words(diameter.low),
                                            length_words(diameter.high)));
    if (!std::isfinite(diameter.high)) diameter.high = unknown_number;
}

/// Median and range of the thickness over sections in up to twelve directions.
void set_thickness(CatalogueEntry& entry, const Pose& pose) {
    constexpr int sections = 12;
    std::vector<double> values;
    const double margin = pose.all_around ? 0 : 0.1 * pose.range.angle;
    const double step = (pose.range.angle - 2 * margin) / (pose.all_around ? sections : sections - 1);
    for (int k = 0; k < sections; ++k) {
        const std::vector<double> part = wall_thickness(section_at(pose.mesh, pose.range.start + margin + k * step));
        values.insert(values.end(), part.begin(), part.end());
    }
    if (values.size() < 20) return;
    const double median = sample_quantile(values, 0.5);
    std::erase_if(values, [&](double t) { return t > 4 * median; });  // along the wall, as at fractures
    entry.thickness = sample_quantile(values, 0.5);
    entry.thickness_low = sample_quantile(values, 0.05), entry.thickness_high = sample_quantile(values, 0.95);
}

/// The range of distances from the axis in which the surface at a row is seen from the direction `viewer` (radians), in the
/// right half of the view or (`side` -1) in the left half.
std::pair<double, double> seen_range(const WallGrid& grid, std::size_t row, double viewer, double side) {
    double from = std::numeric_limits<double>::infinity(), to = 0;
    for (std::size_t bin = 0; bin < WallGrid::bins; ++bin) {
        const double angle = side * (2 * pi * (double(bin) + 0.5) / double(WallGrid::bins) - viewer);
        if (!(grid.outer(row, bin) > 0) || std::cos(angle) < -0.01 || std::sin(angle) < -0.01) continue;
        from = std::min(from, grid.outer(row, bin) * std::max(0.0, std::sin(angle)));
        to = std::max(to, grid.outer(row, bin) * std::sin(angle));
    }
    return to > from ? std::pair(from, to) : std::pair(0.0, 0.0);
}

void add_lines(CatalogueDrawing& drawing, const Pose& pose, const CatalogueEntry& entry, double viewer, double side) {
    const WallGrid& grid = pose.grid;
    const bool rim = entry.kind == CatalogueKind::vessel || entry.kind == CatalogueKind::rim;
    drawing.lines = horizontal_lines(grid);
    const double close = 0.025 * (grid.high() - grid.low());
    std::erase_if(drawing.lines, [&](const Line& line) {  // lines at the ends coincide with rim and foot
        return (rim && pose.top.height - line.height < close) || line.height - grid.low() < close;
    });
    if (rim) {
        const std::size_t row = row_at(grid, pose.top.height - 1.5 * grid.step());
        drawing.lines.push_back({Line::Type::rim, pose.top.height, grid.radius(row, pose.top.bins), 0, 0});
    }
    if (pose.bottom.is_level() && (entry.kind == CatalogueKind::base || pose.all_around)) {
        const std::size_t row = row_at(grid, pose.bottom.height + 1.5 * grid.step());
        drawing.lines.push_back({Line::Type::foot, pose.bottom.height, grid.radius(row, pose.bottom.bins), 0, 0});
    }
    std::erase_if(drawing.lines, [](const Line& line) { return !(line.radius > 0); });
    for (Line& line : drawing.lines) {
        std::size_t row = row_at(grid, line.height);
        if (line.type == Line::Type::rim) row = row_at(grid, line.height - 1.5 * grid.step());
        if (line.type == Line::Type::foot) row = row_at(grid, line.height + 1.5 * grid.step());
        std::tie(line.from, line.to) = pose.all_around ? std::pair(0.0, line.radius) : seen_range(grid, row, viewer, side);
    }
}

/// Keeps the contours of a section at negative x.
void add_section(CatalogueDrawing& drawing, const Slice& section) {
    for (const Contour& contour : section.contours) {
        double near = std::numeric_limits<double>::infinity(), reach = 0;
        for (const Vector2d& p : contour.points) near = std::min(near, -p.x()), reach = std::max(reach, -p.x());
        if (!(reach > 0)) continue;
        (contour.closed ? drawing.section : drawing.open).push_back(contour.points);
        const bool first = drawing.section.size() + drawing.open.size() == 1;
        drawing.section_near = std::max(0.0, first ? near : std::min(near, drawing.section_near));
        drawing.section_reach = std::max(reach, drawing.section_reach);
    }
}

}  // namespace

void draw_about_axis(CatalogueEntry& entry, const Pose& pose, const CatalogueAxis& axis, double factor,
                     const CatalogueOptions& options) {
    CatalogueDrawing& drawing = entry.drawing;
    const WallGrid& grid = pose.grid;
    entry.kind = pose.kind;
    entry.height = drawing.high = grid.high();
    set_diameter(entry, pose, axis, factor, options.max_error);
    if (entry.kind != CatalogueKind::turned) set_thickness(entry, pose);
    if (!pose.doubt.empty()) entry.unknown.push_back(pose.doubt);
    const bool shaded = options.outside == CatalogueOptions::Outside::shaded;
    const double side = options.section_right ? -1 : 1;  // of the outside view
    double viewer = 0;                                   // direction from which the outside is seen
    Slice section;
    if (pose.all_around) {
        const Profile profile = find_profile(pose.mesh, SliceFrame());
        section = profile.section;
        viewer = profile.view_angle - side * pi / 2;
        if (profile.hides)
            entry.notes.emplace_back("something protrudes from the body in front or behind and is not seen in the drawing");
    } else {
        const double angle = best_section(pose);
        section = section_at(pose.mesh, angle);
        // The sherd begins at the axis of the drawing; a larger one fills the half.
        viewer = pose.range.middle() - side * std::min(pose.range.angle / 2, pi / 4);
        drawing.reconstructed = outer_profile(section, grid.low(), grid.high(), 300);
        const double thickness = std::isfinite(entry.thickness) ? entry.thickness : 0.03 * grid.high();
        // The reconstructed outline ends with the preserved outside, not along the fractures.
        std::erase_if(drawing.reconstructed, [&](const Vector2d& p) {
            return (entry.kind != CatalogueKind::base && p.y() < grid.low() + thickness) ||
                   (entry.kind != CatalogueKind::rim && p.y() > grid.high() - thickness);
        });
        if (entry.kind != CatalogueKind::rim) drawing.breaks = fracture_parts(section, true, thickness);
        if (entry.kind != CatalogueKind::base)
            for (auto& part : fracture_parts(section, false, thickness)) drawing.breaks.push_back(std::move(part));
    }
    if (!entry.diameter.known && !pose.all_around) viewer = pose.range.middle();  // the sherd is shown by itself
    add_section(drawing, section);
    add_lines(drawing, pose, entry, viewer, side);
    drawing.outside = make_view(pose.soup, pose.mesh, {"outside", viewer / degree + 90, 0}, {options.pixels, shaded, true});
}

}  // namespace ostraka::detail
