#include "ostraka/solver/solve.h"

#include "ostraka/core/message_text.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/execution/parallel.h"
#include "solver/anderson.h"

#include <cmath>
#include <sstream>

namespace ostraka {

std::string_view describe(StopReason reason) {
    return enum_name(reason, {"no point moves any more", "the residual wanted is reached", "the iterations allowed are used up",
                              "the objective does not fall any further"});
}

std::string SolveSummary::text() const {
    std::ostringstream out;
    out << iterations << " iterations, objective " << (objective.empty() ? 0.0 : objective.front()) << " to "
        << (objective.empty() ? 0.0 : objective.back()) << ": " << describe(stop) << '\n';
    if (accelerated > 0) out << accelerated << " accelerated steps, " << refused << " of them taken back\n";
    out << "set-up " << times.symbolic + times.factor << " s, projections " << times.project << " s, solves " << times.solve
        << " s, acceleration " << times.accelerate << " s\n";
    if (floating_parts > 0) out << floating_parts << " parts that nothing holds in place: their mean stays at rest\n";
    if (regularised) out << "singular: drawn towards the rest shape with weight " << regularisation << '\n';
    if (!usable) out << "not usable\n";
    return out.str();
}

Solver::Solver(std::vector<std::unique_ptr<Constraint>> constraints, Eigen::Index variables, double diagonal)
    : constraints_(std::move(constraints)), diagonal_(diagonal), variables_(variables) {
    for (const auto& constraint : constraints_)
        if (!constraint) fail_usage("a constraint is missing");
}

void Solver::set_weight(std::size_t constraint, double weight) {
    Constraint& changed = *constraints_.at(constraint);
    const double before = changed.weight();
    changed.set_weight(weight);
    if (weight != before) weight_changed(constraint, before);
}

void Solver::set_target(std::size_t constraint, const Points& target) {
    Constraint& changed = *constraints_.at(constraint);
    target_changing(constraint);
    try {
        changed.set_target(target);
    } catch (...) {
        target_changed(constraint);
        throw;
    }
    target_changed(constraint);
}

SolveSummary Solver::solve(Points& variables, const SolveOptions& options) {
    check_options(options, "solver");
    if (variables.cols() != variables_)
        fail_usage("the solver is made for " + std::to_string(variables_) + " points and got " +
                   std::to_string(variables.cols()));
    check_points(variables, "points to solve for");
    initialize();
    SolveSummary summary = setup_;
    setup_.times = {};
    const Stopwatch clock;
    const auto project_at = [&](const Points& at) {
        const ScopedSeconds watch(summary.times.project);
        return project(at);
    };
    const auto record = [&](double objective) {
        summary.objective.push_back(objective);
        summary.seconds.push_back(clock.seconds());
    };
    // The objective counts as rounding below this share of its initial value.
    constexpr double rounding = 1e-15;
    solver::Anderson anderson(options.window);
    Points& x = variables;
    this->start(x);
    Points plain = x, candidate;
    double phi = project_at(x);
    record(phi);
    const double start = phi;
    const auto reached = [&] {
        return options.residual > 0 && std::sqrt(phi / std::max(total_weight_, 1e-300)) <= options.residual;
    };
    if (reached()) summary.stop = StopReason::residual;
    while (summary.iterations < options.iterations && summary.stop != StopReason::residual) {
        plain = x;
        {
            const ScopedSeconds watch(summary.times.solve);
            global_step(plain);
        }
        ++summary.iterations;
        bool accelerated = false;
        if (options.window > 0) {
            const ScopedSeconds watch(summary.times.accelerate);
            anderson.next(x, plain, candidate);
            accelerated = summary.iterations > 1;
        }
        double next = std::numeric_limits<double>::infinity();
        if (accelerated) {
            ++summary.accelerated;
            next = candidate.allFinite() ? project_at(candidate) : next;
            if (!(next <= phi)) {
                ++summary.refused;
                accelerated = false;
            }
        }
        if (!accelerated) {
            next = project_at(plain);
            if (!(next <=
                  phi + rounding * start + rounding_)) {  // happens only if a projection is not the closest admissible one
                project_at(x);
                summary.stop = StopReason::stalled;
                record(phi);
                break;
            }
            next = std::min(next, phi);
        }
        Points& to = accelerated ? candidate : plain;
        const double moved = x.cols() > 0 ? (to - x).colwise().squaredNorm().maxCoeff() : 0;
        x.swap(to);
        phi = next;
        record(phi);
        if (reached()) {
            summary.stop = StopReason::residual;
        } else if (std::sqrt(moved) <= options.tolerance * diagonal_) {
            summary.stop = StopReason::converged;
            break;
        }
    }
    summary.usable = x.allFinite() && std::isfinite(phi) && phi <= start;
    return summary;
}

Points points_of(const CageWeights& weights, const Points& cage) {
    if (weights.cols() != cage.cols())
        fail_usage("the weights are of " + std::to_string(weights.cols()) + " cage points, and the cage has " +
                   std::to_string(cage.cols()));
    Points points(3, weights.rows());
    const Eigen::Matrix<double, Eigen::Dynamic, 3> c = cage.transpose();
    parallel_for(static_cast<std::size_t>(weights.rows()), [&](std::size_t i) {
        const auto r = static_cast<Eigen::Index>(i);
        for (int axis = 0; axis < 3; ++axis) points(axis, r) = weights.row(r).dot(c.col(axis));
    });
    return points;
}

void SolveOptions::declare_options(OptionList& list) {
    list("iterations", iterations, "maximum number of global steps", Range{0, 1e7});
    list("tolerance", tolerance, "stop when no point moves by more than this distance per iteration", Range{0, 1},
         "share of the diagonal");
    list("residual", residual,
         "stop when the weighted root mean square distance of the rows from their projections is at most this value",
         Range{0, 1e300});
    list("window", window, "number of previous iterations from which the acceleration extrapolates; 0: no acceleration",
         Range{0, 50});
}

}  // namespace ostraka
