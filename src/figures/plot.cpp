#include "ostraka/figures/plot.h"

#include "figures/ruler.h"
#include "figures/sheet.h"
#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

using namespace figures;

constexpr double label_size = 10.5;
constexpr Rgb leader{150, 150, 150};

void check(const Plot& plot) {
    for (const PlotSeries& series : plot.series) {
        for (const auto& [kind, count] : {std::pair{" labels", series.labels.size()}, {" intervals", series.intervals.size()}})
            if (count != 0 && count != series.points.size())
                fail_usage(
                    fmt::format("series '{}' of a plot has {}{} for {} points", series.name, count, kind, series.points.size()),
                    "give one per point, or none");
    }
}

/// Draws the series of a plot whose axes are laid out.
class Drawing {
public:
    Drawing(Sheet& sheet, const Plot& plot, const Ruler& x, const Ruler& y) : sheet_(sheet), plot_(plot), x_(x), y_(y) {
        for (const PlotSeries& series : plot.series) bars_ += series.mark == Mark::bars ? 1 : 0;
    }

    void draw(std::size_t index) {
        const PlotSeries& series = plot_.series[index];
        const Rgb colour = series_colour(series.colour.value_or(index));
        if (series.mark == Mark::bars) draw_bars(series, colour);
        draw_intervals(series, colour);
        if (series.mark == Mark::bars) return;
        std::vector<std::array<double, 2>> run;
        const auto end_run = [&] {
            if (series.joined && run.size() > 1) sheet_.polyline(run, colour, series.dashed, series.thickness);
            run.clear();
        };
        for (const auto& point : series.points) {
            if (is_placed(point)) run.push_back(pixel(point));
            else end_run();
        }
        end_run();
        if (!series.marked) return;
        for (const auto& point : series.points)
            if (is_placed(point)) {
                const auto [px, py] = pixel(point);
                if (series.joined) sheet_.dot(px, py, colour);
                else sheet_.mark(px, py, series.colour.value_or(index), colour);
                occupied_.push_back({px - 4, py - 4, px + 4, py + 4});
            }
    }

    /// Call it after all marks are drawn. Places each label near its point where it covers nothing, connected by a line if it
    /// is farther away. Labels without room are left out; returns their number.
    std::size_t draw_labels(const Box& area) {
        std::size_t left_out = 0;
        for (const PlotSeries& series : plot_.series)
            for (std::size_t i = 0; i < series.labels.size(); ++i)
                if (!series.labels[i].empty() && is_placed(series.points[i]) &&
                    !draw_label(sheet_.fitted(series.labels[i], 140, label_size), pixel(series.points[i]), area))
                    ++left_out;
        return left_out;
    }

private:
    [[nodiscard]] bool is_placed(const std::array<double, 2>& point) const {
        return has_place(plot_.x, point[0]) && has_place(plot_.y, point[1]);
    }
    [[nodiscard]] std::array<double, 2> pixel(const std::array<double, 2>& point) const {
        return {x_.pixel(point[0]), y_.pixel(point[1])};
    }
    [[nodiscard]] double bar_width() const {
        return std::min(60.0,
                        0.8 * std::abs(x_.pixel(plot_.x.logarithmic ? 10 : 1) - x_.pixel(plot_.x.logarithmic ? 1 : 0)) / bars_);
    }
    bool draw_label(const std::string& words, const std::array<double, 2>& at, const Box& area) {
        const double width = sheet_.width_of(words, label_size), height = label_size;
        const auto [px, py] = at;
        for (const double distance : {6.0, 14.0, 26.0, 40.0}) {
            const double slant = 0.7 * distance;
            for (const auto& [dx, dy] : {std::array{distance, -height / 2},
                                         {slant, -height - slant},
                                         {slant, slant},
                                         {-distance - width, -height / 2},
                                         {-slant - width, -height - slant},
                                         {-slant - width, slant},
                                         {-width / 2, -height - distance},
                                         {-width / 2, distance}}) {
                const Box box{px + dx, py + dy, px + dx + width, py + dy + height};
                if (box.left < area.left || box.right > area.right || box.top < area.top || box.bottom > area.bottom) continue;
                if (std::any_of(occupied_.begin(), occupied_.end(), [&](const Box& other) { return box.meets(other); })) continue;
                occupied_.push_back(box);
                if (distance > 6)
                    sheet_.line(px, py, std::clamp(px, box.left, box.right), std::clamp(py, box.top, box.bottom), leader, 0.7);
                sheet_.text(words, box.left, box.bottom - 0.15 * height, 0, label_size);
                return true;
            }
        }
        return false;
    }
    void draw_bars(const PlotSeries& series, const Rgb& colour) {
        const double width = bar_width(), base = y_.pixel(y_.inside(0) && !plot_.y.logarithmic ? 0 : y_.lowest());
        offset_ = (static_cast<double>(bar_) - (bars_ - 1) / 2.0) * width;
        ++bar_;
        for (const auto& point : series.points) {
            if (!is_placed(point)) continue;
            const auto [px, py] = pixel(point);
            sheet_.rectangle({px + offset_ - 0.46 * width, std::min(py, base), px + offset_ + 0.46 * width, std::max(py, base)},
                             colour);
        }
    }
    void draw_intervals(const PlotSeries& series, const Rgb& colour) {
        const bool bars = series.mark == Mark::bars;
        const double shift = bars ? offset_ : 0;
        for (std::size_t i = 0; i < series.intervals.size(); ++i) {
            if (!series.intervals[i] || !is_placed(series.points[i])) continue;
            const auto [low, high] = *series.intervals[i];
            if (!has_place(plot_.y, low) || !has_place(plot_.y, high)) continue;
            const double px = x_.pixel(series.points[i][0]) + shift, a = y_.pixel(low), b = y_.pixel(high);
            const Rgb line = bars ? ink : colour;
            sheet_.line(px, a, px, b, line, 1.4);
            for (const double end : {a, b}) sheet_.line(px - 4, end, px + 4, end, line, 1.4);
        }
    }

