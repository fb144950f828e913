#include "plot.h"

#include "ostraka/core/error.h"
#include "ostraka/render/colour_scale.h"

#include <cairo-svg.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>

namespace ostraka::experiments {

namespace {

constexpr double text_size = 13, margin = 14;
/// Told apart by colour-blind eyes too (Okabe and Ito).
constexpr std::array<Rgb, 7> colours{
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {86, 180, 233}, {230, 159, 0}, {60, 60, 60}}};
constexpr Rgb ink{30, 30, 30}, grid{222, 222, 222};

struct Tick {
    double value;
    std::string text;
};

bool has_place(const PlotAxis& axis, double value) { return std::isfinite(value) && (!axis.logarithmic || value > 0); }

/// One axis with its range, in the picture's pixels from `low` to `high`.
class Ruler {
public:
    Ruler(const Plot& plot, std::size_t coordinate)
        : logarithmic_((coordinate == 0 ? plot.x : plot.y).logarithmic),
          least_(std::numeric_limits<double>::infinity()),
          most_(-least_) {
        const PlotAxis& axis = coordinate == 0 ? plot.x : plot.y;
        for (const PlotSeries& series : plot.series)
            for (const auto& point : series.points)
                if (has_place(plot.x, point[0]) && has_place(plot.y, point[1])) include(point[coordinate]);
        if (least_ > most_) fail_input("plot", "no point has a place on the axis '" + axis.label + "'");
        if (axis.minimum) least_ = place(*axis.minimum);
        if (axis.maximum) most_ = place(*axis.maximum);
        if (!(most_ > least_)) {
            const double half = logarithmic_ ? 0.5 : std::max(std::abs(least_) / 2, 0.5);
            least_ -= half;
            most_ += half;
        } else {
            const double rim = 0.03 * (most_ - least_);
            if (!axis.minimum) least_ -= rim;
            if (!axis.maximum) most_ += rim;
        }
    }

    void stretch_over(double low, double high) { low_ = low, high_ = high; }
    [[nodiscard]] double pixel(double value) const { return low_ + (place(value) - least_) / (most_ - least_) * (high_ - low_); }

    [[nodiscard]] std::vector<Tick> ticks() const {
        std::vector<Tick> list;
        if (!logarithmic_ || most_ - least_ < 0.5) return even_ticks();
        const int decades = static_cast<int>(std::ceil(most_ - least_)), stride = std::max(1, decades / 8);
        for (int e = static_cast<int>(std::floor(least_)); e <= most_; ++e)
            for (const double digit : {1.0, 2.0, 5.0}) {
                if (digit > 1 ? decades > 2 : e % stride != 0) continue;
                const double value = digit * std::pow(10.0, e);
                if (place(value) < least_ || place(value) > most_) continue;
                list.push_back({value, power_text(value)});
            }
        return list;
    }

private:
    [[nodiscard]] double place(double value) const { return logarithmic_ ? std::log10(value) : value; }
    void include(double value) {
        least_ = std::min(least_, place(value));
        most_ = std::max(most_, place(value));
    }
    [[nodiscard]] std::vector<Tick> even_ticks() const {
        const auto value = [&](double at) { return logarithmic_ ? std::pow(10.0, at) : at; };
        const std::vector<double> values = ostraka::ticks({value(least_), value(most_), false, ""}, 6);
        std::vector<Tick> list;
        for (const double v : values) list.push_back({v, tick_text(v, values.size() > 1 ? values[1] - values[0] : v)});
        return list;
    }
    static std::string power_text(double value) {
        char text[32];
        if (value >= 1e-3 && value < 1e6) std::snprintf(text, sizeof text, "%.12g", value);
        else std::snprintf(text, sizeof text, "%.0e", value);
        return text;
    }

