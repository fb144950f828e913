// Straight lines through points.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace ostraka {

/// Mean and direction (unit vector, of either sign) of largest spread; `rms` is that of the distances from the line.
struct LineFit {
    Eigen::Vector3d point{0, 0, 0}, direction{0, 0, 1};
    double rms = 0;
};

/// The line of least squared distance from weighted points (total least squares). Needs a positive sum of weights.
LineFit fit_line(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights);

}  // namespace ostraka
