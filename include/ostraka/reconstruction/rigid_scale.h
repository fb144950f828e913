// How much larger one configuration of landmarks is than another, and how unlike it, by what moves rigidly in both.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace ostraka {

/// The median, weighted by the distance in `from`, of the ratios of distances between landmarks that are near each other: each
/// with its three nearest ones in `from`. Posture changes distances across joints, which are the fewer ones; within a rigid part
/// all ratios are the scale. For configurations that are similar it is their scale, exactly. 0 for fewer than two landmarks, or
/// where all near ones coincide. Throws Error (usage) for lists of different lengths.
double rigid_scale(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to);

/// By what share the distances between those near landmarks differ from that scale: the weighted median again. 0 for the same
/// shape in another posture, as long as most near landmarks belong to one rigid part. Nothing for fewer than six landmarks, or
/// six such distances: two parts of three are the least that a posture can be told from another shape by. Errors as above.
std::optional<double> rigid_strain(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to);

}  // namespace ostraka
