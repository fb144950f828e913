// Products of a few thousand rows of weights with three columns: the innermost loops of the cage-space solver.
#pragma once

#include <Eigen/Core>

namespace ostraka::solver {

/// Rows are padded with zeros to a multiple of eight.
inline Eigen::Index padded(Eigen::Index columns) { return (columns + 7) / 8 * 8; }

/// out(axis, r) += m(r, :) . d(:, axis). m: `rows` rows of `stride` doubles; d: three columns of `stride`; out: three values
/// per row.
void add_rows(const double* m, Eigen::Index rows, Eigen::Index stride, const double* d, double* out);

/// sum(:, axis) += sum over r of p(axis, r) m(r, :).
void add_sums(const double* m, Eigen::Index rows, Eigen::Index stride, const double* p, double* sum);

}  // namespace ostraka::solver
