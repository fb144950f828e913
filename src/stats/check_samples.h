// Checks of arguments of the statistics functions.
#pragma once

#include <Eigen/Core>

#include <string>

namespace ostraka {

/// Throws Error (input) unless `samples` has at least one row and one column and all values are finite.
void require_samples(const Eigen::MatrixXd& samples, const std::string& where);

/// Throws Error (input) unless the matrix is square, finite and symmetric to 1e-9 of its largest entry. If `distances` is true,
/// also throws if an entry is negative.
void require_symmetric(const Eigen::MatrixXd& matrix, bool distances, const std::string& where);

/// The number of rows that differ from all rows before them.
std::size_t distinct_rows(const Eigen::MatrixXd& samples);

}  // namespace ostraka
