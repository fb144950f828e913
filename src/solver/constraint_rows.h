// Rows of B over the unknowns of a sparse system, and matrices built from these rows.
#pragma once

#include "ostraka/algebra/cholesky.h"
#include "ostraka/solver/constraint.h"

#include <span>

namespace ostraka::solver {

/// Rows of constraints as a sparse matrix in compressed form, unweighted; observed rows are empty. A large centred group has an
/// additional unknown, its mean: the rows of the group are x_i - mean, and eliminating the mean gives the centring matrix, which
/// is never formed.
struct RowMatrix {
    std::vector<std::size_t> begin{0};  ///< for each row, index of its first entry; followed by the number of entries
    std::vector<int> unknown;           ///< for each entry, the index of its unknown
    std::vector<double> value;          ///< for each entry, its coefficient
    [[nodiscard]] std::size_t rows() const { return begin.size() - 1; }  ///< number of rows
};

/// Unknowns of the sparse system, and the rows over them.
struct Unknowns {
    std::vector<int> of_point;           ///< for each point, the index of its unknown; -1: the point is in no constraint
    std::vector<int> point;              ///< for each unknown that is a point, the index of the point
    std::vector<std::size_t> first_row;  ///< for each constraint, its first row; followed by the number of rows
    int count = 0;                       ///< number of unknowns: points and means
    RowMatrix rows;                      ///< rows of all constraints over the unknowns
    /// Number of rows of a constraint.
    [[nodiscard]] std::size_t rows_of(std::size_t constraint) const { return first_row[constraint + 1] - first_row[constraint]; }
};
/// Numbers the unknowns of the constraints; `points`: number of points.
Unknowns number_unknowns(std::span<const std::unique_ptr<Constraint>> constraints, Eigen::Index points);

/// The transposed matrix.
RowMatrix transposed(const RowMatrix& matrix, int columns);

/// Lower triangle of the sum of w_r b_r b_r^T over the rows b_r with weights w_r, with all diagonal entries present; `columns`:
/// the transposed rows.
LowerTriangle normal_matrix(const RowMatrix& rows, const RowMatrix& columns, std::span<const double> row_weight);

/// Sets of point unknowns that are connected by rows of positive weight, none of which fixes a position.
struct Floating {
    std::vector<std::vector<int>> parts;  ///< indices of the unknowns of each set
    std::vector<int> idle;                ///< indices of the unknowns in no row of positive weight
};
Floating floating_parts(const Unknowns& unknowns, std::span<const double> row_weight);

}  // namespace ostraka::solver
