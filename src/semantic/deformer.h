// Computes a shape from an edit and constraints; shared by 'deform', 'restore_constraints' and interactive drags.
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

/// Without any, positions would be undetermined.
inline constexpr double min_laplacian = 1e-3;

/// Weight of positions for which changes fade out over the spread, at least over three edges.
inline double closeness(const DeformOptions& options, const Mesh& mesh, double edge) {
    return std::max(options.laplacian, min_laplacian) *
           std::pow(std::min(edge / (options.spread * box_diagonal(mesh)), 1.0 / 3), 4);
}

void add_closeness(const std::vector<int>& ids, double weight, const Points& targets, int offset, const Points& rest,
                   std::vector<std::unique_ptr<Constraint>>& list);

/// Laplacian displacements of `shape` on every vertex; within resized parts those of the resized copies.
void add_displacements(const Mesh& mesh, double weight, const Points& shape, const std::set<Index>& others, const Sizes* sizes,
                       std::vector<std::unique_ptr<Constraint>>& list);

/// Result of a solve for some of the constraints.
struct Outcome {
    Points points, cage;
    SolveSummary summary;
    int rounds = 0, passes = 0;
    bool solved = false;
    struct Residuals {
        std::vector<double> of_low_level;
        double distance = 0, cost = 0, cost_before = 0;
    };
    std::vector<Residuals> residuals;  ///< residuals of each constraint
    std::vector<std::string> texts;    ///< text on each constraint for the report
    std::vector<semantic::Measured> measured;
};

/// Constraints over the vertices of a cage.
struct CageSystem {
    /// The rows of the cage's points follow those of the mesh, so that handles are constrained like any point.
    std::unique_ptr<CageWeights> extended;
    std::unique_ptr<CageSpaceSolver> solver;
    std::size_t first_displacement = 0, displacements = 0;  ///< indices of the Laplacian displacements of the cage
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

    /// Displacements of parts that neither the edit nor a constraint moves fade out over the whole spread, instead of a third of
    /// it.
    void let_neighbours_give() { neighbours_give_ = true; }

    DeformResult follow(const Edit& edit);
    DeformResult restore(const std::vector<Point>& points, const std::vector<bool>& held);

    struct Solved {
        Points edited, points;
    };
    /// The shape after the edit, and after solving, without a verdict.
    Solved solve_only(const Edit& edit);
    [[nodiscard]] const std::vector<semantic::Statement>& statements() const { return statements_; }

    /// A solver for a drag of these handles, starting from the edited cage, whose vertices are returned; no solver if there is no
    /// constraint to solve for.
    CageSystem begin(const Edit& edit, const std::vector<Index>& handles, std::vector<Point>& cage);

private:
    // The verdict: deformer_verdict.cpp
    void add_surface(DeformResult& result) const;
    /// Vertices that the edit and the violated constraints are expected to change.
    [[nodiscard]] semantic::Expected expected(const DeformResult& result) const;
    static std::string percent(double share) { return digits(100 * share, 3) + " %"; }
    DeformResult finish(DeformResult result);
    static std::string name_of(const ConstraintReport& report);
    void report(DeformResult& result, const Outcome& outcome) const;
    /// Reason why the measure of this constraint is impossible, if another constraint contradicts it.
    [[nodiscard]] std::string contradiction(const DeformResult& result, std::size_t i) const;
    /// Omits each constraint in turn, failing ones first.
    void find_conflicts(DeformResult& result, const std::vector<bool>& all);

