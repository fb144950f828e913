// Line plots as SVG.
#pragma once

#include "ostraka/core/file.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ostraka::experiments {

struct PlotAxis {
    std::string label;  ///< with the unit
    bool logarithmic = false;
    std::optional<double> minimum, maximum;  ///< else what the points need
};

struct PlotSeries {
    std::string name;                           ///< for the legend
    std::vector<std::array<double, 2>> points;  ///< x, y; the line is broken where a point has no place on the axes
    bool marked = true;                         ///< a dot at each point
    bool dashed = false;
};

struct Plot {
    std::string title;
    PlotAxis x, y;
    std::vector<PlotSeries> series;
    int width = 760, height = 480;
};

/// The plot as an SVG file's bytes. Throws Error (input) where no point has a place on the axes.
std::string svg_bytes(const Plot& plot);
/// Writes it atomically, folders and all.
void write_plot(const Path& file, const Plot& plot);

}  // namespace ostraka::experiments
