// Rows of B over the unknowns of a sparse system, and the matrices made of them.
#pragma once

#include "ostraka/core/cholesky.h"
#include "ostraka/solver/constraint.h"

#include <span>

namespace ostraka::solver {

/// Compressed rows: those of all constraints, unweighted; observed rows are empty. A large centred group has one further unknown,
/// its mean: its rows are x_i - mean, and eliminating the mean gives the centring matrix, which is never formed.
struct RowMatrix {
    std::vector<std::size_t> begin{0};
    std::vector<int> unknown;
    std::vector<double> value;
    [[nodiscard]] std::size_t rows() const { return begin.size() - 1; }
};

struct Unknowns {
    std::vector<int> of_point;           ///< -1: in no constraint
    std::vector<int> point;              ///< of the unknowns that are points
    std::vector<std::size_t> first_row;  ///< of each constraint, and the number of rows
    int count = 0;                       ///< points and means
    RowMatrix rows;
    [[nodiscard]] std::size_t rows_of(std::size_t constraint) const { return first_row[constraint + 1] - first_row[constraint]; }
};
Unknowns number_unknowns(std::span<const std::unique_ptr<Constraint>> constraints, Eigen::Index points);

RowMatrix transposed(const RowMatrix& matrix, int columns);

/// Lower triangle of the sum of w_r b_r b_r^T over the rows b_r, every diagonal entry present.
LowerTriangle normal_matrix(const RowMatrix& rows, const RowMatrix& columns, std::span<const double> row_weight);

/// Sets of point unknowns that rows of positive weight tie together and none holds in place. Unknowns in no such row are `idle`.
struct Floating {
    std::vector<std::vector<int>> parts;
    std::vector<int> idle;
};
Floating floating_parts(const Unknowns& unknowns, std::span<const double> row_weight);

}  // namespace ostraka::solver
