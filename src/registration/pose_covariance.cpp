#include "registration/pose_covariance.h"

#include "ostraka/algebra/dense.h"

#include <array>
#include <cmath>
#include <map>

namespace ostraka::detail {

namespace {

constexpr double cell_side = 0.4;
/// Eigenvalues of the normal equations below this share of the largest are motions that the pairs do not determine: the square of
/// the tolerance of slippable motions.
constexpr double min_eigenvalue = 4e-4;

/// Equations over rotation, translation and the logarithm of the scale.
struct PoseEquations {
    Eigen::MatrixXd normal, gradients;  ///< H and M
    double squares = 0;                 ///< sum of the squared residuals
};

PoseEquations equations_of(const std::vector<PlanePair>& pairs, int unknowns) {
    PoseEquations equations{Eigen::MatrixXd::Zero(unknowns, unknowns), Eigen::MatrixXd::Zero(unknowns, unknowns)};
    std::map<std::array<int, 3>, Eigen::VectorXd> cells;
    for (const PlanePair& pair : pairs) {
        const double off = pair.normal.dot(pair.place - pair.point);
        Eigen::Matrix<double, 7, 1> full;
        full << pair.point.cross(pair.normal), pair.normal, pair.point.dot(pair.normal);
        const Eigen::VectorXd row = full.head(unknowns);
        const Eigen::Vector3d scaled = pair.place / cell_side;
        const std::array<int, 3> cell{static_cast<int>(std::floor(scaled.x())), static_cast<int>(std::floor(scaled.y())),
                                      static_cast<int>(std::floor(scaled.z()))};
        cells.try_emplace(cell, Eigen::VectorXd::Zero(unknowns)).first->second += off * row;
        equations.normal += row * row.transpose();
        equations.squares += off * off;
    }
    for (const auto& [cell, gradient] : cells) equations.gradients += gradient * gradient.transpose();
    if (cells.size() > 1) equations.gradients *= static_cast<double>(cells.size()) / static_cast<double>(cells.size() - 1);
    return equations;
}

/// Mean squared displacement of the points under motions with this covariance.
double mean_squared_displacement(const std::vector<PlanePair>& pairs, const Eigen::MatrixXd& covariance) {
    double sum = 0;
    for (const PlanePair& pair : pairs) {
        Eigen::MatrixXd motion(3, covariance.cols());  // w x p + t + s p
        for (int k = 0; k < 3; ++k) {
            motion.col(k) = Eigen::Vector3d::Unit(k).cross(pair.point);
            motion.col(3 + k) = Eigen::Vector3d::Unit(k);
        }
        if (covariance.cols() > 6) motion.col(6) = pair.point;
        sum += (motion * covariance * motion.transpose()).trace();
    }
    return sum / static_cast<double>(pairs.size());
}

}  // namespace

RegistrationUncertainty pose_uncertainty(const std::vector<PlanePair>& pairs, bool scaled) {
    const int unknowns = scaled ? 7 : 6;
    RegistrationUncertainty result;
    if (pairs.size() <= static_cast<std::size_t>(unknowns)) return result.undetermined = unknowns, result;
    const PoseEquations equations = equations_of(pairs, unknowns);
    const SymmetricEigenX modes(equations.normal);
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(unknowns, unknowns);
    for (int k = 0; k < unknowns; ++k) {
        if (!(modes.eigenvalues()[k] > min_eigenvalue * modes.eigenvalues()[unknowns - 1])) {
            ++result.undetermined;
            continue;
        }
        const Eigen::VectorXd mode = modes.eigenvectors().col(k);
        inverse += mode * mode.transpose() / modes.eigenvalues()[k];
    }
    const double variance = equations.squares / static_cast<double>(pairs.size() - static_cast<std::size_t>(unknowns));
    const Eigen::MatrixXd independent = variance * inverse, by_cells = inverse * equations.gradients * inverse;
    const Eigen::MatrixXd covariance = by_cells.trace() > independent.trace() ? by_cells : independent;
    result.rotation = std::sqrt(covariance.topLeftCorner(3, 3).trace());
    result.translation = std::sqrt(covariance.block(3, 3, 3, 3).trace());
    result.scale = scaled ? std::sqrt(covariance(6, 6)) : 0;
    result.placement = std::sqrt(mean_squared_displacement(pairs, covariance));
    return result;
}

}  // namespace ostraka::detail
