// Solves for hard constraints, which must be satisfied up to a tolerance, together with soft constraints: an augmented
// Lagrangian method around the local/global solver.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/solver/solve.h"

namespace ostraka {

struct HardOptions {
    SolveOptions inner{30, 1e-7, 0, 5};  ///< options of the solve in each round
    int rounds = 100;                    ///< max number of rounds
    /// Initial penalty as a multiple of the constraints' weights. HardSummary::scale of an earlier solve of nearly the same
    /// system is a good value.
    double start = 1;
    /// Max distance of a row of a satisfied hard constraint from its projection, as a share of the diagonal of the points.
    double tolerance = 1e-6;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Result of a solve with hard constraints.
struct HardSummary {
    /// True: all hard constraints are satisfied to the tolerance; false: the points are those of the round with the smallest
    /// violation.
    bool met = false;
    int rounds = 0;                 ///< number of rounds
    std::vector<double> violation;  ///< for each round, the max distance of a hard row from its projection, in the points' unit
    /// For each constraint, the max distance of a row from its projection at the end; 0 for soft constraints.
    std::vector<double> of_constraint;
    double tolerance = 0;  ///< max distance of a row of a satisfied hard constraint, in the points' unit
    double scale = 1;      ///< largest penalty reached, as a multiple of the constraint's weight
    SolveSummary last;     ///< summary of the last round
};

/// Solves hard and soft constraints over the points of a mesh. Contradictory hard constraints are not satisfied; the summary
/// gives the violation.
class HardSolver {
public:
    /// `hard`: for each constraint, true if it is hard; `rest`: points at rest. Throws Error (usage) for a wrong number of
    /// flags, and the errors of MeshSpaceSolver. Hard constraints need a positive weight, which scales their initial penalty.
    HardSolver(std::vector<std::unique_ptr<Constraint>> constraints, const std::vector<bool>& hard, const Points& rest);
    ~HardSolver();

    /// Number of constraints.
    [[nodiscard]] std::size_t size() const;
    /// The constraint that was passed to the constructor, with its original projection and weight.
    [[nodiscard]] const Constraint& constraint(std::size_t i) const;

    /// Solves from the initial `points` and stores the result in `points`.
    HardSummary solve(Points& points, const HardOptions& options = {});

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
