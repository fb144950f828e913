// The hypothesis tests of `study_proportions`.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

namespace ostraka::proportions {

/// A ratio of two measures: indices of two columns of the matrix of logarithms.
struct Pair {
    Eigen::Index a, b;  ///< indices of the columns
};

/// Logarithms of measures minus column centres: x_ij - c_j, where the c_j minimise the sum of (x_ij - s_i - c_j)^2 over the
/// values present and s_i is the size of object i. NaN entries stay NaN.
Eigen::MatrixXd centred_columns(const Eigen::MatrixXd& logs);

/// Variance of the difference of two columns.
struct Variance {
    double value = 0;       ///< variance (divisor count - 1); 0 for fewer than two rows
    std::size_t count = 0;  ///< number of rows that have both values
};
Variance ratio_variance(const Eigen::MatrixXd& logs, const Pair& pair);

/// Permutation test that shuffles one column of each pair against the other; one p-value per pair.
std::vector<double> pairing_test(const Eigen::MatrixXd& centred, const std::vector<Pair>& pairs, int permutations,
                                 std::uint64_t seed);

/// Permutation test that permutes each object's deviations from its size among its measures; one p-value per pair.
std::vector<double> others_test(const Eigen::MatrixXd& centred, const std::vector<Pair>& pairs, int permutations,
                                std::uint64_t seed);

/// Permutation test of the hypothesis that the two columns deviate independently from the size, estimated by the mean of the
/// other groups. `groups` gives for each column the label of its group of related columns. No result if fewer than two other
/// groups or fewer than four objects remain.
std::optional<double> size_test(const Eigen::MatrixXd& centred, const Pair& pair, const std::vector<int>& groups,
                                int permutations, std::uint64_t seed);

/// For each column, the standard deviation of its logarithms about the common size, at least 0; none for fewer than three columns
/// or if two columns have no rows in common.
std::optional<std::vector<double>> own_deviations(const Eigen::MatrixXd& centred);

}  // namespace ostraka::proportions