    bool logarithmic_;
    double least_, most_;  ///< places: values, or their logarithms
    double low_ = 0, high_ = 1;
};

class Sheet {
public:
    Sheet(int width, int height)
        : surface_(cairo_svg_surface_create_for_stream(&append, &bytes_, width, height), &cairo_surface_destroy),
          context_(cairo_create(surface_.get()), &cairo_destroy) {
        cairo_select_font_face(context_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
        cairo_set_font_size(context_.get(), text_size);
        cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
        colour({255, 255, 255});
        cairo_paint(context_.get());
    }

    void line(double x1, double y1, double x2, double y2, const Rgb& value, double width) {
        cairo_move_to(context_.get(), x1, y1);
        cairo_line_to(context_.get(), x2, y2);
        stroke(value, width, false);
    }
    void polyline(const std::vector<std::array<double, 2>>& places, const Rgb& value, bool dashed) {
        for (std::size_t i = 0; i < places.size(); ++i)
            (i == 0 ? cairo_move_to : cairo_line_to)(context_.get(), places[i][0], places[i][1]);
        stroke(value, 1.8, dashed);
    }
    void dot(double x, double y, const Rgb& value) {
        cairo_new_path(context_.get());
        cairo_arc(context_.get(), x, y, 3, 0, 2 * std::numbers::pi);
        colour(value);
        cairo_fill(context_.get());
    }
    double width_of(const std::string& words) {
        cairo_text_extents_t extents;
        cairo_text_extents(context_.get(), words.c_str(), &extents);
        return extents.x_advance;
    }
    /// `anchor`: the share of the text's width that lies left of x.
    void text(const std::string& words, double x, double y, double anchor) {
        cairo_move_to(context_.get(), x - anchor * width_of(words), y);
        colour(ink);
        cairo_show_text(context_.get(), words.c_str());
    }
    void upward_text(const std::string& words, double x, double y) {
        cairo_save(context_.get());
        cairo_translate(context_.get(), x, y);
        cairo_rotate(context_.get(), -std::numbers::pi / 2);
        text(words, 0, 0, 0.5);
        cairo_restore(context_.get());
    }
    void clip(double left, double top, double right, double bottom) {
        cairo_save(context_.get());
        cairo_rectangle(context_.get(), left, top, right - left, bottom - top);
        cairo_clip(context_.get());
    }
    void unclip() { cairo_restore(context_.get()); }

    std::string finish() {
        cairo_surface_finish(surface_.get());
        for (const cairo_status_t status : {cairo_status(context_.get()), cairo_surface_status(surface_.get())})
            if (status != CAIRO_STATUS_SUCCESS && status != CAIRO_STATUS_SURFACE_FINISHED)
                throw Error(ErrorKind::failure, "plot", std::string("drawing failed: ") + cairo_status_to_string(status));
        return std::move(bytes_);
    }

private:
    static cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
        static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
        return CAIRO_STATUS_SUCCESS;
    }
    void colour(const Rgb& value) {
        cairo_set_source_rgb(context_.get(), value.red / 255.0, value.green / 255.0, value.blue / 255.0);
    }
    void stroke(const Rgb& value, double width, bool dashed) {
        const double dash[] = {7, 4};
        cairo_set_dash(context_.get(), dash, dashed ? 2 : 0, 0);
        colour(value);
        cairo_set_line_width(context_.get(), width);
        cairo_stroke(context_.get());
    }

    std::string bytes_;
    std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
    std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context_;
};

void draw(Sheet& sheet, const Plot& plot, const PlotSeries& series, const Rgb& colour, const Ruler& x, const Ruler& y) {
    std::vector<std::array<double, 2>> run;
    const auto end_run = [&] {
        sheet.polyline(run, colour, series.dashed);
        if (series.marked)
            for (const auto& place : run) sheet.dot(place[0], place[1], colour);
        run.clear();
    };
    for (const auto& point : series.points) {
        if (has_place(plot.x, point[0]) && has_place(plot.y, point[1])) run.push_back({x.pixel(point[0]), y.pixel(point[1])});
        else end_run();
    }
    end_run();
}

}  // namespace

std::string svg_bytes(const Plot& plot) {
    Ruler x(plot, 0), y(plot, 1);
    Sheet sheet(plot.width, plot.height);
    double widest_tick = 0, widest_name = 0;
    for (const Tick& tick : y.ticks()) widest_tick = std::max(widest_tick, sheet.width_of(tick.text));
    for (const PlotSeries& series : plot.series) widest_name = std::max(widest_name, sheet.width_of(series.name));
    const double left = margin + 1.6 * text_size + widest_tick + 8, top = margin + 1.8 * text_size,
                 right = plot.width - 2 * margin - 34 - widest_name, bottom = plot.height - margin - 3.2 * text_size;
    x.stretch_over(left, right);
    y.stretch_over(bottom, top);
    for (const Tick& tick : x.ticks()) {
        sheet.line(x.pixel(tick.value), top, x.pixel(tick.value), bottom, grid, 1);
        sheet.text(tick.text, x.pixel(tick.value), bottom + 1.4 * text_size, 0.5);
    }
    for (const Tick& tick : y.ticks()) {
        sheet.line(left, y.pixel(tick.value), right, y.pixel(tick.value), grid, 1);
        sheet.text(tick.text, left - 6, y.pixel(tick.value) + 0.35 * text_size, 1);
    }
    sheet.line(left, bottom, right, bottom, ink, 1);
    sheet.line(left, top, left, bottom, ink, 1);
    sheet.text(plot.title, left, margin + 0.8 * text_size, 0);
    sheet.text(plot.x.label, (left + right) / 2, plot.height - margin, 0.5);
    sheet.upward_text(plot.y.label, margin + 0.8 * text_size, (top + bottom) / 2);
    for (std::size_t i = 0; i < plot.series.size(); ++i) {
        const Rgb& colour = colours[i % colours.size()];
        const double row = top + (static_cast<double>(i) + 0.5) * 1.6 * text_size;
        sheet.polyline({{right + margin, row}, {right + margin + 26, row}}, colour, plot.series[i].dashed);
        if (plot.series[i].marked) sheet.dot(right + margin + 13, row, colour);
        sheet.text(plot.series[i].name, right + margin + 34, row + 0.35 * text_size, 0);
    }
    sheet.clip(left, top, right, bottom);
    for (std::size_t i = 0; i < plot.series.size(); ++i) draw(sheet, plot, plot.series[i], colours[i % colours.size()], x, y);
    sheet.unclip();
    return sheet.finish();
}

void write_plot(const Path& file, const Plot& plot) {
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
    write_file(file, svg_bytes(plot));
}

}  // namespace ostraka::experiments
