// Small dense linear algebra behind plain functions, compiled once. Functions named after an algorithm of Eigen return exactly
// what Eigen returns.
#pragma once

#include <Eigen/Geometry>

#include <memory>

namespace ostraka {

template <int N>
class SymmetricEigen;
/// Eigenvalues (ascending) and eigenvectors of A x = lambda B x, for a symmetric A and a symmetric, positive definite B.
SymmetricEigen<Eigen::Dynamic> generalised_eigen(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Eigenvalues (ascending) and eigenvectors (columns) of a symmetric matrix; only its lower triangle is read. N: 2, 3 or
/// Eigen::Dynamic.
template <int N>
class SymmetricEigen {
public:
    using Matrix = Eigen::Matrix<double, N, N>;
    using Vector = Eigen::Matrix<double, N, 1>;
    /// Computes the decomposition at once.
    explicit SymmetricEigen(const Matrix& symmetric);

    [[nodiscard]] const Vector& eigenvalues() const { return values_; }  ///< ascending
    /// Unit columns, in the order of the eigenvalues.
    [[nodiscard]] const Matrix& eigenvectors() const { return vectors_; }
    /// False if the iteration did not converge, for example because an entry is not finite.
    [[nodiscard]] bool succeeded() const { return found_; }

private:
    friend SymmetricEigen<Eigen::Dynamic> generalised_eigen(const Eigen::MatrixXd&, const Eigen::MatrixXd&);
    SymmetricEigen() = default;
    Vector values_;
    Matrix vectors_;
    bool found_ = false;
};
using SymmetricEigen2 = SymmetricEigen<2>;
using SymmetricEigen3 = SymmetricEigen<3>;
using SymmetricEigenX = SymmetricEigen<Eigen::Dynamic>;
template <>
SymmetricEigen<2>::SymmetricEigen(const Matrix& symmetric);
extern template class SymmetricEigen<3>;
extern template class SymmetricEigen<Eigen::Dynamic>;

/// The three eigenvalues of a symmetric 3 x 3 matrix, ascending.
Eigen::Vector3d symmetric_eigenvalues(const Eigen::Matrix3d& symmetric);

/// Singular value decomposition (Jacobi) of a 3 x 3 matrix: U diag(s) V^T, singular values descending.
class Svd3 {
public:
    explicit Svd3(const Eigen::Matrix3d& matrix);
    // NOLINTBEGIN(readability-identifier-naming): named as in Eigen's decompositions, so that templates take either.
    [[nodiscard]] const Eigen::Matrix3d& matrixU() const { return u_; }
    [[nodiscard]] const Eigen::Matrix3d& matrixV() const { return v_; }
    [[nodiscard]] const Eigen::Vector3d& singularValues() const { return values_; }
    // NOLINTEND(readability-identifier-naming)
    /// False if an entry is not finite.
    [[nodiscard]] bool succeeded() const { return found_; }

private:
    Eigen::Matrix3d u_, v_;
    Eigen::Vector3d values_;
    bool found_;
};

/// The singular values of a 2 x 2 matrix, descending.
Eigen::Vector2d singular_values(const Eigen::Matrix2d& matrix);

/// Singular value decomposition (Jacobi) of any matrix, with the thin U; V is thin or, with `full_v`, full.
class SvdX {
public:
    explicit SvdX(const Eigen::MatrixXd& matrix, bool full_v = false);
    // NOLINTBEGIN(readability-identifier-naming): named as in Eigen's decompositions, so that templates take either.
    [[nodiscard]] const Eigen::MatrixXd& matrixU() const { return u_; }
    [[nodiscard]] const Eigen::MatrixXd& matrixV() const { return v_; }
    [[nodiscard]] const Eigen::VectorXd& singularValues() const { return values_; }
    // NOLINTEND(readability-identifier-naming)

private:
    Eigen::MatrixXd u_, v_;
    Eigen::VectorXd values_;
};

/// The rotation by the smallest angle that maps the direction of `from` to the direction of `to` (non-zero vectors). Opposite
/// directions give a half turn about an axis perpendicular to both.
Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// Solves A x = b for a symmetric, positive or negative semidefinite A by LDL^T. N: 3, 4, 6 or Eigen::Dynamic.
template <int N>
Eigen::Matrix<double, N, 1> solve_ldlt(const Eigen::Matrix<double, N, N>& a, const Eigen::Matrix<double, N, 1>& b);
extern template Eigen::Matrix<double, 3, 1> solve_ldlt<3>(const Eigen::Matrix3d&, const Eigen::Vector3d&);
extern template Eigen::Matrix<double, 4, 1> solve_ldlt<4>(const Eigen::Matrix4d&, const Eigen::Vector4d&);
extern template Eigen::Matrix<double, 6, 1> solve_ldlt<6>(const Eigen::Matrix<double, 6, 6>&, const Eigen::Matrix<double, 6, 1>&);
extern template Eigen::VectorXd solve_ldlt<Eigen::Dynamic>(const Eigen::MatrixXd&, const Eigen::VectorXd&);

/// Least-squares solution x of A x = b with the smallest norm, by a complete orthogonal decomposition. `threshold`: pivots below
/// this fraction of the largest pivot count as zero; 0: Eigen's default.
Eigen::VectorXd solve_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double threshold = 0);

/// The X that minimises |A X - B| for an A of full rank with more rows than columns (Householder).
Eigen::MatrixXd solve_full_rank(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// Cholesky factorisation (LL^T) of a symmetric positive definite matrix.
class Cholesky {
public:
    Cholesky();
    explicit Cholesky(const Eigen::MatrixXd& a);
    ~Cholesky();
    Cholesky(Cholesky&&) noexcept;
    Cholesky& operator=(Cholesky&&) noexcept;

    void compute(const Eigen::MatrixXd& a);  ///< factorises `a`
    /// False if the matrix is not positive definite.
    [[nodiscard]] bool succeeded() const;
    /// Estimate of the reciprocal condition number.
    [[nodiscard]] double rcond() const;
    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const;    ///< solution of A x = b
    [[nodiscard]] Eigen::MatrixX3d solve(const Eigen::MatrixX3d& b) const;  ///< one system per column

private:
    struct Factor;
    std::unique_ptr<Factor> factor_;
};

}  // namespace ostraka
