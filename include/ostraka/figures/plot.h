// Plots as SVG or PNG: lines, points with classes and labels, bars, intervals.
#pragma once

#include "ostraka/files/file.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct PlotAxis {
    std::string label = {};  ///< including the unit
    bool logarithmic = false;
    std::optional<double> minimum = {}, maximum = {};  ///< range; by default that of the points
    std::vector<std::string> names = {};               ///< names of the positions 0, 1, 2 ..., shown instead of numbers
};

enum class Mark { dots, bars };

struct PlotSeries {
    std::string name = {};                           ///< name in the legend; series without a name are not in the legend
    std::vector<std::array<double, 2>> points = {};  ///< x, y; the line is interrupted at points outside the domain of the axes
    bool marked = true;  ///< a mark at each point; the shape depends on the class if the points are not joined
    bool dashed = false;
    bool joined = true;                    ///< whether a line joins the points
    std::vector<std::string> labels = {};  ///< texts beside the points; empty, or one per point
    /// Lower and upper y of each point; empty, or one per point.
    std::vector<std::optional<std::array<double, 2>>> intervals = {};
    std::optional<std::size_t> colour = {};  ///< index of its colour; by default the index of the series
    double thickness = 1.8;                  ///< line width
    Mark mark = Mark::dots;                  ///< bars start at y = 0, or at the lower end of the axis
};

/// A line across the whole plot, with text at its end.
struct PlotLine {
    double value = 0;
    bool upright = false;  ///< at an x value instead of a y value
    std::string label;
};

struct Plot {
    std::string title;
    PlotAxis x = {}, y = {};
    std::vector<PlotSeries> series = {};
    int width = 760, height = 480;
    bool square = false;  ///< square plot area, as for receiver operating characteristics
    bool equal = false;   ///< equal scale of x and y, for positions
    std::vector<PlotLine> lines = {};
};

/// Writes the plot as an SVG, or as a PNG of twice the size if the file name ends in .png, atomically, creating folders; the
/// same plot gives the same bytes. Throws Error (input) if no point lies in the domain of the axes, and Error (usage) if labels
/// or intervals are given but not one per point.
void write_plot(const Path& file, const Plot& plot);

}  // namespace ostraka
