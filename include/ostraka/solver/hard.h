// Hard constraints, which must hold to a tolerance, combined with soft ones: an augmented Lagrangian around the local/global
// solver.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/solver/solve.h"

namespace ostraka {

struct HardOptions {
    SolveOptions inner{30, 1e-7, 0, 5};  ///< options of the inner solve in each round
    int rounds = 100;
    /// Initial penalty as a multiple of the weights; HardSummary::scale of an earlier solve of nearly the same system is a good
    /// value.
    double start = 1;
    double tolerance = 1e-6;  ///< a hard constraint is met if the distance of each of its rows is at most this share of the
                              ///< diagonal

    void list_options(OptionList& list);
};

struct HardSummary {
    bool met = false;  ///< all hard constraints are met to the tolerance; if not, the points are those of the smallest
                       ///< violation
    int rounds = 0;
    std::vector<double> violation;      ///< maximum distance of a hard row from its projection per round, in the points' unit
    std::vector<double> of_constraint;  ///< the same at the end, for each constraint; 0 for soft ones
    double tolerance = 0;               ///< in the points' unit
    double scale = 1;                   ///< maximum penalty weight reached, as a multiple of the constraint's weight
    SolveSummary last;                  ///< summary of the last round
};

/// Solves over the points of a mesh. Contradictory hard constraints are not met; the summary gives the violation.
class HardSolver {
public:
    /// `hard`: one flag per constraint. Throws Error (usage) for a wrong number of flags, and as MeshSpaceSolver does. Hard
    /// constraints need a positive weight, which scales their initial penalty.
    HardSolver(std::vector<std::unique_ptr<Constraint>> constraints, const std::vector<bool>& hard, const Points& rest);
    ~HardSolver();

    [[nodiscard]] std::size_t size() const;
    /// The original constraint: its projection and weight are those passed to the constructor.
    [[nodiscard]] const Constraint& constraint(std::size_t i) const;

    HardSummary solve(Points& points, const HardOptions& options = {});

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
