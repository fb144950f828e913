// Minimum cost assignment on a sparse graph. Includes no other headers of the project: the source file is compiled as C++17, for
// LEMON.
#pragma once

#include <cstdint>
#include <vector>

namespace ostraka::fitting {

/// An admissible assignment of a column to a row, with its cost.
struct AssignmentArc {
    int row, column;    ///< index of the row and of the column
    std::int64_t cost;  ///< cost of the assignment, at least 0
};

/// Assigns to each row one of the columns, each column at most once; -1: no column, at the cost `unassigned`. Minimises the sum
/// of costs (network simplex, LEMON).
std::vector<int> assign_columns(int rows, int columns, const std::vector<AssignmentArc>& arcs, std::int64_t unassigned);

}  // namespace ostraka::fitting
