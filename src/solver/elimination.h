// Linear constraints that hold exactly: eliminated from the normal equations.
#pragma once

#include "constraint_rows.h"

#include <functional>

namespace ostraka::solver {

/// Of all x with N_c M_c x = v_c, constraint by constraint (M_c rows over the unknowns, N_c directions, v_c values), the one with
/// the least sum of squares by a matrix A is x - A^-1 M^T L (Nocedal and Wright 2006, section 16.1: the Schur complement of the
/// constraints), x being the least without them. L solves a small dense system, which is factorised once.
class Elimination {
public:
    explicit Elimination(int unknowns = 0) : unknowns_(unknowns) {}
    void add(const RowMatrix& rows, std::size_t first, const Constraint::Components& given);
    /// `solve` replaces columns b by A^-1 b.
    void finish(const std::function<void(Eigen::MatrixXd&)>& solve);
    /// To be taken from x, a row for each unknown.
    [[nodiscard]] Eigen::MatrixXd correction(const Eigen::MatrixXd& x) const;

private:
    struct Equation {
        Eigen::Index row;  ///< of M
        Eigen::Vector3d direction;
        double value;
    };
    /// M x.
    [[nodiscard]] Eigen::MatrixXd times(const Eigen::MatrixXd& x) const;

    int unknowns_;
    RowMatrix rows_;
    std::vector<Equation> equations_;
    Eigen::MatrixXd influence_;  ///< A^-1 M^T
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> complement_;
};

}  // namespace ostraka::solver
