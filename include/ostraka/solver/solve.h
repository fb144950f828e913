// The local/global solver of ShapeUp and ShapeOp, over the points of a shape or through a cage.
//
// It minimises phi(x) = sum of w_i |B_i x - P_i(B_i x)|^2 by alternating two steps: the local step computes the projections P_i
// for fixed x, in parallel; the global step computes x for fixed projections p from the normal equations Q^T Q x = Q^T p (the
// thesis, equation 4.8). All three coordinates share one factorisation. Through a cage, x = W c, and the unknowns are c
// (equation 4.9).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/solver/constraint.h"

#include <memory>
#include <string>
#include <vector>

namespace ostraka {

struct SolveOptions {
    int iterations = 100;     ///< maximum number of global steps
    double tolerance = 1e-6;  ///< stop when no point moves by more than this share of the rest shape's diagonal
    double residual = 0;  ///< stop when the root mean square distance of the weighted rows falls to this value, in the points'
                          ///< unit
    int window = 5;       ///< number of previous steps used by Anderson acceleration; 0: plain iterations

    void list_options(OptionList& list);
};

enum class StopReason { converged, residual, iterations, stalled };
/// The reason as text, e.g. "no point moves any more".
std::string_view describe(StopReason reason);

struct SolveTimes {
    double symbolic = 0, factor = 0;  ///< seconds of set-up in this solve, or in the initialisation before it
    double project = 0, solve = 0, accelerate = 0;
};

struct SolveSummary {
    int iterations = 0;
    std::vector<double> objective;     ///< phi at the start and after each iteration; never increases
    std::vector<double> seconds;       ///< time since the start of the iterations, for each objective
    int accelerated = 0, refused = 0;  ///< accelerated steps, and those rejected because they increased the objective
    StopReason stop = StopReason::iterations;
    SolveTimes times;
    int floating_parts = 0;    ///< connected sets of points without a fixed position: their mean stays at rest
    bool regularised = false;  ///< the system was still singular; all points are attracted to the rest shape with weight
                               ///< `regularisation`
    double regularisation = 0;
    int updated_rows = 0;       ///< rows with changed weight, applied as a low-rank update of an older factorisation
    double factor_entries = 0;  ///< number of entries of the factorisation
    bool usable = false;        ///< the result is finite and the objective no higher than at the start
    std::string text() const;   ///< summary of a few lines
};

/// Constraints over points, and the matrices of their solve. `rest` are the points to which singular systems are attracted,
/// independent of the constraints' own rest states. Changes of weights and targets are cheap where possible; matrices are
/// recomputed when needed.
class Solver {
public:
    virtual ~Solver() = default;
    Solver(const Solver&) = delete;
    Solver& operator=(const Solver&) = delete;

    [[nodiscard]] std::size_t size() const { return constraints_.size(); }
    [[nodiscard]] const Constraint& constraint(std::size_t i) const { return *constraints_.at(i); }

    /// Computes missing factorisations; solve() calls it if necessary. Throws Error (failure) when memory is short.
    virtual void initialize() = 0;
    /// Throws Error (usage) as Constraint::set_weight.
    void set_weight(std::size_t constraint, double weight);
    /// Throws Error (usage) as Constraint::set_target.
    void set_target(std::size_t constraint, const Points& target);

    /// Solves from the initial `variables` (points of the shape, or of the cage) and stores the result in them. The same to the
    /// bit for any number of threads. Throws Error (usage) for a wrong number of points or points that are not finite.
    SolveSummary solve(Points& variables, const SolveOptions& options = {});

protected:
    Solver(std::vector<std::unique_ptr<Constraint>> constraints, Eigen::Index variables, double diagonal);

    /// Moves `variables` to the subspace in which all iterations stay.
    virtual void start(Points&) {}
    /// Computes the projections at `variables`; returns phi.
    virtual double project(const Points& variables) = 0;
    /// Solves the normal equations for the last projections.
    virtual void global_step(Points& variables) = 0;
    virtual void weight_changed(std::size_t constraint, double before) = 0;
    /// Called before and after a change of target.
    virtual void target_changing(std::size_t) {}
    virtual void target_changed(std::size_t constraint) = 0;

    std::vector<std::unique_ptr<Constraint>> constraints_;
    double diagonal_;
    double rounding_ = 0;      ///< differences of phi below this are rounding; set by initialize()
    double total_weight_ = 0;  ///< weight times rows, over all constraints; set by initialize()
    SolveSummary setup_;       ///< summary of initialize()
private:
    Eigen::Index variables_;
};

/// Solver over the points themselves: sparse Cholesky factorisation of Q^T Q.
class MeshSpaceSolver final : public Solver {
public:
    /// Throws Error (usage) for ids beyond the rest points.
    MeshSpaceSolver(std::vector<std::unique_ptr<Constraint>> constraints, Points rest);
    ~MeshSpaceSolver() override;
    void initialize() override;

    /// Enforces constraints with given components (Constraint::given_components) exactly, by elimination: the solution has the
    /// given components, and the weights of these constraints no longer matter. Returns false without changes if that is
    /// impossible: other constraints do not fix all of their points, one has no given components, or they have more than 256
    /// rows. Contradictory constraints are met in the least-squares sense. Throws Error (usage) for a constraint index out of
    /// range.
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

/// Cage coordinates: one row per point of the shape, one column per point of the cage.
using CageWeights = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Solver over the points of a cage, x = W c (equation 4.9). Q W is formed once, for constrained points only, and only for rows
/// whose projections change. Large groups are reduced to their moments, so that an iteration does not depend on their size.
/// Dense Cholesky factorisation of the cage's size. Deformations that the weights cannot represent leave a residual: see
/// Constraint::residual of points_of(cage).
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

/// W c, in parallel. Throws Error (usage) if the sizes differ.
Points points_of(const CageWeights& weights, const Points& cage);

}  // namespace ostraka
