#include "ostraka/figures/bracket_graph.h"

#include "figures/sheet.h"

#include <algorithm>
#include <map>

namespace ostraka {

namespace {

using namespace figures;

constexpr double line_height = 22, indent = 18, lane_width = 14, longest_name = 320;

std::string draw(const BracketGraph& graph, Sheet::Format format) {
    std::map<std::string, std::size_t> types;
    for (const auto& bracket : graph.brackets) types.try_emplace(bracket.type, 0);
    std::size_t number = 0;
    for (auto& [type, index] : types) index = number++;
    double names = 0, legend = 0;
    int lanes = 0;
    Sheet measure(10, 10);
    for (const auto& row : graph.rows)
        names = std::max(names, row.depth * indent + 22 + std::min(longest_name, measure.width_of(row.name)));
    for (const auto& [type, index] : types) legend = std::max(legend, 40 + measure.width_of(type));
    for (const auto& bracket : graph.brackets) lanes = std::max(lanes, bracket.lane + 1);
    const double top = margin + (graph.title.empty() ? 0 : 2 * text_size), begin = margin + names + 12;
    const double right = begin + lanes * lane_width + lane_width;
    const double bottom =
        top + std::max(static_cast<double>(graph.rows.size()) * line_height, static_cast<double>(types.size()) * 1.6 * text_size);
    Sheet sheet(std::max(right + legend, measure.width_of(graph.title) + margin) + margin, bottom + margin, format);
    if (!graph.title.empty()) sheet.text(graph.title, margin, margin + 0.8 * text_size, 0);
    const auto middle = [&](std::size_t row) { return top + (static_cast<double>(row) + 0.5) * line_height; };
    for (const auto& bracket : graph.brackets) {
        if (bracket.rows.empty()) continue;
        const double x = begin + (bracket.lane + 0.5) * lane_width, width = bracket.strong ? 3 : 1.4;
        const Rgb colour = series_colour(types.at(bracket.type));
        const auto [low, high] = std::minmax_element(bracket.rows.begin(), bracket.rows.end());
        sheet.line(x, middle(*low), x, middle(*high), colour, width);
        for (const std::size_t row : bracket.rows) sheet.line(x - 0.5 * lane_width, middle(row), x, middle(row), colour, width);
        if (bracket.directed) sheet.dot(x - 0.5 * lane_width, middle(bracket.rows.front()), colour, 3);
    }
    std::vector<std::size_t> above;  // current row at each depth
    for (std::size_t r = 0; r < graph.rows.size(); ++r) {
        const auto& row = graph.rows[r];
        const auto depth = static_cast<std::size_t>(std::max(0, row.depth));
        above.resize(depth + 1, r);
        above[depth] = r;
        const double x = margin + row.depth * indent, y = middle(r);
        if (depth > 0) {
            sheet.line(x - indent / 2, middle(above[depth - 1]) + 7, x - indent / 2, y, quiet_line, 1);
            sheet.line(x - indent / 2, y, x, y, quiet_line, 1);
        }
        sheet.rectangle({x + 2, y - 6, x + 14, y + 6}, row.colour);
        sheet.frame({x + 2, y - 6, x + 14, y + 6}, ink, 0.6);
        sheet.text(sheet.fitted(row.name, longest_name), x + 20, y + 0.35 * text_size, 0);
    }
    double y = top + 0.8 * text_size;
    for (const auto& [type, index] : types) {
        sheet.line(right + 6, y, right + 28, y, series_colour(index), 2.4);
        sheet.text(type, right + 34, y + 0.35 * text_size, 0);
        y += 1.6 * text_size;
    }
    return sheet.finish();
}

}  // namespace

void write_plot(const Path& file, const BracketGraph& graph) {
    figures::write_sheet(file, [&](figures::Sheet::Format format) { return draw(graph, format); });
}

}  // namespace ostraka
