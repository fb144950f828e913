#include "ostraka/morphometrics/thin_plate.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

using Eigen::MatrixXd;

namespace {

constexpr double spline_rounding = 1e-12;  ///< singular values below this share of the largest are rounding errors

/// The kernel of the biharmonic equation, with the sign that makes bending energies positive.
double kernel(double squared_distance, int dimension) {
    if (squared_distance <= 0) return 0;
    return dimension == 2 ? squared_distance * std::log(squared_distance) : -std::sqrt(squared_distance);
}

MatrixXd kernels(const Landmarks& points, const Landmarks& centres, int dimension) {
    MatrixXd K(points.rows(), centres.rows());
    for (Eigen::Index j = 0; j < centres.rows(); ++j)
        for (Eigen::Index i = 0; i < points.rows(); ++i)
            K(i, j) = kernel((points.row(i) - centres.row(j)).squaredNorm(), dimension);
    return K;
}

/// Rows 1, x, y (, z).
MatrixXd affine_terms(const Landmarks& points, int dimension) {
    MatrixXd P(points.rows(), dimension + 1);
    P.col(0).setOnes();
    P.rightCols(dimension) = points.leftCols(dimension);
    return P;
}

void check(const Landmarks& reference, int dimension) {
    if (dimension != 2 && dimension != 3) fail_usage("a thin-plate spline has two or three dimensions");
    if (!reference.allFinite())
        fail_input("thin-plate spline", "a coordinate is not a finite number", "estimate or leave out missing landmarks");
}

/// Centred, with unit centroid size: kernels of lengths near 1 are well conditioned.
Landmarks normalised(const Landmarks& points, const Eigen::RowVector3d& centre, double scale) {
    return (points.rowwise() - centre) / scale;
}

}  // namespace

MatrixXd bending_energy_matrix(const Landmarks& reference, int dimension) {
    check(reference, dimension);
    const Eigen::Index k = reference.rows();
    const double size = centroid_size(reference);
    if (k < 2 || !(size > 0)) return MatrixXd::Zero(k, k);
    const Landmarks x = normalised(reference, reference.colwise().mean(), size);
    // B = Z (Z^T K Z)^-1 Z^T, where the columns of Z span the vectors orthogonal to all affine functions.
    const SvdX svd(affine_terms(x, dimension).transpose(), true);
    const auto& values = svd.singularValues();
    Eigen::Index rank = 0;
    while (rank < values.size() && values[rank] > spline_rounding * values[0]) ++rank;
    if (rank >= k) return MatrixXd::Zero(k, k);
    const MatrixXd Z = svd.matrixV().rightCols(k - rank);
    const SymmetricEigenX eigen(Z.transpose() * kernels(x, x, dimension) * Z);
    const double largest = eigen.eigenvalues().cwiseAbs().maxCoeff();
    Eigen::VectorXd inverse = Eigen::VectorXd::Zero(k - rank);
    for (Eigen::Index i = 0; i < k - rank; ++i)
        if (eigen.eigenvalues()[i] > spline_rounding * largest) inverse[i] = 1 / eigen.eigenvalues()[i];
    const MatrixXd V = Z * eigen.eigenvectors();
    const MatrixXd B = V * inverse.asDiagonal() * V.transpose();
    return (B + B.transpose()) / 2;
}

ThinPlateSpline::ThinPlateSpline(const Landmarks& from, const Landmarks& to, int dimension) : dimension_(dimension) {
    check(from, dimension);
    check(to, dimension);
    if (from.rows() != to.rows() || from.rows() < 2)
        fail_input("thin-plate spline", fmt::format("{} and {} landmarks", from.rows(), to.rows()),
                   "give the same landmarks, at least two, on both sides");
    scale_ = centroid_size(from);
    if (!(scale_ > 0)) fail_input("thin-plate spline", "all landmarks coincide", "give distinct landmarks");
    from_ = from;
    const Landmarks x = normalised(from, from.colwise().mean(), scale_);
    const MatrixXd Y = to.leftCols(dimension), B = bending_energy_matrix(from, dimension);
    weights_ = B * Y;
    energy_ = (Y.transpose() * weights_).trace();
    const MatrixXd P = affine_terms(x, dimension), rest = Y - kernels(x, x, dimension) * weights_;
    affine_.resize(dimension + 1, dimension);
    for (int c = 0; c < dimension; ++c) affine_.col(c) = solve_least_squares(P, rest.col(c), spline_rounding);
}

Landmarks ThinPlateSpline::operator()(const Landmarks& points) const {
    const Eigen::RowVector3d centre = from_.colwise().mean();
    const Landmarks x = normalised(points, centre, scale_), centres = normalised(from_, centre, scale_);
    Landmarks result = Landmarks::Zero(points.rows(), 3);
    result.leftCols(dimension_) = kernels(x, centres, dimension_) * weights_ + affine_terms(x, dimension_) * affine_;
    return result;
}

std::vector<std::vector<std::array<double, 2>>> deformation_grid(const Landmarks& from, const Landmarks& to, int cells,
                                                                 double margin, int steps) {
    const ThinPlateSpline spline(from, to, 2);
    const Eigen::RowVector3d low = from.colwise().minCoeff(), high = from.colwise().maxCoeff();
    const double longer = std::max(high.x() - low.x(), high.y() - low.y()), cell = longer * (1 + 2 * margin) / cells;
    std::vector<std::vector<std::array<double, 2>>> lines;
    const std::array<int, 2> counts{
        std::max(1, static_cast<int>(std::ceil((high.x() - low.x() + 2 * margin * longer) / cell - 1e-9))),
        std::max(1, static_cast<int>(std::ceil((high.y() - low.y() + 2 * margin * longer) / cell - 1e-9)))};
    const Eigen::RowVector2d corner((low.x() + high.x() - counts[0] * cell) / 2, (low.y() + high.y() - counts[1] * cell) / 2);
    for (int axis = 0; axis < 2; ++axis)
        for (int line = 0; line <= counts.at(static_cast<std::size_t>(1 - axis)); ++line) {
            const int points = counts.at(static_cast<std::size_t>(axis)) * steps + 1;
            Landmarks along = Landmarks::Zero(points, 3);
            for (int i = 0; i < points; ++i) {
                along(i, axis) = corner[axis] + cell * i / steps;
                along(i, 1 - axis) = corner[1 - axis] + cell * line;
            }
            const Landmarks image = spline(along);
            auto& polyline = lines.emplace_back();
            for (int i = 0; i < points; ++i) polyline.push_back({image(i, 0), image(i, 1)});
        }
    return lines;
}

}  // namespace ostraka
