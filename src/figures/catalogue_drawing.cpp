#include "figures/catalogue_drawing.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka::figures {

namespace {

constexpr Rgb black{20, 20, 20}, mark_colour{190, 30, 30};
constexpr double contour_width = 0.9, thin_width = 0.45, gap_between_parts = 24;

using Line = CatalogueDrawing::Line;

void dimension_line(Sheet& sheet, double x1, double y1, double x2, double y2) {
    const double dx = y1 == y2 ? 0 : 3, dy = y1 == y2 ? 3 : 0;
    sheet.line(x1, y1, x2, y2, ink, 0.4);
    sheet.line(x1 - dx, y1 - dy, x1 + dx, y1 + dy, ink, 0.4);
    sheet.line(x2 - dx, y2 - dy, x2 + dx, y2 + dy, ink, 0.4);
}

}  // namespace

std::string scale_text(double scale) { return scale > 1 ? significant(scale, 3) + ":1" : "1:" + significant(1 / scale, 3); }

std::string millimetres_text(double value) { return (value >= 100 ? fixed(value, 0) : significant(value, 3)) + " mm"; }

std::string share_text(double share) { return fixed(100 * share, share < 0.1 ? 1 : 0) + " %"; }

std::string diameter_text(const CatalogueDiameter& diameter) {
    if (!diameter.known) return "cannot be told";
    const auto digits_of = [](double value) { return value >= 100 ? fixed(value, 0) : significant(value, 3); };
    if (digits_of(diameter.low) == digits_of(diameter.high)) return millimetres_text(diameter.value);
    return fmt::format("{} ({} to {})", millimetres_text(diameter.value), digits_of(diameter.low), digits_of(diameter.high));
}

PotteryPlate::PotteryPlate(const CatalogueEntry& entry, const CatalogueStyle& style, double scale)
    : entry_(entry), style_(style), points_(points_per_mm * scale), side_(style.section_right() ? -1 : 1) {
    if (!reconstructs()) apart_ = gap_between_parts;
}

/// Whether the drawing shows the vessel about its axis; otherwise section and outside view stand side by side.
bool PotteryPlate::reconstructs() const { return entry_.diameter.known || entry_.drawing.reconstructed.empty(); }

PlateExtent PotteryPlate::extent() const {
    const CatalogueDrawing& drawing = entry_.drawing;
    const CatalogueView& outside = drawing.outside;
    double section = drawing.section_reach, view = side_ > 0 ? outside.object_right : -outside.object_left;
    if (reconstructs()) {
        for (const Line& line : drawing.lines) section = std::max(section, line.radius), view = std::max(view, line.radius);
        for (const Vector2d& p : drawing.reconstructed) view = std::max(view, p.x());
        section *= points_, view *= points_;
    } else {
        section = points_ * (drawing.section_reach - drawing.section_near);
        view = points_ * (outside.object_right - outside.object_left) + apart_;
    }
    return {side_ > 0 ? section : view, side_ > 0 ? view : section, points_ * drawing.high, 0};
}

std::vector<std::array<double, 2>> PotteryPlate::on_paper(const std::vector<Vector2d>& curve, bool closed) const {
    std::vector<std::array<double, 2>> places;
    // Without an axis the section moves next to the outside view.
    const double shift = reconstructs() ? 0 : side_ * points_ * entry_.drawing.section_near;
    for (const Vector2d& p : curve) places.push_back({paper_x(p.x()) + shift, paper_y(p.y())});
    if (closed && !places.empty()) places.push_back(places.front());
    return places;
}

void PotteryPlate::draw_outside(Sheet& sheet) const {
    const CatalogueView& view = entry_.drawing.outside;
    double origin = x_;
    if (reconstructs()) {
        const double far = 1e5;
        sheet.clip(side_ > 0 ? Box{x_, 0, far, far} : Box{0, 0, x_, far});
    } else {
        origin = side_ > 0 ? x_ + apart_ - points_ * view.object_left : x_ - apart_ - points_ * view.object_right;
    }
    sheet.image(view.jpeg, {origin + points_ * view.left, paper_y(view.low + view.height),
                            origin + points_ * (view.left + view.width), paper_y(view.low)});
    for (const auto& curve : view.outline) {
        std::vector<std::array<double, 2>> places;
        for (const Vector2d& p : curve) places.push_back({origin + points_ * p.x(), paper_y(p.y())});
        if (!places.empty()) places.push_back(places.front());
        sheet.polyline(places, black, false, entry_.drawing.reconstructed.empty() ? contour_width : 0.6);
    }
    if (reconstructs()) {
        if (!entry_.drawing.reconstructed.empty())
            sheet.polyline(on_paper(entry_.drawing.reconstructed, false), black, true, 0.7);
        sheet.unclip();
    }
}

