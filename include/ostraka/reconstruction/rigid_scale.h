// Compares two landmark configurations that may differ in posture: their scale, and their difference in shape, estimated from
// landmarks on common rigid parts.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace ostraka {

/// Scale from configuration `from` to configuration `to`: weighted median of the ratios of distances between neighbouring
/// landmarks (each landmark with its three nearest in `from`), weighted by the distance in `from`. A change of posture changes
/// only distances across joints, which are a minority; within a rigid part all ratios equal the scale. The result is exact for
/// similar configurations, and 0 for fewer than two landmarks or if all neighbouring landmarks coincide. Throws Error (usage)
/// for lists of different lengths.
double rigid_scale(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to);

/// Relative deviation (a weighted median) of the distances between neighbouring landmarks from the distances that `rigid_scale`
/// predicts. The result is 0 for the same shape in another posture if most pairs of neighbouring landmarks lie on a common
/// rigid part. The result is empty for fewer than six landmarks or six distances: distinguishing posture from shape needs two
/// parts of three landmarks each. Throws Error (usage) for lists of different lengths.
std::optional<double> rigid_strain(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to);

}  // namespace ostraka
