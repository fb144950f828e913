#include "check_samples.h"

#include "ostraka/core/error.h"

#include <cmath>
#include <set>
#include <vector>

namespace ostraka {

namespace {

std::string place(Eigen::Index row, Eigen::Index column) {
    return "row " + std::to_string(row) + ", column " + std::to_string(column);
}

void require_finite_entries(const Eigen::MatrixXd& matrix, const std::string& where) {
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
        for (Eigen::Index j = 0; j < matrix.cols(); ++j)
            if (!std::isfinite(matrix(i, j)))
                fail_input(where, "the value in " + place(i, j) + " is not a finite number",
                           "leave it out, or give a finite number");
}

}  // namespace

void require_samples(const Eigen::MatrixXd& samples, const std::string& where) {
    if (samples.rows() == 0 || samples.cols() == 0) fail_input(where, "no sample is given", "give at least one row with a value");
    require_finite_entries(samples, where);
}

void require_symmetric(const Eigen::MatrixXd& matrix, bool distances, const std::string& where) {
    if (matrix.rows() == 0) fail_input(where, "the matrix is empty", "give at least one row");
    if (matrix.rows() != matrix.cols())
        fail_input(where,
                   "the matrix has " + std::to_string(matrix.rows()) + " rows and " + std::to_string(matrix.cols()) + " columns",
                   "give a square one, a row and a column a sample");
    require_finite_entries(matrix, where);
    const double tolerance = 1e-9 * matrix.cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
        for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
            if (std::abs(matrix(i, j) - matrix(j, i)) > tolerance)
                fail_input(where, "the entry in " + place(i, j) + " is not the one across the diagonal",
                           "make the matrix symmetric first");
            if (distances && matrix(i, j) < 0)
                fail_input(where, "the distance in " + place(i, j) + " is negative", "give distances, not similarities");
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
