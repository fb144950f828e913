// Scale between two landmark configurations, and their dissimilarity, from the landmarks that move rigidly together.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace ostraka {

/// Weighted median, by distance in `from`, of the ratios of distances between nearby landmarks: each with its three nearest
/// ones in `from`. Posture changes only distances across joints, a minority; within a rigid part all ratios equal the scale.
/// Exact for similar configurations. 0 for fewer than two landmarks, or if all nearby ones coincide. Throws Error (usage) for
/// lists of different lengths.
double rigid_scale(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to);

/// Relative deviation of the distances between those nearby landmarks from that scale: again a weighted median. 0 for the same
/// shape in another posture, as long as most nearby landmarks belong to one rigid part. Nothing for fewer than six landmarks,
/// or six such distances: distinguishing posture from shape needs two parts of three landmarks. Errors as above.
std::optional<double> rigid_strain(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to);

}  // namespace ostraka
