#include "ostraka/solver/constraint.h"
#include "ostraka/algebra/dense.h"

#include "solver/create.h"

#include <cmath>

namespace ostraka {

namespace {
constexpr double max_coordinate = 1e100;  // keeps squares, and products of four coordinates, finite
}

void check_points(const Points& points, const std::string& what) {
    for (Eigen::Index i = 0; i < points.cols(); ++i)
        if (!(points.col(i).cwiseAbs().maxCoeff() <= max_coordinate) || !points.col(i).allFinite())
            throw Error(ErrorKind::usage, what, "point " + std::to_string(i) + " is not finite",
                        "all coordinates must be numbers below 1e100");
}

Constraint::Constraint(std::string_view kind, std::vector<int> ids, double weight) : kind_(kind), ids_(std::move(ids)) {
    Constraint::set_weight(weight);
}

void Constraint::set_weight(double weight) {
    if (!(weight >= 0) || !std::isfinite(weight))
        throw Error(ErrorKind::usage, "constraint " + std::string(kind_), "the weight is " + std::to_string(weight),
                    "weights are finite and not negative");
    weight_ = weight;
}

void Constraint::set_target(const Points&) {
    throw Error(ErrorKind::usage, "constraint " + std::string(kind_), "this kind has no target that can be set");
}

const Points& Constraint::reference() const {
    static const Points none(3, 0);
    return none;
}

Constraint::LinearProjection Constraint::project_moments(const Moments&) const {
    throw std::logic_error("constraint " + std::string(kind_) + " does not project by moments");
}

void Constraint::rows_of(const Points& points, Points& rows) const {
    rows.setZero(3, map_.rows);
    for (Eigen::Index i = 0; i < map_.direct; ++i) rows.col(i) = points.col(ids_[i]);
    if (map_.centred && map_.direct > 0) {
        // The first point is subtracted first, so that no digits are lost in the sum far from the origin.
        const Eigen::Vector3d first = rows.col(0);
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (Eigen::Index i = 0; i < map_.direct; ++i) {
            rows.col(i) -= first;
            sum += rows.col(i);
        }
        sum /= static_cast<double>(map_.direct);
        for (Eigen::Index i = 0; i < map_.direct; ++i) rows.col(i) -= sum;
    }
    for (const Entry& entry : map_.entries) rows.col(map_.direct + entry.row) += entry.value * points.col(ids_[entry.position]);
}

double Constraint::residual(const Points& points) const {
    Points rows, projected(3, map_.rows);
    rows_of(points, rows);
    project(rows, projected);
    return (rows - projected).leftCols(map_.rows - map_.observed).colwise().norm().sum();
}

double Constraint::normalised_residual(const Points& points) const { return residual(points) / static_cast<double>(ids_.size()); }

double Constraint::squared_distance(const Points& points) const {
    Points rows, projected(3, map_.rows);
    rows_of(points, rows);
    project(rows, projected);
    return (rows - projected).leftCols(map_.rows - map_.observed).squaredNorm();
}

double Constraint::greatest_distance(const Points& points) const {
    const Eigen::Index weighing = map_.rows - map_.observed;
    if (weighing == 0) return 0;
    Points rows, projected(3, map_.rows);
    rows_of(points, rows);
    project(rows, projected);
    return (rows - projected).leftCols(weighing).colwise().norm().maxCoeff();
}

namespace solver {

Eigen::Matrix3d outer_sum(const RowsIn& a, const RowsIn& b) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (Eigen::Index i = 0; i < a.cols(); ++i) sum.noalias() += a.col(i) * b.col(i).transpose();
    return sum;
}

Eigen::Matrix3d best_rotation(const Eigen::Matrix3d& m) {
    const Svd3 svd(m);
    if (!svd.succeeded()) return Eigen::Matrix3d::Identity();  // the matrix is not finite
    Eigen::Matrix3d u = svd.matrixU();
    if (u.determinant() * svd.matrixV().determinant() < 0) u.col(2) *= -1;
    return u * svd.matrixV().transpose();
}

SymmetricEigen3 principal(const Eigen::Matrix3d& symmetric) { return SymmetricEigen3(symmetric); }

Eigen::Vector3d any_perpendicular(const Eigen::Vector3d& unit) {
    Eigen::Index minimum = 0;
    unit.cwiseAbs().minCoeff(&minimum);
    return unit.cross(Eigen::Vector3d::Unit(minimum)).normalized();
}

void MomentConstraint::project(const RowsIn& rows, RowsOut projected) const {
    const Points& q = reference();
    Moments moments{outer_sum(rows, rows), Eigen::Matrix3d::Zero()};
    if (q.cols() > 0) moments.reference = outer_sum(rows, q);
    const LinearProjection p = project_moments(moments);
    for (Eigen::Index i = 0; i < rows.cols(); ++i) {
        Eigen::Vector3d row = p.of_rows * rows.col(i);
        if (q.cols() > 0) row += p.of_reference * q.col(i);
        projected.col(i) = row;
    }
}

}  // namespace solver

}  // namespace ostraka
