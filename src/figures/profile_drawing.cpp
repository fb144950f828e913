// Pottery drawing of a profile.
#include "ostraka/figures/slice_drawing.h"

#include "figures/drawing_elements.h"

#include "ostraka/core/error.h"
#include "ostraka/figures/table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

using namespace figures;

namespace {

constexpr double above = 64, below = 62, beside = 64;

/// Points of the sheet per unit, and the name of the scale ("1 : 2") if the unit is known.
struct Scale {
    double points = 1;
    std::string name;
};
Scale scale_of(double width, double height, const std::string& unit) {
    const double room_x = 430, room_y = 560;  // of a page with margins
    const double largest = std::min(room_x / width, room_y / height);
    static const std::map<std::string, double> units{{"um", 0.001}, {"mm", 1}, {"cm", 10}, {"m", 1000}};
    const auto millimetres = units.find(unit);
    if (millimetres == units.end()) return {largest, ""};
    const double natural = millimetres->second * points_per_mm;
    Scale best{largest, ""};
    for (double ten = 1e-6; ten < 1e7; ten *= 10)
        for (const double step : {1.0, 2.0, 2.5, 3.0, 4.0, 5.0})
            if (const double part = step * ten; natural / part <= largest) {
                const std::string name = part >= 1 ? "1 : " + significant(part, 3) : significant(1 / part, 3) + " : 1";
                return {natural / part, name};
            }
    return best;
}

/// A dimension line: a thin line with short strokes at its ends.
void dimension(Sheet& sheet, double x1, double y1, double x2, double y2) {
    const double dx = y1 == y2 ? 0 : 4, dy = y1 == y2 ? 4 : 0;
    sheet.line(x1, y1, x2, y2, ink, 0.5);
    sheet.line(x1 - dx, y1 - dy, x1 + dx, y1 + dy, ink, 0.5);
    sheet.line(x2 - dx, y2 - dy, x2 + dx, y2 + dy, ink, 0.5);
}

/// The parts of the outline that lie beyond the section on its side, by more than a hundredth of the size.
std::vector<std::vector<Vector2d>> beyond_section(const Profile& profile) {
    const double height = profile.high - profile.low, step = height / 200;
    std::vector<std::vector<Vector2d>> runs;
    for (const auto& curve : profile.outline) {
        bool open = false;
        for (std::size_t i = 0; i < curve.size(); ++i) {
            const Vector2d &a = curve[i], &b = curve[(i + 1) % curve.size()];
            const int parts = static_cast<int>(std::clamp(std::ceil((b - a).norm() / step), 1.0, 1000.0));
            for (int k = 0; k < parts; ++k) {
                const Vector2d p = a + double(k) / parts * (b - a);
                const bool beyond = p.x() <= 0 && -p.x() > profile.extent_at(p.y()) + height / 100;
                if (beyond && !open) runs.emplace_back();
                if (beyond) runs.back().push_back(p);
                open = beyond;
            }
        }
    }
    std::erase_if(runs, [](const auto& run) { return run.size() < 3; });
    return runs;
}

}  // namespace

void write_profile_drawing(const Path& file, const Profile& profile, const std::string& title, const std::string& unit) {
    double left = profile.rim_diameter / 2, right = left;
    for (const auto& contour : profile.section.contours)
        for (const auto& p : contour.points) left = std::max(left, -p.x());
    for (const auto& curve : profile.outline)
        for (const auto& p : curve) right = std::max(right, p.x()), left = std::max(left, -p.x());
    const double height = profile.high - profile.low;
    if (!(left + right > 0) || !(height > 0))
        fail_input("drawing", "the object has no profile about this axis", "choose another axis");
    const Scale scale = scale_of(left + right, height, unit);
    const double sheet_width = std::max(scale.points * (left + right) + 2 * beside, 260.0);
    const double sheet_height = scale.points * height + above + below;
    write_sheet(file, [&](Sheet::Format format) {
        Sheet sheet(sheet_width, sheet_height, format);
        const double middle = sheet_width / 2 + scale.points * (left - right) / 2;
        const Placing placing{scale.points, middle, above + scale.points * profile.high};
        const double top = placing({0, profile.high})[1], bottom = placing({0, profile.low})[1];
        sheet.text(sheet.fitted(title, sheet_width - 2 * margin, 12), margin, margin + 8, 0, 12);
        // Left: the section of the wall.
        sheet.clip({0, 0, middle, sheet_height});
        for (const Slice& part : components(profile.section)) {
            std::vector<std::vector<std::array<double, 2>>> curves;
            for (const auto& contour : part.contours) curves.push_back(placing(contour.points, false));
            sheet.fill(curves, {64, 58, 54});
            for (const auto& contour : part.contours) sheet.polyline(placing(contour.points, true), ink, false, 0.7);
        }
        open_contours(sheet, profile.section, placing);
        for (const auto& curve : beyond_section(profile)) sheet.polyline(placing(curve, false), ink, true, 0.7);
        sheet.unclip();
        // Right: the view of the outside.
        sheet.clip({middle, 0, sheet_width, sheet_height});
        for (const auto& curve : profile.outline) sheet.polyline(placing(curve, true), ink, false, 1.1);
        for (const auto& edge : profile.edges) {
            const auto [x, y] = placing({edge.radius, edge.height});
            sheet.line(middle, y, x, y, ink, 0.6);
        }
        sheet.unclip();
        sheet.line(middle, top - 12, middle, bottom + 12, ink, 0.6);
        if (profile.rim_diameter > 0) {
            const double r = profile.rim_diameter / 2;
            // The mouth is shown as a line across the top.
            sheet.line(placing({-r, 0})[0], top, placing({r, 0})[0], top, ink, 0.6);
            dimension(sheet, placing({-r, 0})[0], top - 16, placing({r, 0})[0], top - 16);
            std::string words = "\u2300 " + length_text(profile.rim_diameter, unit);
            if (profile.rim_high > 0)
                words += fmt::format(" ({} to {}; {} % preserved)", length_text(profile.rim_low, unit),
                                     length_text(profile.rim_high, unit), fixed(100 * profile.rim_share, 0));
            sheet.text(words, middle, top - 21, 0.5, 9.5);
        }
        const double side = placing({right, 0})[0] + 18;
        dimension(sheet, side, top, side, bottom);
        sheet.upward_text(length_text(height, unit), side + 12, (top + bottom) / 2, 0.5, 9.5);
        scale_bar(sheet, margin + 6, sheet_height - margin - 6, scale.points, std::min(150.0, sheet_width / 2), unit);
        if (!scale.name.empty()) sheet.text(scale.name, sheet_width - margin, sheet_height - margin - 2, 1, 10);
        return sheet.finish();
    });
}

}  // namespace ostraka
