// The tests of `study_proportions`.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

namespace ostraka::proportions {

/// Two columns of the logarithms.
struct Pair {
    Eigen::Index a, b;
};

/// Logarithms about the means of their columns, objects' sizes apart: x_ij - c_j with the c_j that minimise the sum of
/// (x_ij - s_i - c_j)^2 over the values there are. NaN stays NaN.
Eigen::MatrixXd centred_columns(const Eigen::MatrixXd& logs);

/// Variance (n - 1) of the difference of two columns over the rows that have both, and their number; 0 for fewer than two.
struct Variance {
    double value = 0;
    std::size_t count = 0;
};
Variance ratio_variance(const Eigen::MatrixXd& logs, const Pair& pair);

/// That one column is shuffled against the other: a p-value for each pair.
std::vector<double> pairing_test(const Eigen::MatrixXd& centred, const std::vector<Pair>& pairs, int permutations,
                                 std::uint64_t seed);

/// That deviations from the size of an object are dealt out anew among its measures.
std::vector<double> others_test(const Eigen::MatrixXd& centred, const std::vector<Pair>& pairs, int permutations,
                                std::uint64_t seed);

/// That the two columns deviate from the size independently, which the mean of the other groups tells. `groups` numbers columns
/// that go together. Nothing where fewer than two groups besides theirs, or fewer than four objects, are left.
std::optional<double> size_test(const Eigen::MatrixXd& centred, const Pair& pair, const std::vector<int>& groups,
                                int permutations, std::uint64_t seed);

/// Standard deviations about the common size, each at least 0; none for fewer than three columns or where two have no rows in
/// common.
std::optional<std::vector<double>> own_deviations(const Eigen::MatrixXd& centred);

}  // namespace ostraka::proportions
