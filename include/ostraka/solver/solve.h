// The local/global solver of ShapeUp and ShapeOp, over the points of a shape or through a cage.
//
// It minimises phi(x) = sum of w_i |B_i x - P_i(B_i x)|^2 by turns: P_i for fixed x (local, in parallel), then x for fixed
// projections p by the normal equations Q^T Q x = Q^T p (global; the thesis, equation 4.8). All three coordinates share one
// factorisation. Through a cage, x = W c, and c is solved for (equation 4.9).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/solver/constraint.h"

#include <memory>
#include <string>
#include <vector>

namespace ostraka {

struct SolveOptions {
    int iterations = 100;     ///< at most so many global steps
    double tolerance = 1e-6;  ///< stop when no point moves by more than this share of the rest shape's diagonal
    double residual = 0;  ///< stop when the root mean square of the weighted rows' distances falls to this, in the points' unit
    int window = 5;       ///< steps that Anderson acceleration looks back; 0: plain iterations

    void describe(OptionList& visit);
};

enum class StopReason { converged, residual, iterations, stalled };
/// E.g. "no point moves any more".
std::string_view describe(StopReason reason);

struct SolveTimes {
    double symbolic = 0, factor = 0;  ///< seconds of set-up work that this solve, or the initialisation before it, needed
    double project = 0, solve = 0, accelerate = 0;
};

struct SolveSummary {
    int iterations = 0;
    std::vector<double> objective;     ///< phi at the start and after each iteration; never increases
    std::vector<double> seconds;       ///< since the start of the iterations, beside each objective
    int accelerated = 0, refused = 0;  ///< steps that acceleration made, and those that its guard took back
    StopReason stop = StopReason::iterations;
    SolveTimes times;
    int floating_parts =
        0;  ///< sets of points that constraints tie together but nothing holds in place: their mean stays at rest
    bool regularised = false;  ///< singular beyond that: all was drawn towards the rest shape, with `regularisation` as weight
    double regularisation = 0;
    int updated_rows = 0;       ///< rows of new weight that were taken as a low-rank update of an older factorisation
    double factor_entries = 0;  ///< numbers that the factorisation holds
    bool usable = false;        ///< the result is finite and the objective no higher than at the start
    std::string text() const;   ///< in a few lines
};

/// Constraints over points and the matrices they need. `rest` are the points that singular systems are drawn to; what constraints
/// call rest is their own. Changes of weights and targets are cheap where they can be; matrices are renewed when next needed.
class Solver {
public:
    virtual ~Solver() = default;
    Solver(const Solver&) = delete;
    Solver& operator=(const Solver&) = delete;

    [[nodiscard]] std::size_t size() const { return constraints_.size(); }
    [[nodiscard]] const Constraint& constraint(std::size_t i) const { return *constraints_.at(i); }

    /// Factorises what is not yet; solve() does it by itself. Throws Error (failure) when memory is short.
    virtual void initialize() = 0;
    /// Throws Error (usage) as Constraint::set_weight.
    void set_weight(std::size_t constraint, double weight);
    /// Throws Error (usage) as Constraint::set_target.
    void set_target(std::size_t constraint, const Points& target);

    /// Solves from `variables` (points of the shape, or of the cage) and leaves the result there. The same to the bit for any
    /// number of threads. Throws Error (usage) for a wrong number of points or points that are not finite.
    SolveSummary solve(Points& variables, const SolveOptions& options = {});

protected:
    Solver(std::vector<std::unique_ptr<Constraint>> constraints, Eigen::Index variables, double diagonal);

    /// Brings `variables` to where all iterations stay.
    virtual void start(Points&) {}
    /// Projects at `variables`, returns phi.
    virtual double project(const Points& variables) = 0;
    /// Solves the normal equations for the last projections.
    virtual void global_step(Points& variables) = 0;
    virtual void weight_changed(std::size_t constraint, double before) = 0;
    /// Before and after.
    virtual void target_changing(std::size_t) {}
    virtual void target_changed(std::size_t constraint) = 0;

    std::vector<std::unique_ptr<Constraint>> constraints_;
    double diagonal_;
    double rounding_ = 0;      ///< differences of phi below this mean nothing; set by initialize()
    double total_weight_ = 0;  ///< weight times rows, over all constraints; set by initialize()
    SolveSummary setup_;       ///< what initialize() has to say
private:
    Eigen::Index variables_;
};

/// Over the points themselves: sparse Cholesky of Q^T Q.
class MeshSpaceSolver final : public Solver {
public:
    /// Throws Error (usage) for ids beyond the rest points.
    MeshSpaceSolver(std::vector<std::unique_ptr<Constraint>> constraints, Points rest);
    ~MeshSpaceSolver() override;
    void initialize() override;

    /// Makes constraints with given components (Constraint::given_components) hold exactly, by elimination: what they give is
    /// the solution's, and their weights do not count any more. False, and nothing changes, where that cannot be: other
    /// constraints do not hold all of their points in place, one has no such components, or they have more than 256 rows. Where
    /// they contradict each other they are met as nearly as may be. Throws Error (usage) for one that does not exist.
    bool enforce(const std::vector<std::size_t>& constraints);

protected:
    void start(Points& points) override;
    double project(const Points& points) override;
    void global_step(Points& points) override;
    void weight_changed(std::size_t constraint, double before) override;
    void target_changed(std::size_t constraint) override;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// A row of weights for each point of the shape, a column for each point of the cage.
using CageWeights = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Over the points of a cage, x = W c (equation 4.9). Q W is formed once, for constrained points only, and only where projections
/// change; large groups are reduced to their moments, so that an iteration does not depend on their size. Dense Cholesky of the
/// cage's size. What the weights cannot reach stays as far off as it must: see Constraint::residual of points_of(cage).
class CageSpaceSolver final : public Solver {
public:
    /// Throws Error (usage) for ids beyond the rows of `weights`, weights that are not finite, and a cage with another number of
    /// points than `weights` has columns.
    CageSpaceSolver(std::vector<std::unique_ptr<Constraint>> constraints, const CageWeights& weights, Points rest_cage);
    ~CageSpaceSolver() override;
    void initialize() override;

protected:
    double project(const Points& cage) override;
    void global_step(Points& cage) override;
    void weight_changed(std::size_t constraint, double before) override;
    void target_changing(std::size_t constraint) override;
    void target_changed(std::size_t constraint) override;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// W c, in parallel. Throws Error (usage) where the sizes differ.
Points points_of(const CageWeights& weights, const Points& cage);

}  // namespace ostraka
