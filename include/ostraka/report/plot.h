// Plots as SVG or PNG: lines, points with classes and labels, bars, intervals.
#pragma once

#include "ostraka/core/file.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct PlotAxis {
    std::string label = {};  ///< with the unit
    bool logarithmic = false;
    std::optional<double> minimum = {}, maximum = {};  ///< else what the points need
    std::vector<std::string> names = {};               ///< instead of numbers: of the places 0, 1, 2 ...
};

enum class Mark { dots, bars };

struct PlotSeries {
    std::string name = {};                           ///< for the legend; without one it stands not there
    std::vector<std::array<double, 2>> points = {};  ///< x, y; the line is broken where a point has no place on the axes
    bool marked = true;                              ///< a mark at each point: of another form for each class of unjoined points
    bool dashed = false;
    bool joined = true;                                                ///< by a line
    std::vector<std::string> labels = {};                              ///< written beside the points; empty, or one a point
    std::vector<std::optional<std::array<double, 2>>> intervals = {};  ///< low and high y of each point, or none
    std::optional<std::size_t> colour = {};                            ///< number of its colour; else the series' own number
    double thickness = 1.8;                                            ///< of the line
    Mark mark = Mark::dots;                                            ///< bars stand on y = 0, or on the axis' lower end
};

/// A line across the whole plot, with words at its end.
struct PlotLine {
    double value = 0;
    bool upright = false;  ///< at an x instead of at a y
    std::string label;
};

struct Plot {
    std::string title;
    PlotAxis x = {}, y = {};
    std::vector<PlotSeries> series = {};
    int width = 760, height = 480;
    bool square = false;  ///< the area of the axes is a square, as for receiver operating characteristics
    bool equal = false;   ///< a unit is as long along x as along y: for places
    std::vector<PlotLine> lines = {};
};

/// Writes it as an SVG, or as a PNG of twice the size where the file's name ends in .png, atomically, folders and all; the same
/// bytes for the same plot. Throws Error (input) where no point has a place on the axes, and Error (usage) where there are labels
/// or intervals but not one a point.
void write_plot(const Path& file, const Plot& plot);

}  // namespace ostraka
