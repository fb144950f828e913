#include "ostraka/figures/heat_map.h"

#include "figures/sheet.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/render/colour_scale.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

namespace {

using namespace figures;

constexpr double largest_name = 170, wished_size = 800;

void check(const HeatMap& map) {
    const auto rows = static_cast<std::size_t>(map.values.rows()), columns = static_cast<std::size_t>(map.values.cols());
    if (map.rows.size() != rows || map.columns.size() != columns)
        fail_usage(fmt::format("a heat map of {} rows and {} columns has {} and {} names", rows, columns, map.rows.size(),
                               map.columns.size()),
                   "give one name per row and per column");
    if (!map.groups.empty() && (map.groups.size() != rows || rows != columns))
        fail_usage("the groups of a heat map do not match its rows and columns", "give one per row of a square matrix");
}

ColourScale colours(const HeatMap& map) {
    const std::vector<double> values(map.values.data(), map.values.data() + map.values.size());
    ColourScale scale = scale_of({&values}, "heat map");
    scale.label = map.label;
    if (map.minimum) scale.minimum = *map.minimum;
    if (map.maximum) scale.maximum = *map.maximum;
    return scale;
}

double lightness(const Rgb& c) { return (0.299 * c.red + 0.587 * c.green + 0.114 * c.blue) / 255; }

std::string draw(const HeatMap& map, Sheet::Format format) {
    check(map);
    const ColourScale scale = colours(map);
    const auto rows = static_cast<double>(map.values.rows()), columns = static_cast<double>(map.values.cols());
    const double cell = std::clamp(wished_size / std::max(rows, columns), 3.0, map.numbers ? 44.0 : 26.0);
    const double name_size = std::min(text_size - 1, 0.95 * cell);
    double left = margin, below = 0, key = 0;
    const std::vector<double> steps = ticks(scale, 6);
    const double step = steps.size() > 1 ? steps[1] - steps[0] : steps[0];
    {
        Sheet measure(10, 10);
        for (const std::string& name : map.rows)
            left = std::max(left, margin + 6 + std::min(largest_name, measure.width_of(name, name_size)));
        for (const std::string& name : map.columns)
            below = std::max(below, 6 + std::min(largest_name, measure.width_of(name, name_size)));
        for (const double value : steps) key = std::max(key, measure.width_of(tick_text(value, step)));
        left = std::max(left, margin + 6);
        key = std::max(key + 46, measure.width_of(map.title) - columns * cell - 10);
    }
    const double top = margin + 1.8 * text_size, right = left + columns * cell, bottom = top + rows * cell;
    const double key_height = std::max(bottom - top, 90.0);
    Sheet sheet(right + key + 2 * margin + 1.6 * text_size, std::max(bottom + below, top + key_height) + margin, format);
    sheet.text(map.title, left, margin + 0.8 * text_size, 0);
    for (Eigen::Index i = 0; i < map.values.rows(); ++i)
        for (Eigen::Index j = 0; j < map.values.cols(); ++j) {
            const double x = left + static_cast<double>(j) * cell, y = top + static_cast<double>(i) * cell;
            const Rgb colour = colour_of(scale, map.values(i, j));
            // Overlaps the edge slightly, so that no gap appears between cells.
            sheet.rectangle({x, y, std::min(x + cell + 0.3, right), std::min(y + cell + 0.3, bottom)}, colour);
        }
    if (map.numbers && cell >= 24)
        for (Eigen::Index i = 0; i < map.values.rows(); ++i)
            for (Eigen::Index j = 0; j < map.values.cols(); ++j)
                if (std::isfinite(map.values(i, j)))
                    sheet.text(digits(map.values(i, j), 2), left + (static_cast<double>(j) + 0.5) * cell,
                               top + (static_cast<double>(i) + 0.5) * cell + 3.5, 0.5, 10,
                               lightness(colour_of(scale, map.values(i, j))) > 0.55 ? ink : paper);
    for (std::size_t i = 0; i + 1 < map.groups.size(); ++i)
        if (map.groups[i] != map.groups[i + 1]) {
            const double at = static_cast<double>(i + 1) * cell;
            sheet.line(left, top + at, right, top + at, paper, 1.4);
            sheet.line(left + at, top, left + at, bottom, paper, 1.4);
        }
    for (std::size_t i = 0; i < map.rows.size(); ++i)
        sheet.text(sheet.fitted(map.rows[i], largest_name, name_size), left - 6,
                   top + (static_cast<double>(i) + 0.5) * cell + 0.35 * name_size, 1, name_size);
    for (std::size_t j = 0; j < map.columns.size(); ++j)
        sheet.upward_text(sheet.fitted(map.columns[j], largest_name, name_size),
                          left + (static_cast<double>(j) + 0.5) * cell + 0.35 * name_size, bottom + 6, 1, name_size);

    const double key_left = right + margin + 4, key_bottom = top + key_height;
    const int stripes = 128;
    for (int s = 0; s < stripes; ++s) {
        const double low = key_bottom - key_height * s / stripes, high = key_bottom - key_height * (s + 1) / stripes;
        sheet.rectangle({key_left, high - (s + 1 < stripes ? 0.3 : 0), key_left + 16, low},
                        colour_of(scale, scale.minimum + (s + 0.5) / stripes * (scale.maximum - scale.minimum)));
    }
    for (const double value : steps) {
        if (!(scale.maximum > scale.minimum)) break;
        const double y = key_bottom - (value - scale.minimum) / (scale.maximum - scale.minimum) * key_height;
        sheet.line(key_left + 16, y, key_left + 20, y, ink, 1);
        sheet.text(tick_text(value, step), key_left + 24, y + 0.35 * text_size, 0);
    }
    sheet.upward_text(map.label, right + key + margin + 1.6 * text_size, (top + key_bottom) / 2);
    return sheet.finish();
}

}  // namespace

void write_plot(const Path& file, const HeatMap& map) {
    figures::write_sheet(file, [&](figures::Sheet::Format format) { return draw(map, format); });
}

}  // namespace ostraka
