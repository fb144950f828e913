#include "ostraka/figures/map_figure.h"

#include "figures/sheet.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

using namespace figures;

constexpr int bin_count = 41;  // odd: one bar stands about the middle of a diverging scale
constexpr double histogram_width = 190, tick_width = 64, bar_margin = 18;

/// Shares of the finite values per bar.
std::vector<double> histogram(const MapFigure& figure) {
    std::vector<double> shares(bin_count, 0);
    double count = 0;
    const double range = figure.scale.maximum - figure.scale.minimum;
    for (const double value : figure.values) {
        if (!std::isfinite(value)) continue;
        const double place = range > 0 ? (value - figure.scale.minimum) / range : 0.5;
        const double bar = std::floor(std::clamp(place, 0.0, 1.0) * bin_count);
        ++shares[static_cast<std::size_t>(std::min(bar, bin_count - 1.0))];
        ++count;
    }
    if (count == 0) fail_input("map", "the map contains no finite value", "give a map with at least one finite value");
    for (double& share : shares) share /= count;
    return shares;
}

/// Bars to the right, with the values of the map upwards.
void draw_histogram(Sheet& sheet, const MapFigure& figure, const Box& area) {
    const std::vector<double> shares = histogram(figure);
    const double largest = *std::max_element(shares.begin(), shares.end());
    const double height = (area.bottom - area.top) / bin_count, range = figure.scale.maximum - figure.scale.minimum;
    const auto place_of = [&](double value) {
        return area.bottom - (range > 0 ? (value - figure.scale.minimum) / range : 0.5) * (area.bottom - area.top);
    };
    for (int i = 0; i < bin_count; ++i) {
        const double bottom = area.bottom - i * height, top = bottom - height;
        const Rgb colour = colour_of(figure.scale, figure.scale.minimum + (i + 0.5) / bin_count * range);
        sheet.rectangle({area.left - bar_margin, top - 0.3, area.left - 6, bottom}, colour);
        const double width = shares[static_cast<std::size_t>(i)] / largest * (area.right - area.left);
        const Box bar{area.left, top + 0.5, area.left + width, bottom - 0.5};
        sheet.rectangle(bar, colour);
        if (width > 0.5) sheet.frame(bar, quiet_line, 0.5);
    }
    sheet.line(area.left, area.top, area.left, area.bottom, ink, 1);
    const std::vector<double> values = ticks(figure.scale, 8);
    const double step = values.size() > 1 ? values[1] - values[0] : 1;
    for (const double value : values) {
        const double y = place_of(value);
        sheet.line(area.left - bar_margin - 4, y, area.left - bar_margin, y, ink, 1);
        sheet.text(tick_text(value, step), area.left - bar_margin - 7, y + 0.35 * text_size, 1);
    }
    for (const double value : figure.lines)
        if (value > figure.scale.minimum && value < figure.scale.maximum)
            sheet.line(area.left - bar_margin, place_of(value), area.right, place_of(value), ink, 1, true);
    sheet.text(digits(100 * largest, 2) + " % of the area", area.right, area.top - 5, 1, text_size - 2);
}

std::string draw(const MapFigure& figure, Sheet::Format format) {
    constexpr double pixels_per_point = 2;
    const double width = figure.picture.width / pixels_per_point,
                 height = std::max(220.0, figure.picture.height / pixels_per_point);
    const double top = margin + 2 * text_size, left = margin;
    const Box area{left + width + margin + tick_width + bar_margin, top + text_size,
                   left + width + margin + tick_width + bar_margin + histogram_width, top + height};
    const double line = 1.5 * text_size;
    Sheet sheet(area.right + margin + 1.6 * text_size,
                top + height + line * static_cast<double>(figure.facts.size()) + 2 * margin, format);
    const double right = area.right + margin;
    sheet.text(sheet.fitted(figure.title, right - left), left, margin + 0.8 * text_size, 0, text_size + 1);
    sheet.image(figure.picture, {left, top, left + width, top + figure.picture.height / pixels_per_point});
    draw_histogram(sheet, figure, area);
    sheet.upward_text(figure.scale.label, area.right + margin + text_size, (area.top + area.bottom) / 2);
    for (std::size_t i = 0; i < figure.facts.size(); ++i)
        sheet.text(sheet.fitted(figure.facts[i], right - left), left,
                   top + height + margin + line * (static_cast<double>(i) + 0.7), 0);
    return sheet.finish();
}

}  // namespace

void write_plot(const Path& file, const MapFigure& figure) {
    figures::write_sheet(file, [&](figures::Sheet::Format format) { return draw(figure, format); });
}

}  // namespace ostraka
