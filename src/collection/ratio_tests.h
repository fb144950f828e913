// The hypothesis tests of `study_proportions`.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

namespace ostraka::proportions {

/// Two columns of the matrix of logarithms.
struct Pair {
    Eigen::Index a, b;
};

/// Logarithms minus column centres, with the sizes of the objects fitted separately: x_ij - c_j, where the c_j minimise the sum
/// of (x_ij - s_i - c_j)^2 over the values present. NaN stays NaN.
Eigen::MatrixXd centred_columns(const Eigen::MatrixXd& logs);

/// Variance (divisor n - 1) of the difference of two columns over the rows that have both values, and the number of these rows;
/// 0 for fewer than two rows.
struct Variance {
    double value = 0;
    std::size_t count = 0;
};
Variance ratio_variance(const Eigen::MatrixXd& logs, const Pair& pair);

/// Permutation test that shuffles one column against the other: a p-value for each pair.
std::vector<double> pairing_test(const Eigen::MatrixXd& centred, const std::vector<Pair>& pairs, int permutations,
                                 std::uint64_t seed);

/// Permutation test that permutes each object's deviations from its size among its measures.
std::vector<double> others_test(const Eigen::MatrixXd& centred, const std::vector<Pair>& pairs, int permutations,
                                std::uint64_t seed);

/// Permutation test of the hypothesis that the two columns deviate independently from the size, estimated by the mean of the
/// other groups. `groups` labels related columns. No result if fewer than two other groups or fewer than four objects remain.
std::optional<double> size_test(const Eigen::MatrixXd& centred, const Pair& pair, const std::vector<int>& groups,
                                int permutations, std::uint64_t seed);

/// Standard deviations about the common size, each at least 0; none for fewer than three columns or if two columns have no rows
/// in common.
std::optional<std::vector<double>> own_deviations(const Eigen::MatrixXd& centred);

}  // namespace ostraka::proportions
