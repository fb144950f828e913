// Sparse linear systems behind a plain class, compiled once.
#pragma once

#include <Eigen/SparseCore>

#include <memory>

namespace ostraka {

/// LDL^T factorisation of a symmetric sparse matrix (Eigen's SimplicialLDLT), of which the lower triangle is read.
class SparseLdlt {
public:
    explicit SparseLdlt(const Eigen::SparseMatrix<double>& a);
    ~SparseLdlt();

    /// False where a pivot is zero.
    [[nodiscard]] bool found() const;
    /// A row a row of the matrix, one column for each right-hand side.
    [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

private:
    struct Factor;
    std::unique_ptr<Factor> factor_;
};

}  // namespace ostraka
