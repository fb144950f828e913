#include "ostraka/solver/hard.h"

#include <algorithm>

namespace ostraka {

namespace {

/// P(rows + u) - u with the scaled multipliers u: the local step of the augmented Lagrangian (Boyd et al. 2011, section 3.1.1).
class Shifted final : public Constraint {
public:
    explicit Shifted(std::unique_ptr<Constraint> inner)
        : Constraint(inner->kind(), inner->ids(), inner->weight()),
          u(Points::Zero(3, inner->map().rows)),
          inner_(std::move(inner)) {
        map_ = inner_->map();
    }
    void project(const RowsIn& rows, RowsOut projected) const override {
        const Points shifted = rows + u;
        inner_->project(shifted, projected);
        projected -= u;
    }
    void set_target(const Points& target) override { inner_->set_target(target); }
    [[nodiscard]] std::optional<Components> given_components() const override { return inner_->given_components(); }
    [[nodiscard]] const Constraint& inner() const { return *inner_; }

    /// Updates the multipliers by the residual of the shifted rows; returns the greatest distance of a row from its projection.
    double update(const Points& points) {
        Points rows, shifted(3, map_.rows);
        rows_of(points, rows);
        project(rows, shifted);
        u += rows - shifted;
        u.rightCols(map_.observed).setZero();
        return inner_->greatest_distance(points);
    }
    Points u;

private:
    std::unique_ptr<Constraint> inner_;
};

}  // namespace

struct HardSolver::State {
    std::vector<Shifted*> hard;  ///< for each constraint; null for soft ones
    std::unique_ptr<MeshSpaceSolver> solver;
    double diagonal = 0;

    /// Selects the hard constraints that are eliminated; the others are enforced by multipliers.
    std::vector<bool> eliminated() const {
        std::vector<bool> flags(hard.size(), false);
        std::vector<std::size_t> list;
        for (std::size_t i = 0; i < hard.size(); ++i)
            if (hard[i] != nullptr && hard[i]->given_components()) list.push_back(i);
        if (!list.empty() && solver->enforce(list))
            for (const std::size_t i : list) flags[i] = true;
        return flags;
    }
};

HardSolver::HardSolver(std::vector<std::unique_ptr<Constraint>> constraints, const std::vector<bool>& hard, const Points& rest)
    : state_(std::make_unique<State>()) {
    if (hard.size() != constraints.size()) fail_usage("there must be a flag, hard or not, for each constraint");
    for (std::size_t i = 0; i < constraints.size(); ++i) {
        state_->hard.push_back(nullptr);
        if (!hard[i] || !constraints[i]) continue;
        if (!(constraints[i]->weight() > 0))
            fail_usage("hard constraint " + std::to_string(i) + " has no weight",
                       "its enforcement starts from its weight: give one");
        auto shifted = std::make_unique<Shifted>(std::move(constraints[i]));
        state_->hard.back() = shifted.get();
        constraints[i] = std::move(shifted);
    }
    if (rest.cols() > 0) state_->diagonal = (rest.rowwise().maxCoeff() - rest.rowwise().minCoeff()).norm();
    state_->solver = std::make_unique<MeshSpaceSolver>(std::move(constraints), rest);
}

HardSolver::~HardSolver() = default;

std::size_t HardSolver::size() const { return state_->hard.size(); }

const Constraint& HardSolver::constraint(std::size_t i) const {
    return state_->hard.at(i) != nullptr ? state_->hard[i]->inner() : state_->solver->constraint(i);
}

HardSummary HardSolver::solve(Points& points, const HardOptions& options) {
    check_options(options, "solver");
    if (!(options.start > 0 && options.start < 1e100)) fail_usage("the start of enforcement is not positive", "1 is the weights");
    HardSummary summary;
    summary.tolerance = options.tolerance * state_->diagonal;
    constexpr double raise = 4, maximum = 1e8;  // growth factor and limit of the penalty weight, relative to the initial weight
    for (std::size_t i = 0; i < state_->hard.size(); ++i)
        if (state_->hard[i] != nullptr) {
            state_->hard[i]->u.setZero();
            state_->solver->set_weight(i, options.start * constraint(i).weight());
        }
    const std::vector<bool> eliminated = state_->eliminated();
    bool turns = false;
    for (std::size_t i = 0; i < state_->hard.size(); ++i) turns = turns || (state_->hard[i] != nullptr && !eliminated[i]);
    SolveOptions inner = options.inner;
    if (!turns) inner.iterations *= 4;  // a single round suffices
    summary.scale = options.start;
    summary.of_constraint.assign(state_->hard.size(), 0.0);
    std::vector<double> before(state_->hard.size(), std::numeric_limits<double>::infinity());
    // With contradictory constraints the penalties keep growing: keep the best state, and stop after some rounds without
    // progress.
    constexpr int patience = 12;
    Points best = points;
    double minimum = std::numeric_limits<double>::infinity();
    int since = 0;
    std::vector<double> of_best;
    while (summary.rounds < options.rounds && !summary.met && since < patience) {
        summary.last = state_->solver->solve(points, inner);
        ++summary.rounds;
        double worst = 0;
        for (std::size_t i = 0; i < state_->hard.size(); ++i) {
            Shifted* const hard = state_->hard[i];
            if (hard == nullptr) continue;
            const double now = summary.of_constraint[i] =
                eliminated[i] ? hard->inner().greatest_distance(points) : hard->update(points);
            worst = std::max(worst, now);
            if (eliminated[i]) continue;
            // If multipliers alone converge too slowly the penalty weight is raised; the multipliers (weight times u) are
            // unchanged.
            constexpr double fast_enough = 0.5;
            const double weight = hard->weight();
            if (now > summary.tolerance && now > fast_enough * before[i] && weight < maximum * constraint(i).weight()) {
                state_->solver->set_weight(i, raise * weight);
                summary.scale = std::max(summary.scale, raise * weight / constraint(i).weight());
                hard->u /= raise;
            }
            before[i] = now;
        }
        summary.violation.push_back(worst);
        summary.met = worst <= summary.tolerance;
        since = worst < 0.9 * minimum ? 0 : since + 1;
        if (worst < minimum || summary.met) {
            minimum = worst;
            best = points;
            of_best = summary.of_constraint;
        }
    }
    if (!summary.met && summary.rounds > 0 && summary.last.usable && !of_best.empty()) {
        points = best;
        summary.of_constraint = of_best;
    }
    return summary;
}

void HardOptions::declare_options(OptionList& list) {
    inner.declare_options(list);
    list("rounds", rounds, "maximum number of rounds in which hard constraints are enforced", Range{1, 1e6});
    list("hard-tolerance", tolerance, "maximum distance by which a hard constraint may be violated", Range{1e-15, 1},
         "share of the diagonal");
}

}  // namespace ostraka
