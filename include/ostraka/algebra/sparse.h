// Sparse linear systems behind a plain class, compiled once.
#pragma once

#include <Eigen/SparseCore>

#include <memory>

namespace ostraka {

/// LDL^T factorisation of a symmetric sparse matrix (Eigen's SimplicialLDLT); only the lower triangle is read.
class SparseLdlt {
public:
    explicit SparseLdlt(const Eigen::SparseMatrix<double>& a);  ///< factorises at once
    ~SparseLdlt();

    /// False if a pivot is zero.
    [[nodiscard]] bool succeeded() const;
    /// Solves A x = b. The arguments and the solution have one row per row of the matrix and one column per right-hand side.
    [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

private:
    struct Factor;
    std::unique_ptr<Factor> factor_;
};

}  // namespace ostraka
