// Sheets of slices.
#include "ostraka/figures/slice_drawing.h"
#include "ostraka/core/angles.h"

#include "figures/drawing_elements.h"

#include "ostraka/core/error.h"
#include "ostraka/figures/table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

using namespace figures;

namespace {

struct Extent {
    Vector2d low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    Vector2d high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    void add(const Vector2d& p) { low = low.cwiseMin(p), high = high.cwiseMax(p); }
    [[nodiscard]] Vector2d size() const { return high - low; }
};

constexpr double caption = 24, gap = 10, title_height = 30, foot_height = 40;

/// Columns, rows and cell size that best fill a sheet of about 3 : 2.
struct Grid {
    int columns = 1, rows = 1;
    double width = 100, height = 100;
};
Grid grid_of(std::size_t count, const Vector2d& size) {
    Grid best;
    double maximum = 0;
    const double width = 720, height = 620, aspect = size.y() / size.x();
    for (int columns = 1; columns <= static_cast<int>(count); ++columns) {
        const int rows = (static_cast<int>(count) + columns - 1) / columns;
        const double field =
            std::min({(width - gap * (columns - 1)) / columns, ((height - (gap + caption) * rows) / rows) / aspect, 300.0});
        if (field > maximum) maximum = field, best = {columns, rows, field, field * aspect};
    }
    // Many slices stay legible: the sheet grows downwards.
    if (best.width < 56) {
        best.columns = 10, best.rows = (static_cast<int>(count) + 9) / 10;
        best.width = (width - gap * 9) / 10, best.height = best.width * aspect;
    }
    return best;
}

void draw_slice(Sheet& sheet, const DrawnSlice& drawn, const Placing& placing) {
    for (const Slice& part : components(*drawn.slice)) {
        std::vector<std::vector<std::array<double, 2>>> curves;
        for (const auto& contour : part.contours) curves.push_back(placing(contour.points, false));
        sheet.fill(curves, clay_fill);
    }
    if (drawn.descriptors != nullptr && drawn.descriptors->fitted_radius > 0 &&
        !(drawn.descriptors->fitted_radius_low < 0.8 * drawn.descriptors->fitted_radius)) {
        const auto& d = *drawn.descriptors;
        std::vector<Vector2d> circle;
        for (int k = 0; k <= 90; ++k)
            circle.push_back(d.fitted_centre + d.fitted_radius * Vector2d(std::cos(k * pi / 45), std::sin(k * pi / 45)));
        sheet.polyline(placing(circle, false), lighter(guide, 0.35), true, 0.5);
    }
    for (const auto& contour : drawn.slice->contours)
        if (contour.closed) sheet.polyline(placing(contour.points, true), ink, false, 0.8);
    open_contours(sheet, *drawn.slice, placing);
    for (const auto& line : drawn.lines) sheet.polyline(placing(line, false), guide, false, 1);
    if (drawn.descriptors != nullptr && drawn.descriptors->barycentre.allFinite()) {
        const auto [x, y] = placing(drawn.descriptors->barycentre);
        sheet.line(x - 3, y, x + 3, y, ink, 0.6);
        sheet.line(x, y - 3, x, y + 3, ink, 0.6);
    }
}

std::string slice_number(const SliceSheet& content, std::size_t place) {
    const std::size_t number = content.slices[place].number;
    return std::to_string(number > 0 ? number : place + 1);
}

std::string second_line(const DrawnSlice& drawn) {
    const auto& d = *drawn.descriptors;
    std::string text;
    if (std::isfinite(d.eccentricity)) text = "m/M " + fixed(d.eccentricity, 2);
    if (std::isfinite(d.roundness_fitted_relative))
        text += fmt::format("{}off {} %", text.empty() ? "" : ", ", fixed(100 * d.roundness_fitted_relative, 1));
    const Completeness& completeness = drawn.slice->completeness;
    if (!completeness.complete())
        text = std::isfinite(completeness.share) ? fmt::format("open, arc {} %", fixed(100 * completeness.share, 0))
                                                 : fmt::format("open, at most {} %", fixed(100 * completeness.share_at_most, 0));
    if (!drawn.slice->completeness.has_areas()) text = "contours cross";
    if (drawn.slice->contours.empty()) text = "empty";
    return text;
}

}  // namespace

