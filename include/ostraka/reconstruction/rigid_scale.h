// How much larger one configuration of landmarks is than another, by what moves rigidly in both.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace ostraka {

/// The median, weighted by the distance in `from`, of the ratios of distances between landmarks that are near each other: each
/// with its three nearest ones in `from`. Posture changes distances across joints, which are the fewer ones; within a rigid part
/// all ratios are the scale. For configurations that are similar it is their scale, exactly. 0 for fewer than two landmarks, or
/// where all near ones coincide. Throws Error (usage) for lists of different lengths.
double rigid_scale(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to);

}  // namespace ostraka
