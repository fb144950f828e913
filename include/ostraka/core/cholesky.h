// Sparse Cholesky factorisation: CHOLMOD, supernodal, behind a wall.
#pragma once

#include <Eigen/Sparse>

#include <memory>

namespace ostraka {

/// Column-major, lower triangle and diagonal only, indices in order within a column.
using LowerTriangle = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

class SparseCholesky {
public:
    SparseCholesky();
    ~SparseCholesky();
    /// Orders and analyses the pattern. Unknowns with very many neighbours are ordered last. Throws Error (failure).
    void analyse(const LowerTriangle& matrix);
    /// False if the matrix is not positive definite. Throws Error (failure) for lack of memory.
    bool factor(const LowerTriangle& matrix);
    /// Least over greatest diagonal entry of the factor, squared: an upper bound of the reciprocal condition number.
    [[nodiscard]] double reciprocal_condition() const;
    /// Solves for all columns at once; in place.
    void solve(Eigen::MatrixXd& columns);
    [[nodiscard]] double entries() const;  ///< of the factor

private:
    struct State;
    template <class Work>
    void work_on(const LowerTriangle& matrix, Work work);
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
