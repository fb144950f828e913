// Rows of B over the unknowns of a sparse system, and the matrices built from them.
#pragma once

#include "ostraka/algebra/cholesky.h"
#include "ostraka/solver/constraint.h"

#include <span>

namespace ostraka::solver {

/// The rows of all constraints in compressed form, unweighted; observed rows are empty. A large centred group has one
/// additional unknown, its mean: its rows are x_i - mean, and eliminating the mean gives the centring matrix, which is never
/// formed.
struct RowMatrix {
    std::vector<std::size_t> begin{0};
    std::vector<int> unknown;
    std::vector<double> value;
    [[nodiscard]] std::size_t rows() const { return begin.size() - 1; }
};

struct Unknowns {
    std::vector<int> of_point;           ///< -1: not in any constraint
    std::vector<int> point;              ///< point of each unknown that is a point
    std::vector<std::size_t> first_row;  ///< first row of each constraint, and the number of rows
    int count = 0;                       ///< number of points and means
    RowMatrix rows;
    [[nodiscard]] std::size_t rows_of(std::size_t constraint) const { return first_row[constraint + 1] - first_row[constraint]; }
};
Unknowns number_unknowns(std::span<const std::unique_ptr<Constraint>> constraints, Eigen::Index points);

RowMatrix transposed(const RowMatrix& matrix, int columns);

/// Lower triangle of the sum of w_r b_r b_r^T over the rows b_r, with all diagonal entries present.
LowerTriangle normal_matrix(const RowMatrix& rows, const RowMatrix& columns, std::span<const double> row_weight);

/// Sets of point unknowns connected by rows of positive weight, none of which fixes their position. Unknowns in no such row are
/// `idle`.
struct Floating {
    std::vector<std::vector<int>> parts;
    std::vector<int> idle;
};
Floating floating_parts(const Unknowns& unknowns, std::span<const double> row_weight);

}  // namespace ostraka::solver
