// Plots as SVG or PNG: lines, points with classes and labels, bars, intervals.
#pragma once

#include "ostraka/files/file.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// The x or y axis of a plot.
struct PlotAxis {
    std::string label = {};    ///< label of the axis, including the unit
    bool logarithmic = false;  ///< true: logarithmic scale
    /// Ends of the range; none: smallest and largest value of the points.
    std::optional<double> minimum = {}, maximum = {};
    std::vector<std::string> names = {};  ///< names of the positions 0, 1, 2 ..., shown instead of numbers
};

enum class Mark { dots, bars };  ///< how points are drawn

/// Points of a plot that share one style.
struct PlotSeries {
    std::string name = {};  ///< name in the legend; series without a name are not in the legend
    /// X and y of each point; the line is interrupted at points outside the domain of the axes.
    std::vector<std::array<double, 2>> points = {};
    /// True: a mark at each point; if the points are not joined, its shape depends on the series.
    bool marked = true;
    bool dashed = false;                   ///< true: the line is dashed
    bool joined = true;                    ///< true: a line joins the points
    std::vector<std::string> labels = {};  ///< text beside each point; empty: no texts
    /// For each point: lower and upper end of the interval of y; none: no interval at the point. Empty: no intervals.
    std::vector<std::optional<std::array<double, 2>>> intervals = {};
    std::optional<std::size_t> colour = {};  ///< index of the colour of the series; none: the index of the series
    double thickness = 1.8;                  ///< line width
    Mark mark = Mark::dots;                  ///< shape of the points; bars start at y = 0, or at the lower end of the axis
};

/// A straight line across the whole plot, with text at its end.
struct PlotLine {
    double value = 0;      ///< y value (or x value) of the line
    bool upright = false;  ///< true: a vertical line at an x value; false: a horizontal line at a y value
    std::string label;     ///< text at the end of the line
};

/// A plot of series over two axes.
struct Plot {
    std::string title;  ///< title of the plot
    PlotAxis x = {}, y = {};
    std::vector<PlotSeries> series = {};  ///< drawn in this order
    int width = 760, height = 480;        ///< size of the SVG in points
    bool square = false;                  ///< true: the plot area is square, as for receiver operating characteristics
    bool equal = false;                   ///< true: x and y have equal scale, as for positions
    std::vector<PlotLine> lines = {};     ///< straight lines across the plot
};

/// Writes the plot as an SVG, or as a PNG of twice the size if the file name ends in .png, atomically, creating folders; the same
/// plot gives the same bytes. Throws Error (input) if no point lies in the domain of the axes, and Error (usage) if a series has
/// labels or intervals, but not one per point.
void write_plot(const Path& file, const Plot& plot);

}  // namespace ostraka
