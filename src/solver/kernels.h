// Products of a few thousand rows of weights with three columns: the innermost loops of CageSpaceSolver.
#pragma once

#include <Eigen/Core>

namespace ostraka::solver {

/// Length of a row of weights in memory: rows are padded with zeros to a multiple of eight.
inline Eigen::Index padded(Eigen::Index columns) { return (columns + 7) / 8 * 8; }

/// Adds products of rows with three columns: out(axis, r) += m(r, :) . d(:, axis). m: `rows` rows of `stride` doubles; d: three
/// columns of `stride` doubles; out: three values per row.
void add_rows(const double* m, Eigen::Index rows, Eigen::Index stride, const double* d, double* out);

/// Adds weighted sums of rows: sum(:, axis) += sum over r of p(axis, r) m(r, :).
void add_sums(const double* m, Eigen::Index rows, Eigen::Index stride, const double* p, double* sum);

}  // namespace ostraka::solver
