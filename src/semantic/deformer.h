// How an edit and constraints become a shape: what 'deform', 'restore_constraints' and live drags share.
#pragma once

#include <cmath>
#include <deque>
#include <set>
#include "ostraka/cage/cage.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/with_points.h"
#include "ostraka/semantic/deform.h"
#include "semantic/distortion.h"
#include "semantic/sizes.h"
#include "semantic/statement.h"

namespace ostraka::semantic {

/// Without any, nothing would hold positions.
inline constexpr double min_laplacian = 1e-3;

/// Weight of the positions of points an edge apart, so that changes fade out over the spread, and over three edges at least.
inline double closeness(const DeformOptions& options, const Mesh& mesh, double edge) {
    return std::max(options.laplacian, min_laplacian) *
           std::pow(std::min(edge / (options.spread * box_diagonal(mesh)), 1.0 / 3), 4);
}

void add_closeness(const std::vector<int>& ids, double weight, const Points& targets, int offset, const Points& rest,
                   std::vector<std::unique_ptr<Constraint>>& list);

/// On every vertex, those that `shape` has; within parts that are made larger or smaller, as these.
void add_displacements(const Mesh& mesh, double weight, const Points& shape, const std::set<Index>& others, const Sizes* sizes,
                       std::vector<std::unique_ptr<Constraint>>& list);

/// What solving for some of the constraints gives.
struct Outcome {
    Points points, cage;
    SolveSummary summary;
    int rounds = 0, passes = 0;
    bool solved = false;
    struct Residuals {
        std::vector<double> of_low_level;
        double distance = 0, cost = 0, cost_before = 0;
    };
    std::vector<Residuals> residuals;  ///< of each constraint
    std::vector<std::string> texts;    ///< what is to be said of each
    std::vector<semantic::Measured> measured;
};

/// Constraints over the vertices of a cage.
struct CageSystem {
    /// Rows for the cage's own points below those of the mesh, so that handles are constrained like any point.
    std::unique_ptr<CageWeights> extended;
    std::unique_ptr<CageSpaceSolver> solver;
    std::size_t first_displacement = 0, displacements = 0;  ///< places of the Laplacian displacements of the cage
};

class Deformer {
public:
    Deformer(const HandleSpace& space, const RelationGraph& graph, const DeformOptions& options,
             const RelationOptions& tolerances, const std::string& where, const std::string& graph_where)
        : space_(space),
          graph_(graph),
          options_(options),
          tolerances_(tolerances),
          where_(where),
          graph_where_(graph_where),
          rest_(columns_of(space.mesh)) {}

    /// What neither the edit nor a constraint asks to move gives way over all of the spread, instead of a third of it.
    void let_neighbours_give() { neighbours_give_ = true; }

    DeformResult follow(const Edit& edit);
    DeformResult restore(const std::vector<Point>& points, const std::vector<bool>& held);

    struct Solved {
        Points edited, points;
    };
    /// The shape after the edit, and after solving; nothing is judged.
    Solved solve_only(const Edit& edit);
    [[nodiscard]] const std::vector<semantic::Statement>& statements() const { return statements_; }

    /// For a drag of these handles from where the edit leaves the cage, whose vertices are handed over; no solver where no
    /// constraint asks for anything.
    CageSystem begin(const Edit& edit, const std::vector<Index>& handles, std::vector<Point>& cage);

private:
    // The verdict: deformer_verdict.cpp
    void add_surface(DeformResult& result) const;
    /// What the edit and the constraints that did not hold give leave to change.
    [[nodiscard]] semantic::Expected expected(const DeformResult& result) const;
    static std::string percent(double share) { return digits(100 * share, 3) + " %"; }
    DeformResult finish(DeformResult result);
    static std::string name_of(const ConstraintReport& report);
    void report(DeformResult& result, const Outcome& outcome) const;
    /// Why the measure of this constraint cannot be, if that of another shows it.
    [[nodiscard]] std::string contradiction(const DeformResult& result, std::size_t i) const;
    /// Leaves out one constraint after another. Those that fail are tried first.
    void find_conflicts(DeformResult& result, const std::vector<bool>& all);

