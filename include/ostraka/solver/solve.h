// The local/global solver of ShapeUp and ShapeOp, over the points of a shape or over the points of a cage.
//
// The solver minimises phi(x) = sum of w_i |B_i x - P_i(B_i x)|^2 by alternating two steps: the local step computes the
// projections P_i for fixed x, in parallel; the global step computes x for fixed projections p from the normal equations Q^T Q x
// = Q^T p (thesis, equation 4.8). All three coordinates share one factorisation. With a cage, x = W c, and the unknowns are the
// points c of the cage (equation 4.9).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/solver/constraint.h"

#include <memory>
#include <string>
#include <vector>

namespace ostraka {

struct SolveOptions {
    int iterations = 100;  ///< max number of global steps
    /// The solve stops when no point moves by more than this share of the diagonal of the points at rest.
    double tolerance = 1e-6;
    /// The solve stops when the root mean square distance of the weighted rows from their projections falls to this value, in the
    /// points' unit.
    double residual = 0;
    int window = 5;  ///< number of previous steps used by Anderson acceleration; 0: no acceleration

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// The reason why a solve stopped.
enum class StopReason { converged, residual, iterations, stalled };
/// The reason why a solve stopped as text, e.g. "no point moves any more".
std::string_view describe(StopReason reason);

/// Computing times of a solve, in seconds.
struct SolveTimes {
    /// Symbolic and numerical factorisation, in this solve or in the preceding initialisation.
    double symbolic = 0, factor = 0;
    double project = 0, solve = 0, accelerate = 0;  ///< local steps, global steps, and acceleration
};

/// Statistics of a solve.
struct SolveSummary {
    int iterations = 0;             ///< number of global steps
    std::vector<double> objective;  ///< value of phi at the start and after each iteration; never increases
    std::vector<double> seconds;    ///< for each value of phi, the time since the start of the iterations
    /// Number of accelerated steps, and of those rejected because they increased the objective.
    int accelerated = 0, refused = 0;
    StopReason stop = StopReason::iterations;  ///< why the solve stopped
    SolveTimes times;                          ///< computing times
    /// Number of connected sets of points whose position no constraint determines; the mean of such a set stays at its rest
    /// position.
    int floating_parts = 0;
    /// True: the system was singular also after this, and all points are attracted to their rest positions with the weight
    /// `regularisation`.
    bool regularised = false;
    double regularisation = 0;  ///< weight with which points are attracted to the rest positions; 0: none
    int updated_rows = 0;       ///< number of rows with changed weight, applied as a low-rank update of an older factorisation
    double factor_entries = 0;  ///< number of entries of the factorisation
    bool usable = false;        ///< true: the result is finite and the objective is not higher than at the start
    std::string text() const;   ///< the summary as a few lines of text
};

/// Solver for constraints over points; base class of the two solvers below. If the system is singular, points are attracted to
/// rest positions, which are independent of the rest states of the constraints. Changes of weights and targets are cheap where
/// possible; matrices are recomputed when needed.
class Solver {
public:
    virtual ~Solver() = default;
    Solver(const Solver&) = delete;
    Solver& operator=(const Solver&) = delete;

    /// Number of constraints.
    [[nodiscard]] std::size_t size() const { return constraints_.size(); }
    [[nodiscard]] const Constraint& constraint(std::size_t i) const { return *constraints_.at(i); }

    /// Computes missing factorisations; solve() calls this function if necessary. Throws Error (failure) when memory is short.
    virtual void initialize() = 0;
    /// Changes the weight of a constraint. Throws the errors of Constraint::set_weight.
    void set_weight(std::size_t constraint, double weight);
    /// Changes the target of a constraint. Throws the errors of Constraint::set_target.
    void set_target(std::size_t constraint, const Points& target);

    /// Solves from the initial `variables` (points of the shape, or of the cage) and stores the result in `variables`. The result
    /// is the same to the bit for any number of threads. Throws Error (usage) for a wrong number of points or points that are not
    /// finite.
    SolveSummary solve(Points& variables, const SolveOptions& options = {});

protected:
    Solver(std::vector<std::unique_ptr<Constraint>> constraints, Eigen::Index variables, double diagonal);

    /// Moves `variables` to the affine subspace in which all iterations stay.
    virtual void start(Points&) {}
    /// Local step: computes the projections at `variables`; returns phi.
    virtual double project(const Points& variables) = 0;
    /// Global step: solves the normal equations for the projections that the last call of `project` computed.
    virtual void global_step(Points& variables) = 0;
    /// Called after the weight of a constraint was changed from `before`.
    virtual void weight_changed(std::size_t constraint, double before) = 0;
    /// Called before the target of a constraint changes.
    virtual void target_changing(std::size_t) {}
    /// Called after the target of a constraint was changed.
    virtual void target_changed(std::size_t constraint) = 0;

    std::vector<std::unique_ptr<Constraint>> constraints_;  ///< all constraints, in the order given
    double diagonal_;                                       ///< diagonal of the points at rest
    double rounding_ = 0;      ///< differences of phi below this value are rounding errors; set by initialize()
    double total_weight_ = 0;  ///< sum over all constraints of weight times number of rows; set by initialize()
    SolveSummary setup_;       ///< summary of initialize()
private:
    Eigen::Index variables_;  ///< number of points
};

/// Solver over the points of the shape: sparse Cholesky factorisation of Q^T Q.
class MeshSpaceSolver final : public Solver {
public:
    /// `rest`: points of the shape at rest. Throws Error (usage) for ids beyond these points.
    MeshSpaceSolver(std::vector<std::unique_ptr<Constraint>> constraints, Points rest);
    ~MeshSpaceSolver() override;
    void initialize() override;

    /// Enforces constraints with prescribed components (Constraint::given_components) exactly, by elimination: the solution has
    /// these components, and the weights of these constraints have no effect. Returns false without changes if this is
    /// impossible: other constraints do not fix all of the constraints' points, a constraint has no prescribed components, or
    /// the constraints have more than 256 rows. Contradictory constraints are satisfied in the least-squares sense. Throws
    /// Error (usage) for a constraint index out of range.
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

/// Weights of a cage: one row per point of the shape, one column per point of the cage.
using CageWeights = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Solver over the points c of a cage, x = W c (equation 4.9). The product Q W is computed once, only for constrained points
/// and only for rows whose projections change. Constraints on many points are evaluated by moments (Constraint::Moments), so
/// that the time of an iteration does not depend on the number of points. The normal equations of the size of the cage are
/// factorised by dense Cholesky factorisation. If the weights cannot represent a deformation, a residual remains:
/// Constraint::residual of points_of(weights, cage).
class CageSpaceSolver final : public Solver {
public:
    /// Throws Error (usage) for ids out of range of the rows of `weights`, weights that are not finite, and a cage whose number
    /// of points differs from the number of columns of `weights`.
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

/// Points of the shape for these points of the cage: W c, in parallel. Throws Error (usage) if the sizes differ.
Points points_of(const CageWeights& weights, const Points& cage);

}  // namespace ostraka
