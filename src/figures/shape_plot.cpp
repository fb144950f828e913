#include "ostraka/figures/shape_plot.h"

#include "figures/sheet.h"
#include "ostraka/core/error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ostraka {

namespace {

using namespace figures;

constexpr double shape_side = 190, plot_width = 620, plot_height = 480, title_height = 30, label_height = 26, small = 10.5;

/// ShapeBounds of points.
struct ShapeBounds {
    double left = std::numeric_limits<double>::infinity(), right = -left, low = left, high = -left;
    void add(const std::array<double, 2>& p) {
        if (!std::isfinite(p[0]) || !std::isfinite(p[1])) return;
        left = std::min(left, p[0]), right = std::max(right, p[0]);
        low = std::min(low, p[1]), high = std::max(high, p[1]);
    }
    void add(const DrawnShape& shape) {
        for (const auto* lines : {&shape.grid, &shape.lines})
            for (const auto& line : *lines)
                for (const auto& p : line) add(p);
        for (const auto& p : shape.points) add(p);
    }
    [[nodiscard]] bool empty() const { return !(right >= left); }
};

/// Maps coordinates into a box with equal scale.
class ShapeFrame {
public:
    ShapeFrame(const ShapeBounds& bounds, const Box& box, double scale)
        : scale_(scale),
          x_((box.left + box.right) / 2 - scale * (bounds.left + bounds.right) / 2),
          y_((box.top + box.bottom) / 2 + scale * (bounds.low + bounds.high) / 2) {}
    [[nodiscard]] std::array<double, 2> operator()(const std::array<double, 2>& p) const {
        return {x_ + scale_ * p[0], y_ - scale_ * p[1]};
    }
    [[nodiscard]] std::vector<std::array<double, 2>> operator()(const std::vector<std::array<double, 2>>& line) const {
        std::vector<std::array<double, 2>> result;
        for (const auto& p : line) result.push_back((*this)(p));
        return result;
    }

private:
    double scale_, x_, y_;
};

double scale_of(const ShapeBounds& bounds, double width, double height) {
    const double x = bounds.right - bounds.left, y = bounds.high - bounds.low;
    const double scale = std::min(x > 0 ? width / x : std::numeric_limits<double>::infinity(),
                                  y > 0 ? height / y : std::numeric_limits<double>::infinity());
    return std::isfinite(scale) ? scale : 1;
}

void draw_shape(Sheet& sheet, const DrawnShape& shape, const Box& box, double scale) {
    if (shape.points.empty()) return;
    ShapeBounds bounds;
    bounds.add(shape);
    const ShapeFrame frame(bounds, {box.left, box.top + 18, box.right, box.bottom}, scale);
    sheet.text(sheet.fitted(shape.title, box.right - box.left, small), (box.left + box.right) / 2, box.top + 12, 0.5, small);
    for (const auto& line : shape.grid) sheet.polyline(frame(line), quiet_line, false, 0.7);
    for (const auto& line : shape.lines) sheet.polyline(frame(line), series_colour(0), false, 1.3);
    for (const auto& p : shape.points) {
        const auto [x, y] = frame(p);
        sheet.dot(x, y, ink, 2.2);
    }
}

void draw_scatter(Sheet& sheet, const ShapePlot& plot, const Box& box) {
    ShapeBounds bounds;
    for (const ScatterGroup& group : plot.groups)
        for (const auto& p : group.points) bounds.add(p);
    if (bounds.empty()) fail_input("plot", "has no finite point", "check the values");
    const double scale = scale_of(bounds, box.right - box.left - 50, box.bottom - box.top - 50);
    const ShapeFrame frame(bounds, box, scale);
    sheet.frame(box, quiet_line, 1);
    const auto [zero_x, zero_y] = frame({0, 0});
    if (zero_x > box.left && zero_x < box.right) sheet.line(zero_x, box.top, zero_x, box.bottom, pale, 1);
    if (zero_y > box.top && zero_y < box.bottom) sheet.line(box.left, zero_y, box.right, zero_y, pale, 1);
    double legend = box.top + 16;
    for (std::size_t g = 0; g < plot.groups.size(); ++g) {
        const ScatterGroup& group = plot.groups[g];
        for (std::size_t i = 0; i < group.points.size(); ++i) {
            if (!std::isfinite(group.points[i][0]) || !std::isfinite(group.points[i][1])) continue;
            const auto [x, y] = frame(group.points[i]);
            sheet.mark(x, y, g, series_colour(g));
            if (i < group.labels.size()) sheet.text(group.labels[i], x + 6, y - 4, 0, 8);
        }
        if (group.name.empty()) continue;
        sheet.mark(box.left + 12, legend - 4, g, series_colour(g));
        sheet.text(group.name, box.left + 22, legend, 0, small);
        legend += 15;
    }
    sheet.text(plot.x_label, (box.left + box.right) / 2, box.bottom + 18, 0.5);
    sheet.upward_text(plot.y_label, box.left - 8, (box.top + box.bottom) / 2);
}

std::string draw(const ShapePlot& plot, Sheet::Format format) {
    const double left = margin + shape_side + label_height, top = title_height + margin, right = left + plot_width,
                 bottom = top + plot_height, foot = bottom + label_height;
    Sheet sheet(right + margin, foot + shape_side + margin, format);
    sheet.text(plot.title, (left + right) / 2, title_height, 0.5, text_size + 2);
    draw_scatter(sheet, plot, {left, top, right, bottom});
    double scale = std::numeric_limits<double>::infinity();
    for (const DrawnShape* shape : {&plot.left, &plot.right, &plot.bottom, &plot.top}) {
        if (shape->points.empty()) continue;
        ShapeBounds bounds;
        bounds.add(*shape);
        scale = std::min(scale, scale_of(bounds, shape_side - 10, shape_side - 28));
    }
    draw_shape(sheet, plot.top, {margin, top, margin + shape_side, top + shape_side}, scale);
    draw_shape(sheet, plot.bottom, {margin, bottom - shape_side, margin + shape_side, bottom}, scale);
    draw_shape(sheet, plot.left, {left, foot, left + shape_side, foot + shape_side}, scale);
    draw_shape(sheet, plot.right, {right - shape_side, foot, right, foot + shape_side}, scale);
    return sheet.finish();
}

}  // namespace

void write_shape_plot(const Path& file, const ShapePlot& plot) {
    write_sheet(file, [&](Sheet::Format format) { return draw(plot, format); });
}

}  // namespace ostraka