void write_slice_sheet(const Path& file, const SliceSheet& content) {
    Extent extent, side;
    for (const auto& drawn : content.slices)
        for (const auto& contour : drawn.slice->contours)
            for (const auto& p : contour.points) extent.add(p);
    if (!(extent.size().maxCoeff() > 0))
        fail_input("drawing", "no slice has a contour", "choose heights that intersect the mesh");
    for (const auto& curve : content.view)
        for (const auto& p : curve) side.add(p);
    // A thin figure still gets a cell of minimum width.
    const Vector2d centre = (extent.low + extent.high) / 2;
    Vector2d size = 1.04 * extent.size();
    size = size.cwiseMax(0.15 * size.maxCoeff());
    const Grid grid = grid_of(content.slices.size(), size);
    const double inner = grid.rows * (grid.height + caption + gap);
    const bool has_view = !content.view.empty();
    double view_width = 0, view_scale = 0;
    const double view_height = std::min(std::max(inner, 220.0), 620.0) - 10;
    if (has_view) {
        view_scale = std::min(view_height / side.size().y(), 200 / side.size().x());
        view_width = view_scale * side.size().x() + 60;
    }
    const double width = 2 * margin + view_width + grid.columns * (grid.width + gap) - gap;
    const double height = 2 * margin + title_height + std::max(inner, has_view ? view_height : 0) + foot_height;
    const double sheet_width = std::max(width, 300.0);
    write_sheet(file, [&](Sheet::Format format) {
        Sheet sheet(sheet_width, height, format);
        sheet.text(sheet.fitted(content.title, sheet_width - 2 * margin, 14), margin, margin + 12, 0, 14);
        const double top = margin + title_height;
        if (has_view) {
            const Placing placing{view_scale, margin - view_scale * side.low.x(), top + view_scale * side.high.y()};
            std::vector<std::vector<std::array<double, 2>>> curves;
            for (const auto& curve : content.view) curves.push_back(placing(curve, false));
            sheet.fill(curves, lighter(clay_fill, 0.35));
            const double right = margin + view_scale * side.size().x();
            double last = std::numeric_limits<double>::infinity();
            for (std::size_t i = 0; i < content.slices.size(); ++i) {
                const double y = placing({0, content.slices[i].slice->height})[1];
                sheet.line(margin - 3, y, right + 6, y, guide, 0.5);
                if (std::abs(y - last) < 9) continue;  // numbers would overlap
                sheet.text(slice_number(content, i), right + 9, y + 3, 0, 9, guide);
                last = y;
            }
            for (const auto& curve : content.view) sheet.polyline(placing(curve, true), ink, false, 0.8);
        }
        for (std::size_t i = 0; i < content.slices.size(); ++i) {
            const auto columns = static_cast<std::size_t>(grid.columns), row_index = i / columns;
            const auto column = static_cast<double>(i % columns), row = static_cast<double>(row_index);
            const double left = margin + view_width + column * (grid.width + gap),
                         upper = top + row * (grid.height + caption + gap);
            const double scale = grid.width / size.x();
            const Placing placing{scale, left + grid.width / 2 - scale * centre.x(),
                                  upper + grid.height / 2 + scale * centre.y()};
            const auto& drawn = content.slices[i];
            sheet.clip({left - gap / 2, upper - gap / 2, left + grid.width + gap / 2, upper + grid.height + gap / 2});
            draw_slice(sheet, drawn, placing);
            sheet.unclip();
            const std::string number = slice_number(content, i);
            sheet.text(number, left, upper + grid.height + 11, 0, 9, guide);
            const double height_x = left + sheet.width_of(number, 9) + 4, room = grid.width - (height_x - left);
            sheet.text(sheet.fitted(length_text(drawn.slice->height, content.unit), room, 9), height_x, upper + grid.height + 11,
                       0, 9);
            if (drawn.descriptors != nullptr)
                sheet.text(sheet.fitted(second_line(drawn), grid.width, 7.5), left, upper + grid.height + 21, 0, 7.5, quiet);
        }
        scale_bar(sheet, margin + view_width, height - margin - 8, grid.width / size.x(), std::min(200.0, sheet_width / 2),
                  content.unit);
        return sheet.finish();
    });
}

}  // namespace ostraka