    // The constraints, and the passes of the solve: deformer_passes.cpp
    /// Applies all steps. Returns the number of handles that each step selects.
    std::vector<std::size_t> follow_steps(const Edit& edit);
    void understand(DeformResult& result);
    /// Parts on one level keep their shape, but not their size if another constraint changes it and the constraint does not
    /// specify `shapes`.
    void let_levels_be_resized(const semantic::Shape& shape, const DeformResult& result);
    /// The preceding hard constraint that contradicts this hard one, and the reason; solving for both would destroy the part.
    [[nodiscard]] std::optional<std::pair<std::size_t, std::string>> contradicted(std::size_t i,
                                                                                  const std::vector<bool>& active) const;
    static std::vector<bool> used(const DeformResult& result);
    /// Solves for the active constraints; all others are only measured. Constraints that hold after the edit are not solved for
    /// unless others violate them.
    Outcome solve(const std::vector<bool>& active);
    Outcome solve_for(const std::vector<bool>& active);
    /// Repeats the solve until the references of constraints do not move. Returns the points before the last pass.
    Points make_passes(const std::vector<bool>& active, Outcome& outcome);
    /// Maximum deviation of hard constraints with references, as a multiple of their tolerance.
    [[nodiscard]] double shortfall(const std::vector<bool>& active, const Outcome& outcome) const;
    /// Passes with varying factors of parts with required sizes, until these are met; otherwise the best one.
    Points search_sizes(const std::vector<bool>& active, Outcome& outcome);
    /// Whether the reference of a constraint other than a measure has moved.
    [[nodiscard]] bool others_go_on(const std::vector<bool>& active, const Outcome& outcome, const Points& before) const;
    /// Whether the reference of a constraint may have moved.
    [[nodiscard]] bool another_pass(const std::vector<bool>& active, const Outcome& outcome) const;
    /// Residuals of the low-level constraints of each constraint, divided by their numbers of points (section 4.2.3), on the
    /// final shape: relative to its axes, and to the measures before the last pass.
    void keep_residuals(const std::vector<bool>& active, const Points& before, const semantic::State& finished,
                        Outcome& outcome) const;

    // The system of one pass: deformer_system.cpp
    /// Creates the low-level constraints from the current outcome, which determines the references. False if there are none.
    bool lower(const std::vector<bool>& active, Outcome& outcome);
    void begin_sizes(const std::vector<bool>& active);
    /// Whether the constraint is enforced by the values of its measures.
    [[nodiscard]] bool is_sized(std::size_t i) const;
    /// Adds copies of the parts with required sizes. Containing parts blend towards them over a third of the spread.
    void add_sizes();
    /// Solves once, starting from the outcome. False if there is nothing to solve.
    bool solve_once(const std::vector<bool>& active, Outcome& outcome);
    /// Moves the low-level constraints into the list, starting at first_.
    std::vector<std::unique_ptr<Constraint>> take(std::vector<std::unique_ptr<Constraint>> others);
    /// Vertices that the edit itself moves: its handles, or through a cage the vertices of the parts that it names, unless these
    /// are most of the object.
    [[nodiscard]] std::vector<bool> handles_on_mesh() const;
    void solve_mesh(Outcome& outcome);
    /// For nested cages, the handles of the levels that contain constrained parts; the others are fixed, so that each part is
    /// controlled by its own cage.
    [[nodiscard]] std::vector<bool> handles_asked() const;
    /// All constraints over the cage's vertices. The first one fixes the handles that steps moved, if any.
    CageSystem cage_system();
    void solve_cage(Outcome& outcome);

    const HandleSpace& space_;
    const RelationGraph& graph_;
    const DeformOptions& options_;
    const RelationOptions& tolerances_;
    std::string where_, graph_where_;
    Points rest_;
    EditState last_;
    std::vector<bool> asked_;    ///< vertices that the edit moves; empty: no distinction
    bool is_under_way_ = false;  ///< handles are being dragged
    bool neighbours_give_ = false;
    Mesh edited_mesh_;
    Points edited_;
    std::vector<semantic::Statement> statements_;  ///< statements of the constraints in the report
    std::deque<Relationship> resized_levels_;      ///< relationships to which statements refer
    std::vector<std::unique_ptr<Constraint>> lowered_;
    std::vector<std::unique_ptr<Constraint>> support_;
    std::vector<std::size_t> owner_;  ///< index in the report of each low-level constraint
    std::size_t first_ = 0;           ///< index of the first one in the solver's list
    std::set<Index> anchors_, rotating_, referred_;
    std::optional<semantic::Sizes> sizes_;
    double hard_scale_ = 1;  ///< initial penalty scale of hard constraints, from previous passes
};

}  // namespace ostraka::semantic
