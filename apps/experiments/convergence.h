// How fast the solver comes near the best that is known: plain and accelerated iterations compared.
#pragma once

#include "ostraka/report/plot.h"
#include "ostraka/solver/solve.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace ostraka::experiments {

/// Runs of one problem from the same start, which differ in their options only.
struct SolveRun {
    std::string name;  ///< e.g. "plain" (window 0), "accelerated, window 5"
    SolveSummary summary;
};

/// The least objective of all runs, and of `known` (from a long run, say).
double best_objective(const std::vector<SolveRun>& runs, double known = std::numeric_limits<double>::infinity());

/// Where the objective, less the best, has fallen to a share of what it was.
struct IterationReached {
    int iterations = 0;
    double seconds = 0;  ///< of iterations; the set-up is apart
};

struct Convergence {
    std::string name;
    int iterations = 0;
    double setup = 0, seconds = 0;  ///< of the set-up, of all iterations
    double left = 0;                ///< (last - best) / (start - best)
    double first_step = 0;          ///< (after the first step - best) / (start - best)
    std::optional<IterationReached> of_start,
        of_first_step;  ///< a thousandth of what was left at the start, and after the first step
    int refused = 0;
};

/// Throws Error (usage) for a run without objectives.
Convergence convergence(const SolveRun& run, double best, double share = 1e-3);

/// "not in 300" where the share was not reached; both iterations and seconds count from the start.
std::string convergence_header();
std::string convergence_row(const Convergence& run);
std::string convergence_csv_header();
std::string convergence_csv(const std::string& problem, const Convergence& run);

/// (objective - best) / (start - best) over the iterations, logarithmic.
Plot convergence_plot(const std::string& title, const std::vector<SolveRun>& runs, double best);

}  // namespace ostraka::experiments
