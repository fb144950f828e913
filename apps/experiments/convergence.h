// Convergence of the solver to the best known objective: plain and accelerated iterations compared.
#pragma once

#include "ostraka/report/plot.h"
#include "ostraka/solver/solve.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace ostraka::experiments {

/// A run of a problem. Runs that are compared start from the same shape and differ only in their options.
struct SolveRun {
    std::string name;  ///< e.g. "plain" (window 0), "accelerated, window 5"
    SolveSummary summary;
};

/// The minimal objective of all runs and of `known` (for instance from a long run).
double best_objective(const std::vector<SolveRun>& runs, double known = std::numeric_limits<double>::infinity());

/// The point at which the objective minus the best has fallen to a given share.
struct IterationReached {
    int iterations = 0;
    double seconds = 0;  ///< of iterations, without set-up
};

struct Convergence {
    std::string name;
    int iterations = 0;
    double setup = 0, seconds = 0;  ///< of the set-up; of all iterations
    double left = 0;                ///< (last - best) / (start - best)
    double first_step = 0;          ///< (after the first step - best) / (start - best)
    std::optional<IterationReached> of_start,
        of_first_step;  ///< when a thousandth is left of the value at the start, and of that after the first step
    int refused = 0;
};

/// Throws Error (usage) for a run without recorded objectives.
Convergence convergence(const SolveRun& run, double best, double share = 1e-3);

/// "not in 300" if the share was not reached; iterations and seconds both count from the start.
std::string convergence_header();
std::string convergence_row(const Convergence& run);
std::string convergence_csv_header();
std::string convergence_csv(const std::string& problem, const Convergence& run);

/// Plot of (objective - best) / (start - best) over the iterations, logarithmic.
Plot convergence_plot(const std::string& title, const std::vector<SolveRun>& runs, double best);

}  // namespace ostraka::experiments
