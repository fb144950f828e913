// Checks that the headers of this module promise.
#pragma once

#include <Eigen/Core>

#include <string>

namespace ostraka {

/// Throws Error (input) unless there is a row and a column and all values are finite.
void require_samples(const Eigen::MatrixXd& samples, const std::string& where);

/// Throws Error (input) unless the matrix is square, finite and symmetric to 1e-9 of its largest entry, and no entry is negative
/// if these are distances.
void require_symmetric(const Eigen::MatrixXd& matrix, bool distances, const std::string& where);

/// How many rows differ from all before them.
std::size_t distinct_rows(const Eigen::MatrixXd& samples);

}  // namespace ostraka