    // What is asked, and the passes in which it is solved for: deformer_passes.cpp
    /// To the state after the last step. How many handles each step selects.
    std::vector<std::size_t> follow_steps(const Edit& edit);
    void understand(DeformResult& result);
    /// Parts on one level keep their shape; but their size only where no other constraint changes it, and where the constraint
    /// does not say itself how they are kept.
    void let_levels_be_resized(const semantic::Shape& shape, const DeformResult& result);
    /// By a hard constraint before it, why a hard one is not solved for: it would only crush the part.
    [[nodiscard]] std::optional<std::pair<std::size_t, std::string>> contradicted(std::size_t i,
                                                                                  const std::vector<bool>& active) const;
    static std::vector<bool> used(const DeformResult& result);
    /// For the active constraints; all others are only measured. What holds where the edit leaves it is left alone, until others
    /// take it away.
    Outcome solve(const std::vector<bool>& active);
    Outcome solve_for(const std::vector<bool>& active);
    /// Solves until what constraints follow stands still. The points before the last pass.
    Points make_passes(const std::vector<bool>& active, Outcome& outcome);
    /// Of the hard constraints that follow others, the greatest deviation as a multiple of its tolerance.
    [[nodiscard]] double shortfall(const std::vector<bool>& active, const Outcome& outcome) const;
    /// Passes with other factors for the parts that must have certain sizes, until these have them; else the best of them.
    Points search_sizes(const std::vector<bool>& active, Outcome& outcome);
    /// Whether a constraint that is no measure still follows what has moved.
    [[nodiscard]] bool others_go_on(const std::vector<bool>& active, const Outcome& outcome, const Points& before) const;
    /// Whether what a constraint follows may have moved.
    [[nodiscard]] bool another_pass(const std::vector<bool>& active, const Outcome& outcome) const;
    /// Of the low-level constraints of each, divided by their points (section 4.2.3), on the finished shape: against axes as they
    /// are there, and measures as they were before the last pass.
    void keep_residuals(const std::vector<bool>& active, const Points& before, const semantic::State& finished,
                        Outcome& outcome) const;

    // The system of one pass: deformer_system.cpp
    /// The low-level constraints, from the outcome so far: parts that others refer to are as it has them. False if there are
    /// none.
    bool lower(const std::vector<bool>& active, Outcome& outcome);
    void begin_sizes(const std::vector<bool>& active);
    /// Whether the constraint is enforced by the values of its measures.
    [[nodiscard]] bool is_sized(std::size_t i) const;
    /// Copies of the parts that must have certain sizes. Those that hold others give way to them over a third of the spread.
    void add_sizes();
    /// Starts from the outcome. False if there is nothing to solve.
    bool solve_once(const std::vector<bool>& active, Outcome& outcome);
    /// The low-level constraints move into the list; first_ is where they begin.
    std::vector<std::unique_ptr<Constraint>> take(std::vector<std::unique_ptr<Constraint>> others);
    /// Vertices that the edit moves itself: its handles, or through a cage those of the parts that it names, unless these are
    /// most of the object.
    [[nodiscard]] std::vector<bool> handles_on_mesh() const;
    void solve_mesh(Outcome& outcome);
    /// Of cages within a cage, the handles of the levels that hold what constraints are about: the others shall stand, so that
    /// each part is brought to what is asked of it by its own cage.
    [[nodiscard]] std::vector<bool> handles_asked() const;
    /// All constraints over the cage's vertices. Its first one holds the handles that steps moved, if there are any.
    CageSystem cage_system();
    void solve_cage(Outcome& outcome);

    const HandleSpace& space_;
    const RelationGraph& graph_;
    const DeformOptions& options_;
    const RelationOptions& tolerances_;
    std::string where_, graph_where_;
    Points rest_;
    EditState last_;
    std::vector<bool> asked_;    ///< vertices that the edit asks to move; empty: none is told from others
    bool is_under_way_ = false;  ///< handles are being dragged
    bool neighbours_give_ = false;
    Mesh edited_mesh_;
    Points edited_;
    std::vector<semantic::Statement> statements_;  ///< of the constraints in the report
    std::deque<Relationship> resized_levels_;      ///< that statements refer to
    std::vector<std::unique_ptr<Constraint>> lowered_;
    std::vector<std::unique_ptr<Constraint>> support_;
    std::vector<std::size_t> owner_;  ///< of each lowered constraint, in the report
    std::size_t first_ = 0;           ///< its place in the solver's list
    std::set<Index> anchors_, rotating_, referred_;
    std::optional<semantic::Sizes> sizes_;
    double hard_scale_ = 1;  ///< from which hard constraints are enforced, as passes so far tell
};

}  // namespace ostraka::semantic
