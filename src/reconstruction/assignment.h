// Assignment of least cost on a sparse graph. No other headers of ours: its source is compiled as C++17, which LEMON needs.
#pragma once

#include <cstdint>
#include <vector>

namespace ostraka::fitting {

/// A row may be given this column at this cost.
struct AssignmentArc {
    int row, column;
    std::int64_t cost;  ///< at least 0
};

/// The column of each row, each column given once at most, -1: none, at the cost `unassigned`; with the least sum of costs
/// (network simplex, LEMON).
std::vector<int> assign_columns(int rows, int columns, const std::vector<AssignmentArc>& arcs, std::int64_t unassigned);

}  // namespace ostraka::fitting
