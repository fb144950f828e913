// Line fitting.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace ostraka {

/// Mean of the points and direction of largest variance (unit vector of either sign); `rms` is the root mean square distance
/// from the line.
struct LineFit {
    Eigen::Vector3d point{0, 0, 0}, direction{0, 0, 1};
    double rms = 0;
};

/// The line with minimum squared distance to weighted points (total least squares). The sum of weights must be positive.
LineFit fit_line(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights);

}  // namespace ostraka
