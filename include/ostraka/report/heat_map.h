// Matrices as coloured squares.
#pragma once

#include "ostraka/core/file.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct HeatMap {
    std::string title;
    Eigen::MatrixXd values;  ///< NaN: no value, drawn grey
    std::vector<std::string> rows, columns;
    std::string label;                                 ///< what the numbers are, with their unit
    std::optional<double> minimum = {}, maximum = {};  ///< of the colours; else those of the finite values
    bool numbers = false;                              ///< written into the squares, where these are large enough
    std::vector<int> groups = {};  ///< of rows and columns, or none: lines are drawn between different neighbours
};

/// Writes it as an SVG, or as a PNG of twice the size where the file's name ends in .png, atomically, folders and all: square
/// fields, as small as it takes to keep the map at about 800 points. Throws Error (input) for a matrix without a finite value,
/// Error (usage) where names or groups are not one a row and column.
void write_plot(const Path& file, const HeatMap& map);

}  // namespace ostraka
