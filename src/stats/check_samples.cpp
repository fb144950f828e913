#include "stats/check_samples.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <cmath>
#include <set>
#include <vector>

namespace ostraka {

namespace {

std::string place(Eigen::Index row, Eigen::Index column) { return fmt::format("row {}, column {}", row, column); }

void require_finite_entries(const Eigen::MatrixXd& matrix, const std::string& where) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
        for (Eigen::Index j = 0; j < matrix.cols(); ++j)
            if (!std::isfinite(matrix(i, j)))
                fail_input(where, fmt::format("the value in {} is not a finite number", place(i, j)),
                           "remove it, or give a finite number");
}

}  // namespace

void require_samples(const Eigen::MatrixXd& samples, const std::string& where) {
    if (samples.rows() == 0 || samples.cols() == 0) fail_input(where, "no sample is given", "give at least one row with a value");
    require_finite_entries(samples, where);
}

void require_symmetric(const Eigen::MatrixXd& matrix, bool distances, const std::string& where) {
    if (matrix.rows() == 0) fail_input(where, "the matrix is empty", "give at least one row");
    if (matrix.rows() != matrix.cols())
        fail_input(where, fmt::format("the matrix has {} rows and {} columns", matrix.rows(), matrix.cols()),
                   "give a square matrix with one row and one column per sample");
    require_finite_entries(matrix, where);
    const double tolerance = 1e-9 * matrix.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
        for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
            if (std::abs(matrix(i, j) - matrix(j, i)) > tolerance)
                fail_input(where, fmt::format("the entry in {} differs from its mirror entry across the diagonal", place(i, j)),
                           "make the matrix symmetric first");
            if (distances && matrix(i, j) < 0)
                fail_input(where, fmt::format("the distance in {} is negative", place(i, j)), "give distances, not similarities");
        }
}

std::size_t distinct_rows(const Eigen::MatrixXd& samples) {
    std::set<std::vector<double>> rows;
    for (Eigen::Index i = 0; i < samples.rows(); ++i) {
        std::vector<double> row(static_cast<std::size_t>(samples.cols()));
        for (Eigen::Index j = 0; j < samples.cols(); ++j) row[static_cast<std::size_t>(j)] = samples(i, j);
        rows.insert(std::move(row));
    }
    return rows.size();
}

}  // namespace ostraka
