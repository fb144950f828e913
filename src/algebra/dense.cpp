#include "ostraka/algebra/dense.h"

#include "ostraka/core/angles.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace ostraka {

// One Jacobi rotation.
template <>
SymmetricEigen<2>::SymmetricEigen(const Matrix& symmetric)
    : found_(symmetric.triangularView<Eigen::Lower>().toDenseMatrix().allFinite()) {
    Eigen::JacobiRotation<double> rotation;
    rotation.makeJacobi(symmetric(0, 0), symmetric(1, 0), symmetric(1, 1));
    vectors_.setIdentity();
    vectors_.applyOnTheRight(0, 1, rotation);
    const Matrix full = symmetric.selfadjointView<Eigen::Lower>();
    values_ = (vectors_.transpose() * full * vectors_).diagonal();
    if (values_[0] <= values_[1]) return;
    std::swap(values_[0], values_[1]);
    vectors_.col(0).swap(vectors_.col(1));
}

template <int N>
SymmetricEigen<N>::SymmetricEigen(const Matrix& symmetric) {
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(symmetric);
    values_ = solver.eigenvalues();
    vectors_ = solver.eigenvectors();
    found_ = solver.info() == Eigen::Success;
}
template class SymmetricEigen<3>;
template class SymmetricEigen<Eigen::Dynamic>;

Eigen::Vector3d symmetric_eigenvalues(const Eigen::Matrix3d& symmetric) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

Svd3::Svd3(const Eigen::Matrix3d& matrix) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    found_ = svd.info() == Eigen::Success;
    if (found_) {
        u_ = svd.matrixU();
        v_ = svd.matrixV();
        values_ = svd.singularValues();
    } else {
        u_ = v_ = Eigen::Matrix3d::Identity();
        values_.setZero();
    }
}

Eigen::Vector2d singular_values(const Eigen::Matrix2d& matrix) {
    return Eigen::JacobiSVD<Eigen::Matrix2d>(matrix).singularValues();
}

SvdX::SvdX(const Eigen::MatrixXd& matrix, bool full_v) {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(
        matrix, static_cast<unsigned>(Eigen::ComputeThinU) | (full_v ? Eigen::ComputeFullV : Eigen::ComputeThinV));
    u_ = svd.matrixU();
    v_ = svd.matrixV();
    values_ = svd.singularValues();
}

Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d a = from.normalized(), b = to.normalized();
    const double cosine = a.dot(b);
    if (cosine < -1 + 1e-12) return Eigen::Quaterniond(Eigen::AngleAxisd(pi, a.unitOrthogonal()));
    const double s = std::sqrt((1 + cosine) * 2);
    Eigen::Quaterniond rotation;
    rotation.vec() = a.cross(b) * (1 / s);
    rotation.w() = s * 0.5;
    return rotation;
}

template <int N>
Eigen::Matrix<double, N, 1> solve_ldlt(const Eigen::Matrix<double, N, N>& a, const Eigen::Matrix<double, N, 1>& b) {
    return a.ldlt().solve(b);
}
template Eigen::Matrix<double, 3, 1> solve_ldlt<3>(const Eigen::Matrix3d&, const Eigen::Vector3d&);
template Eigen::Matrix<double, 4, 1> solve_ldlt<4>(const Eigen::Matrix4d&, const Eigen::Vector4d&);
template Eigen::Matrix<double, 6, 1> solve_ldlt<6>(const Eigen::Matrix<double, 6, 6>&, const Eigen::Matrix<double, 6, 1>&);
template Eigen::VectorXd solve_ldlt<Eigen::Dynamic>(const Eigen::MatrixXd&, const Eigen::VectorXd&);

Eigen::VectorXd solve_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double threshold) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(a.rows(), a.cols());
    if (threshold > 0) solver.setThreshold(threshold);
    solver.compute(a);
    return solver.solve(b);
}

Eigen::MatrixXd solve_full_rank(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return a.householderQr().solve(b); }

SymmetricEigenX generalised_eigen(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(a, b);
    SymmetricEigenX result;
    result.values_ = solver.eigenvalues();
    result.vectors_ = solver.eigenvectors();
    result.found_ = solver.info() == Eigen::Success;
    return result;
}

struct Cholesky::Factor : Eigen::LLT<Eigen::MatrixXd> {};

Cholesky::Cholesky() : factor_(std::make_unique<Factor>()) {}
Cholesky::Cholesky(const Eigen::MatrixXd& a) : Cholesky() { factor_->compute(a); }
Cholesky::~Cholesky() = default;
Cholesky::Cholesky(Cholesky&&) noexcept = default;
Cholesky& Cholesky::operator=(Cholesky&&) noexcept = default;
void Cholesky::compute(const Eigen::MatrixXd& a) { factor_->compute(a); }
bool Cholesky::succeeded() const { return factor_->info() == Eigen::Success; }
double Cholesky::rcond() const { return factor_->rcond(); }
Eigen::VectorXd Cholesky::solve(const Eigen::VectorXd& b) const { return factor_->solve(b); }
Eigen::MatrixX3d Cholesky::solve(const Eigen::MatrixX3d& b) const { return factor_->solve(b); }

}  // namespace ostraka
