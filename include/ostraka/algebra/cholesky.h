// Sparse Cholesky factorisation with CHOLMOD (supernodal). CHOLMOD's headers are included in the source file only.
#pragma once

#include <Eigen/Sparse>

#include <memory>

namespace ostraka {

/// A symmetric matrix, stored column-major as its lower triangle and diagonal, with row indices sorted within each column.
using LowerTriangle = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

/// Solver for sparse symmetric positive definite systems: analyse, factor, solve.
class SparseCholesky {
public:
    SparseCholesky();
    ~SparseCholesky();
    /// Symbolic analysis of the matrix: computes the elimination order. Unknowns with very many neighbours are eliminated last.
    /// Throws Error (failure).
    void analyse(const LowerTriangle& matrix);
    /// Numerical factorisation of a matrix with the sparsity pattern given to `analyse`. Returns false if the matrix is not
    /// positive definite. Throws Error (failure) if memory runs out.
    bool factor(const LowerTriangle& matrix);
    /// Square of the ratio of the smallest to the largest diagonal entry of the factor: an upper bound of the reciprocal
    /// condition number.
    [[nodiscard]] double reciprocal_condition() const;
    /// Replaces each right-hand side (column of `columns`) by the solution of the factorised system.
    void solve(Eigen::MatrixXd& columns);
    [[nodiscard]] double entries() const;  ///< number of non-zero entries of the Cholesky factor

private:
    struct State;
    template <class Work>
    void work_on(const LowerTriangle& matrix, Work work);
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
