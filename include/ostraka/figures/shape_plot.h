// A scatter plot of shapes, with the shapes at the ends of both axes drawn beside them.
#pragma once

#include "ostraka/files/file.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// A shape drawn beside an axis. Coordinates are those of the shape: y points up.
struct DrawnShape {
    std::string title;                                           ///< text above the shape
    std::vector<std::vector<std::array<double, 2>>> grid = {};   ///< pale lines, such as a deformed grid
    std::vector<std::vector<std::array<double, 2>>> lines = {};  ///< lines between landmarks, or from the mean to the shape
    std::vector<std::array<double, 2>> points = {};              ///< landmarks
};

/// One group of points of the scatter plot.
struct ScatterGroup {
    std::string name = {};                           ///< name in the legend; empty: not in the legend
    std::vector<std::array<double, 2>> points = {};  ///< x and y of each point
    std::vector<std::string> labels = {};            ///< text beside each point; empty: no texts
};

/// The plot and its shapes.
struct ShapePlot {
    std::string title, x_label, y_label;
    std::vector<ScatterGroup> groups;
    DrawnShape left, right, bottom, top;  ///< shapes at the ends of the x and y axes; without points: not drawn
};

/// Writes the plot as SVG, PDF or PNG, by the extension, atomically; x and y have equal scale, and all shapes have one scale.
/// Throws Error (input) if there is no finite point.
void write_shape_plot(const Path& file, const ShapePlot& plot);

}  // namespace ostraka
