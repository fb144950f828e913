// Convergence of the solver to the best known objective: plain and accelerated iterations compared.
#pragma once

#include "ostraka/files/file.h"
#include "ostraka/solver/solve.h"

#include <functional>
#include <string>
#include <vector>

namespace ostraka::experiments {

/// A problem that is solved from the same start by several numbers of iterations and windows of the acceleration (0: plain).
struct Problem {
    std::string name, title;
    std::function<SolveSummary(int iterations, int window)> solve;
};

/// Runs each problem with the given windows, and `longer` times as many iterations with the last window to know the best
/// objective. Writes FOLDER/convergence.md, .csv and a plot for each problem, and returns the tables; nothing for 0 iterations.
std::string compare_convergence(const Path& folder, const std::vector<Problem>& problems, int iterations,
                                const std::vector<int>& windows = {0, 2, 5}, int longer = 4);

}  // namespace ostraka::experiments
