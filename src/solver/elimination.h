// Linear constraints enforced exactly, by elimination from the normal equations.
#pragma once

#include "solver/constraint_rows.h"

#include <functional>

namespace ostraka::solver {

/// Let constraints c prescribe N_c M_c x = v_c (M_c rows over the unknowns, N_c directions, v_c values), and let A be the
/// matrix of a least-squares problem with unconstrained minimum x. The constrained minimum is x - A^-1 M^T L (Nocedal and
/// Wright 2006, section 16.1: the Schur complement of the constraints). L is the solution of a small dense system, which is
/// factorised once.
class Elimination {
public:
    explicit Elimination(int unknowns = 0) : unknowns_(unknowns) {}
    void add(const RowMatrix& rows, std::size_t first, const Constraint::Components& given);
    /// `solve` replaces columns b by A^-1 b.
    void finish(const std::function<void(Eigen::MatrixXd&)>& solve);
    /// The correction to subtract from x, one row per unknown.
    [[nodiscard]] Eigen::MatrixXd correction(const Eigen::MatrixXd& x) const;

private:
    struct Equation {
        Eigen::Index row;  ///< row of M
        Eigen::Vector3d direction;
        double value;
    };
    /// Computes M x.
    [[nodiscard]] Eigen::MatrixXd times(const Eigen::MatrixXd& x) const;

    int unknowns_;
    RowMatrix rows_;
    std::vector<Equation> equations_;
    Eigen::MatrixXd influence_;  ///< A^-1 M^T
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> complement_;
};

}  // namespace ostraka::solver