void PotteryPlate::draw_lines(Sheet& sheet) const {
    const CatalogueDrawing& drawing = entry_.drawing;
    const bool whole = drawing.reconstructed.empty();
    if (!reconstructs()) {  // the rim's plane only, as a short line beside the section
        for (const Line& line : drawing.lines)
            if (line.type == Line::Type::rim)
                sheet.line(x_, paper_y(line.height), x_ + side_ * 0.5 * apart_, paper_y(line.height), black, thin_width);
        return;
    }
    for (const Line& line : drawing.lines) {
        const bool end = line.type == Line::Type::rim || line.type == Line::Type::foot;
        const double y = paper_y(line.height), width = line.type == Line::Type::rib ? 0.35 : end ? 0.7 : thin_width;
        const auto stroke = [&](double from, double to, bool dashed) {
            if (to > from) sheet.line(paper_x(from), y, paper_x(to), y, black, width, dashed);
        };
        if (whole) {
            stroke(line.type == Line::Type::rim ? -line.radius : 0, line.radius, false);
            continue;
        }
        if (end) stroke(-line.radius, 0, true);
        stroke(line.from, line.to, false);
        if (end) stroke(0, line.from, true), stroke(line.to, line.radius, true);
    }
    const double beyond = 4;
    sheet.line(x_, paper_y(drawing.high) - beyond, x_, y_ + beyond, black, thin_width);
}

void PotteryPlate::draw_section(Sheet& sheet) const {
    const CatalogueDrawing& drawing = entry_.drawing;
    const bool filled = style_.convention != CatalogueStyle::Convention::continental;
    const double far = 1e5;
    if (reconstructs()) sheet.clip(side_ > 0 ? Box{0, 0, x_, far} : Box{x_, 0, far, far});
    std::vector<std::vector<std::array<double, 2>>> curves;
    for (const auto& contour : drawing.section) curves.push_back(on_paper(contour, false));
    sheet.fill(curves, filled ? black : paper);
    for (const auto& contour : drawing.section)
        sheet.polyline(on_paper(contour, true), black, false, filled ? 0.4 : contour_width);
    if (!filled)  // the section is open where the wall is broken
        for (const auto& part : drawing.breaks) sheet.polyline(on_paper(part, false), paper, false, 2 * contour_width);
    for (const auto& contour : drawing.open) sheet.polyline(on_paper(contour, false), black, false, 1.2);
    if (reconstructs()) sheet.unclip();
}

void PotteryPlate::draw_dimensions(Sheet& sheet) const {
    const CatalogueDrawing& drawing = entry_.drawing;
    const CatalogueDiameter& diameter = entry_.diameter;
    const double top = paper_y(drawing.high);
    const PlateExtent size = extent();
    if (diameter.known) {
        const double r = points_ * diameter.value / 2, y = top - 11;
        dimension_line(sheet, x_ - r, y, x_ + r, y);
        const std::string words = (diameter.name == "rim diameter" ? "" : diameter.name + " ") + diameter_text(diameter);
        sheet.text("\u2300 " + words, x_, y - 5, 0.5, 8);
        // The preserved share of the circle as a pie beside the text.
        const double half = sheet.width_of("\u2300 " + words, 8) / 2, radius = 5.5;
        sheet.sector(x_ + half + 12, y - 8, radius, std::clamp(diameter.share, 0.0, 1.0), black);
        sheet.circle(x_ + half + 12, y - 8, radius, black, 0.4);
        sheet.text(share_text(diameter.share), x_ + half + 21, y - 5, 0, 7);
    } else if (!diameter.name.empty()) {
        sheet.text("\u2300 cannot be told", x_, top - 9, 0.5, 8);
    }
    const double side = x_ + size.right + 10;
    dimension_line(sheet, side, top, side, y_);
    sheet.upward_text(millimetres_text(drawing.high), side + 10, (top + y_) / 2, 0.5, 8);
}

void PotteryPlate::draw(Sheet& sheet, double x, double y, bool compact) const {
    x_ = x, y_ = y;
    draw_outside(sheet);
    draw_lines(sheet);
    draw_section(sheet);
    if (!compact) draw_dimensions(sheet);
}

void draw_view(Sheet& sheet, const CatalogueView& view, double points, double x, double y) {
    const auto place = [&](double px, double py) {
        return std::array{x + points * (px - view.object_left), y - points * (py - view.object_low)};
    };
    const auto [left, bottom] = place(view.left, view.low);
    const auto [right, top] = place(view.left + view.width, view.low + view.height);
    sheet.image(view.jpeg, {left, top, right, bottom});
    for (const auto& curve : view.outline) {
        std::vector<std::array<double, 2>> places;
        for (const Vector2d& p : curve) places.push_back(place(p.x(), p.y()));
        if (!places.empty()) places.push_back(places.front());
        sheet.polyline(places, black, false, 0.5);
    }
    for (const CatalogueView::Mark& mark : view.marks) {
        const auto [mx, my] = place(mark.place.x(), mark.place.y());
        sheet.dot(mx, my, mark_colour, 1.3);
        sheet.text(std::to_string(mark.number), mx + 2, my - 1.5, 0, 5, mark_colour);
    }
}

}  // namespace ostraka::figures
