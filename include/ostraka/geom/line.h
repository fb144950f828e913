// Line fitting.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace ostraka {

/// A line fitted to points.
struct LineFit {
    /// A point of the line (the weighted mean of the points), and its unit direction (of largest variance; the sign is
    /// arbitrary).
    Eigen::Vector3d point{0, 0, 0}, direction{0, 0, 1};
    double rms = 0;  ///< root mean square distance of the points from the line
};

/// The line that minimises the weighted sum of squared distances of the points (total least squares). The sum of weights must be
/// positive.
LineFit fit_line(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights);

}  // namespace ostraka
