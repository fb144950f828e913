#include "figures/ruler.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/render/colour_scale.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace ostraka::figures {

namespace {

std::string power_text(double value) {
    if (value >= 1e-3 && value < 1e6) return digits(value, 12);
    char text[32];
    std::snprintf(text, sizeof text, "%.0e", value);
    return text;
}

}  // namespace

bool has_place(const PlotAxis& axis, double value) { return std::isfinite(value) && (!axis.logarithmic || value > 0); }

Ruler::Ruler(const Plot& plot, std::size_t coordinate)
    : axis_(coordinate == 0 ? &plot.x : &plot.y),
      logarithmic_(axis_->logarithmic),
      minimum_(std::numeric_limits<double>::infinity()),
      maximum_(-minimum_) {
    for (const PlotSeries& series : plot.series)
        for (std::size_t i = 0; i < series.points.size(); ++i) {
            const auto& point = series.points[i];
            if (!has_place(plot.x, point[0]) || !has_place(plot.y, point[1])) continue;
            include(point[coordinate]);
            if (series.mark == Mark::bars && coordinate == 1 && !logarithmic_) include(0);
            if (series.mark == Mark::bars && coordinate == 0 && !logarithmic_) include(point[0] - 0.5), include(point[0] + 0.5);
            if (coordinate == 1 && i < series.intervals.size() && series.intervals[i])
                for (const double end : *series.intervals[i])
                    if (has_place(plot.y, end)) include(end);
        }
    if (minimum_ > maximum_) fail_input("plot", fmt::format("no point can be shown on the axis '{}'", axis_->label));
    if (!axis_->names.empty()) include(-0.5), include(static_cast<double>(axis_->names.size()) - 0.5);
    for (const PlotLine& plot_line : plot.lines)
        if (plot_line.upright == (coordinate == 0) && has_place(*axis_, plot_line.value)) include(plot_line.value);
    if (axis_->minimum) minimum_ = place(*axis_->minimum);
    if (axis_->maximum) maximum_ = place(*axis_->maximum);
    if (!(maximum_ > minimum_)) {
        const double half = logarithmic_ ? 0.5 : std::max(std::abs(minimum_) / 2, 0.5);
        minimum_ -= half;
        maximum_ += half;
    } else if (axis_->names.empty()) {
        const double rim = 0.03 * (maximum_ - minimum_);
        // The lower end stays at the base line of bars.
        const bool on_zero =
            coordinate == 1 && minimum_ == 0 && !logarithmic_ &&
            std::any_of(plot.series.begin(), plot.series.end(), [](const auto& s) { return s.mark == Mark::bars; });
        if (!axis_->minimum && !on_zero) minimum_ -= rim;
        if (!axis_->maximum) maximum_ += rim;
    }
}

double Ruler::place(double value) const { return logarithmic_ ? std::log10(value) : value; }

void Ruler::include(double value) {
    minimum_ = std::min(minimum_, place(value));
    maximum_ = std::max(maximum_, place(value));
}

double Ruler::lowest() const { return logarithmic_ ? std::pow(10.0, minimum_) : minimum_; }

void Ruler::widen(double extent) {
    const double margin_each = (extent - (maximum_ - minimum_)) / 2;
    minimum_ -= margin_each;
    maximum_ += margin_each;
}

std::vector<Tick> Ruler::ticks() const {
    std::vector<Tick> tick_list;
    if (!axis_->names.empty()) {
        for (std::size_t i = 0; i < axis_->names.size(); ++i) tick_list.push_back({static_cast<double>(i), axis_->names[i]});
        return tick_list;
    }
    if (!logarithmic_ || maximum_ - minimum_ < 0.5) return even_ticks();
    const int decades = static_cast<int>(std::ceil(maximum_ - minimum_)), stride = std::max(1, decades / 8);
    for (int e = static_cast<int>(std::floor(minimum_)); e <= maximum_; ++e)
        for (const double digit : {1.0, 2.0, 5.0}) {
            if (digit > 1 ? decades > 2 : e % stride != 0) continue;
            const double value = digit * std::pow(10.0, e);
            if (place(value) < minimum_ || place(value) > maximum_) continue;
            tick_list.push_back({value, power_text(value)});
        }
    return tick_list;
}

std::vector<Tick> Ruler::even_ticks() const {
    const auto value = [&](double at) { return logarithmic_ ? std::pow(10.0, at) : at; };
    const std::vector<double> values = ostraka::ticks({value(minimum_), value(maximum_), false, ""}, 6);
    std::vector<Tick> tick_list;
    for (const double v : values) tick_list.push_back({v, tick_text(v, values.size() > 1 ? values[1] - values[0] : v)});
    return tick_list;
}

}  // namespace ostraka::figures
