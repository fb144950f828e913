// Constraints that must hold to a tolerance, beside others that need not: an augmented Lagrangian around the local/global solver.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/solver/solve.h"

namespace ostraka {

struct HardOptions {
    SolveOptions inner{30, 1e-7, 0, 5};  ///< of each round
    int rounds = 100;
    /// Enforcement starts from so many times the weights; an earlier solution of nearly the same system tells
    /// (HardSummary::scale).
    double start = 1;
    double tolerance = 1e-6;  ///< a hard constraint holds when none of its rows is farther off than this share of the diagonal

    void describe(OptionList& visit);
};

struct HardSummary {
    bool met = false;  ///< all hard constraints hold to the tolerance; if not, the points are those that came nearest
    int rounds = 0;
    std::vector<double>
        violation;  ///< greatest distance of a hard row from what is admissible, after each round, in the points' unit
    std::vector<double> of_constraint;  ///< the same at the end, of each constraint; 0 for the others
    double tolerance = 0;               ///< in the points' unit
    double scale = 1;                   ///< greatest weight that was reached, as a multiple of the constraint's
    SolveSummary last;                  ///< of the last round
};

/// Over the points of a mesh. Hard constraints that contradict one another are not met; the summary says by how much.
class HardSolver {
public:
    /// Throws Error (usage) unless there is a flag for each constraint, and as MeshSpaceSolver does. Hard constraints need a
    /// positive weight, from which their enforcement starts.
    HardSolver(std::vector<std::unique_ptr<Constraint>> constraints, const std::vector<bool>& hard, const Points& rest);
    ~HardSolver();

    [[nodiscard]] std::size_t size() const;
    /// As handed in: its projection and its weight are those of the constraint itself.
    [[nodiscard]] const Constraint& constraint(std::size_t i) const;

    HardSummary solve(Points& points, const HardOptions& options = {});

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
