// Heat maps of matrices.
#pragma once

#include "ostraka/files/file.h"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A plot of a matrix as coloured cells.
struct HeatMap {
    std::string title;                       ///< title of the plot
    Eigen::MatrixXd values;                  ///< the matrix; NaN entries have no value and are drawn grey
    std::vector<std::string> rows, columns;  ///< names of the rows and of the columns of `values`
    std::string label;                       ///< name of the quantity, with its unit
    /// Ends of the colour range; none: smallest and largest finite value.
    std::optional<double> minimum = {}, maximum = {};
    bool numbers = false;  ///< true: values are written into the cells, if the cells are large enough
    /// For each row (and column): index of its group; lines separate adjacent rows of different groups; empty: no lines.
    std::vector<int> groups = {};
};

/// Writes the heat map as an SVG, or as a PNG of twice the size if the file name ends in .png, atomically, creating folders.
/// The cells are square, and as small as needed to keep the map at about 800 points. Throws Error (input) for a matrix without
/// a finite value, Error (usage) unless names and groups have one entry per row and column.
void write_plot(const Path& file, const HeatMap& map);

}  // namespace ostraka
