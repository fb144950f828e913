// Linear constraints enforced exactly, by elimination from the normal equations.
#pragma once

#include "solver/constraint_rows.h"

#include <functional>

namespace ostraka::solver {

/// Enforces linear constraints on a least-squares problem. Constraints c prescribe N_c M_c x = v_c (M_c: rows over the unknowns,
/// N_c: directions, v_c: values); A is the matrix of the least-squares problem, and x its unconstrained minimum. The constrained
/// minimum is x - A^-1 M^T L (Nocedal and Wright 2006, section 16.1: the Schur complement of the constraints). L is the solution
/// of a small dense system, which is factorised once.
class Elimination {
public:
    explicit Elimination(int unknowns = 0) : unknowns_(unknowns) {}
    /// Adds a constraint: its prescribed components, and its rows from row `first` of `rows`.
    void add(const RowMatrix& rows, std::size_t first, const Constraint::Components& given);
    /// Factorises the dense system after all constraints were added; `solve` replaces the columns b of a matrix by A^-1 b.
    void finish(const std::function<void(Eigen::MatrixXd&)>& solve);
    /// The correction A^-1 M^T L to subtract from x, one row per unknown.
    [[nodiscard]] Eigen::MatrixXd correction(const Eigen::MatrixXd& x) const;

private:
    /// A linear equation on a row of M x.
    struct Equation {
        Eigen::Index row;  ///< row of M
        Eigen::Vector3d direction;
        double value;  ///< prescribed component along `direction`
    };
    /// Computes M x.
    [[nodiscard]] Eigen::MatrixXd times(const Eigen::MatrixXd& x) const;

    int unknowns_;                                                        ///< number of unknowns
    RowMatrix rows_;                                                      ///< rows of M
    std::vector<Equation> equations_;                                     ///< equations of all added constraints
    Eigen::MatrixXd influence_;                                           ///< A^-1 M^T, one column per row of M
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> complement_;  ///< factorisation of the dense system
};

}  // namespace ostraka::solver
