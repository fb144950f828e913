// Line fitting.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace ostraka {

/// A line fitted to points.
struct LineFit {
    /// Mean of the points; unit vector of largest variance, of either sign.
    Eigen::Vector3d point{0, 0, 0}, direction{0, 0, 1};
    double rms = 0;  ///< root mean square distance of the points from the line
};

/// The line that minimises the weighted sum of squared distances of the points (total least squares). The sum of weights must be
/// positive.
LineFit fit_line(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights);

}  // namespace ostraka
