// What a classifier has learned.
#pragma once

#include "ostraka/collection/technique_study.h"

#include <Eigen/Core>

namespace ostraka {

/// Values of a classifier's descriptors: a row an object that has all of them, logarithms where they are positive by nature.
struct DescriptorTable {
    Eigen::MatrixXd values;
    std::vector<std::size_t> objects;  ///< the object of each row
    bool logarithm = false;            ///< of the first column
};
DescriptorTable descriptor_table(const std::vector<TechniqueObject>& objects, const std::vector<std::string>& descriptors);

/// Zero and less count as this: identical slices have no variance.
inline constexpr double least_positive = 1e-12;

/// Score of an object: weights . (x - middle) - limit, positive from 0 up.
struct TechniqueModel {
    Eigen::VectorXd weights, middle;
    double limit = 0;
    std::optional<Threshold> threshold;  ///< of one column
    [[nodiscard]] double score(const Eigen::VectorXd& x) const { return weights.dot(x - middle) - limit; }
};
/// Learns from the given rows; `truth` has one entry a row. Needs both kinds among them. Scores have standard deviation 1 over
/// the rows about the means of their kinds.
TechniqueModel learn(const Eigen::MatrixXd& values, const std::vector<bool>& truth, const std::vector<std::size_t>& rows);

}  // namespace ostraka
