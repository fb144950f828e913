// Heat maps of matrices.
#pragma once

#include "ostraka/files/file.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct HeatMap {
    std::string title;
    Eigen::MatrixXd values;  ///< NaN: no value, drawn grey
    std::vector<std::string> rows, columns;
    std::string label;                                 ///< name of the quantity, with its unit
    std::optional<double> minimum = {}, maximum = {};  ///< colour range; by default that of the finite values
    bool numbers = false;          ///< whether the numbers are written into the squares, if these are large enough
    std::vector<int> groups = {};  ///< groups of rows and columns, or empty: lines separate neighbours of different groups
};

/// Writes the heat map as an SVG, or as a PNG of twice the size if the file name ends in .png, atomically, creating folders.
/// The cells are square, and as small as needed to keep the map at about 800 points. Throws Error (input) for a matrix without
/// a finite value, Error (usage) unless names and groups have one entry per row and column.
void write_plot(const Path& file, const HeatMap& map);

}  // namespace ostraka