    Sheet& sheet_;
    const Plot& plot_;
    const Ruler &x_, &y_;
    int bars_ = 0, bar_ = 0;
    double offset_ = 0;
    std::vector<Box> occupied_;
};

void draw_legend(Sheet& sheet, const Plot& plot, double left, double top) {
    double row = top + 0.8 * text_size;
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const PlotSeries& series = plot.series[i];
        if (series.name.empty()) continue;
        const Rgb colour = series_colour(series.colour.value_or(i));
        if (series.mark == Mark::bars) sheet.rectangle({left + 6, row - 6, left + 20, row + 6}, colour);
        else if (series.joined) sheet.polyline({{left, row}, {left + 26, row}}, colour, series.dashed, series.thickness);
        if (series.mark == Mark::dots && series.marked) {
            if (series.joined) sheet.dot(left + 13, row, colour);
            else sheet.mark(left + 13, row, series.colour.value_or(i), colour);
        }
        sheet.text(series.name, left + 34, row + 0.35 * text_size, 0);
        row += 1.6 * text_size;
    }
}

std::string draw(const Plot& plot, Sheet::Format format) {
    check(plot);
    Ruler x(plot, 0), y(plot, 1);
    const double longest_below = std::max(180.0, 0.45 * plot.height);
    double widest_tick = 0, widest_name = 0, widest_below = 0;
    {
        Sheet measure(10, 10);
        for (const Tick& tick : y.ticks()) widest_tick = std::max(widest_tick, std::min(180.0, measure.width_of(tick.text)));
        for (const Tick& tick : x.ticks())
            widest_below = std::max(widest_below, std::min(longest_below, measure.width_of(tick.text)));
        for (const PlotSeries& series : plot.series) widest_name = std::max(widest_name, measure.width_of(series.name));
    }
    const double left = margin + 1.6 * text_size + widest_tick + 8, top = margin + 1.8 * text_size;
    double right = plot.width - (widest_name > 0 ? 2 * margin + 34 + widest_name : 2 * margin);
    // Names that do not fit side by side are written vertically.
    const bool upright = !plot.x.names.empty() && widest_below + 8 > (right - left) / static_cast<double>(plot.x.names.size());
    double bottom = plot.height - margin - (upright ? 1.9 * text_size + widest_below + 4 : 3.2 * text_size);
    right = std::max(right, left + 80);
    bottom = std::max(bottom, top + 80);
    if (plot.square) right = left + std::min(right - left, bottom - top), bottom = top + (right - left);
    if (plot.equal) {
        const double unit = std::max(x.extent() / (right - left), y.extent() / (bottom - top));
        x.widen(unit * (right - left));
        y.widen(unit * (bottom - top));
    }
    const double width = plot.square ? right + (widest_name > 0 ? 2 * margin + 34 + widest_name : 2 * margin) : plot.width;
    const double height = plot.square ? bottom + plot.height - (plot.height - margin - 3.2 * text_size) : plot.height;
    Sheet sheet(std::max(width, right + margin), std::max(height, bottom + 4 * text_size), format);
    const double sheet_bottom = std::max(height, bottom + 4 * text_size);
    x.stretch_over(left, right);
    y.stretch_over(bottom, top);
    for (const Tick& tick : x.ticks()) {
        const double at = x.pixel(tick.value);
        if (plot.x.names.empty()) sheet.line(at, top, at, bottom, pale, 1);
        if (upright) sheet.upward_text(sheet.fitted(tick.text, longest_below), at + 0.35 * text_size, bottom + 6, 1);
        else sheet.text(sheet.fitted(tick.text, 180), at, bottom + 1.4 * text_size, 0.5);
    }
    for (const Tick& tick : y.ticks()) {
        if (plot.y.names.empty()) sheet.line(left, y.pixel(tick.value), right, y.pixel(tick.value), pale, 1);
        sheet.text(sheet.fitted(tick.text, 180), left - 6, y.pixel(tick.value) + 0.35 * text_size, 1);
    }
    sheet.line(left, bottom, right, bottom, ink, 1);
    sheet.line(left, top, left, bottom, ink, 1);
    sheet.text(plot.title, left, margin + 0.8 * text_size, 0);
    sheet.text(plot.x.label, (left + right) / 2, sheet_bottom - margin, 0.5);
    sheet.upward_text(plot.y.label, margin + 0.8 * text_size, (top + bottom) / 2);
    draw_legend(sheet, plot, right + margin, top);

    const Box area{left, top, right, bottom};
    sheet.clip({left, top - 5, right + 5, bottom + 5});
    Drawing drawing(sheet, plot, x, y);
    for (std::size_t i = 0; i < plot.series.size(); ++i) drawing.draw(i);
    for (const PlotLine& plot_line : plot.lines) {
        if (!has_place(plot_line.upright ? plot.x : plot.y, plot_line.value)) continue;
        const double at = (plot_line.upright ? x : y).pixel(plot_line.value);
        if (plot_line.upright) sheet.line(at, top, at, bottom, ink, 1, true);
        else sheet.line(left, at, right, at, ink, 1, true);
    }
    const std::size_t hidden_labels = drawing.draw_labels(area);
    for (const PlotLine& plot_line : plot.lines) {
        if (plot_line.label.empty() || !has_place(plot_line.upright ? plot.x : plot.y, plot_line.value)) continue;
        const double at = (plot_line.upright ? x : y).pixel(plot_line.value),
                     length = sheet.width_of(plot_line.label, label_size);
        if (plot_line.upright) {
            sheet.rectangle({at - 5 - label_size, top + 2, at - 2, top + 6 + length}, paper);
            sheet.upward_text(plot_line.label, at - 4, top + 3, 1, label_size);
        } else {
            sheet.rectangle({right - 6 - length, at - 4 - label_size, right - 2, at - 2}, paper);
            sheet.text(plot_line.label, right - 4, at - 4, 1, label_size);
        }
    }
    sheet.unclip();
    if (hidden_labels > 0)
        sheet.text(fmt::format("{}{} not shown", hidden_labels, hidden_labels == 1 ? " name is" : " names are"), right,
                   margin + 0.8 * text_size, 1, label_size);
    return sheet.finish();
}

}  // namespace

void write_plot(const Path& file, const Plot& plot) {
    figures::write_sheet(file, [&](figures::Sheet::Format format) { return draw(plot, format); });
}

}  // namespace ostraka
