// Computes a deformed shape from an edit and constraints; shared by 'deform', 'restore_constraints' and interactive drags.
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

/// Min weight of the Laplacian displacements; without them positions would be undetermined.
inline constexpr double min_laplacian = 1e-3;

/// Weight of the vertices' positions with which changes fade out over the spread (at least over three edges); `edge`: mean edge
/// length.
inline double closeness(const DeformOptions& options, const Mesh& mesh, double edge) {
    return std::max(options.laplacian, min_laplacian) *
           std::pow(std::min(edge / (options.spread * box_diagonal(mesh)), 1.0 / 3), 4);
}

/// Adds a constraint of this weight that attracts the points `ids` to the columns `id - offset` of `targets`.
void add_closeness(const std::vector<int>& ids, double weight, const Points& targets, int offset, const Points& rest,
                   std::vector<std::unique_ptr<Constraint>>& list);

/// Adds constraints on the Laplacian displacement of every vertex not in `others`; the targets are the displacements of `shape`,
/// or within resized parts (`sizes`) those of the resized copies.
void add_displacements(const Mesh& mesh, double weight, const Points& shape, const std::set<Index>& others, const Sizes* sizes,
                       std::vector<std::unique_ptr<Constraint>>& list);

/// Result of a solve for some of the constraints.
struct Outcome {
    Points points, cage;  ///< positions of the mesh's vertices, and of the cage's
    SolveSummary summary;
    int rounds = 0, passes = 0;  ///< number of rounds and passes
    bool solved = false;         ///< true: there was something to solve
    /// Residuals of one constraint.
    struct Residuals {
        std::vector<double> low_level_residuals;         ///< residual of each low-level constraint
        double distance = 0, cost = 0, cost_before = 0;  ///< as in ConstraintReport
    };
    std::vector<Residuals> residuals;          ///< residuals of each constraint in the report
    std::vector<std::string> texts;            ///< for each constraint, a text for the report
    std::vector<semantic::Measured> measured;  ///< for each constraint, its deviations and verdict
};

/// The linear system of constraints over the vertices of a cage.
struct CageSystem {
    /// Weights of the mesh's points followed by rows for the cage's vertices, so that cage vertices are constrained like other
    /// points.
    std::unique_ptr<CageWeights> extended;
    std::unique_ptr<CageSpaceSolver> solver;
    std::size_t first_displacement = 0, displacements = 0;  ///< indices of the constraints on the cage's Laplacian displacements
};

/// Computes one deformation.
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

    /// Lets the displacements of parts that neither the edit nor a constraint moves fade out over the whole spread, instead of a
    /// third of the spread.
    void fade_over_whole_spread() { fades_over_whole_spread_ = true; }

    /// Result of `deform`.
    DeformResult follow(const Edit& edit);
    /// Result of `restore_constraints`.
    DeformResult restore(const std::vector<Point>& points, const std::vector<bool>& held);

    /// Positions of the mesh's vertices.
    struct Solved {
        Points edited, points;  ///< positions after the edit, and after solving
    };
    /// Positions after the edit, and after solving, without a verdict.
    Solved solve_only(const Edit& edit);
    /// Interpretation of each constraint.
    [[nodiscard]] const std::vector<semantic::Statement>& statements() const { return statements_; }

    /// A solver for a drag of these handles, starting from the edited cage, whose vertices are written to `cage`; no solver if
    /// there is no constraint to solve for.
    CageSystem begin(const Edit& edit, const std::vector<Index>& handles, std::vector<Point>& cage);

private:
    // The verdict: deformer_verdict.cpp
    void add_surface(DeformResult& result) const;  ///< writes the defects of the deformed surface to the result
    /// Vertices that the edit and the violated constraints were expected to change.
    [[nodiscard]] semantic::Expected expected(const DeformResult& result) const;
    static std::string percent(double share) { return digits(100 * share, 3) + " %"; }  ///< text of a share, such as "12.5 %"
    DeformResult finish(DeformResult result);                         ///< adds verdict and objections to the result
    static std::string name_of(const ConstraintReport& report);       ///< name of a constraint for messages
    void report(DeformResult& result, const Outcome& outcome) const;  ///< writes the outcome of each constraint to the result
    /// Why constraint i cannot be satisfied because its measure contradicts another constraint; empty: no contradiction.
    [[nodiscard]] std::string contradiction(const DeformResult& result, std::size_t i) const;
    /// Omits each constraint in turn, failing constraints first, and records which others then hold.
    void find_conflicts(DeformResult& result, const std::vector<bool>& all);

    // The constraints, and the passes of the solve: deformer_passes.cpp
    /// Applies all steps of the edit. Returns for each step the number of handles that it selects.
    std::vector<std::size_t> follow_steps(const Edit& edit);
    /// Interprets the constraints of the graph.
    void understand(DeformResult& result);
    /// Lets parts on one level keep their shape up to their size, if another constraint changes their size and the constraint on
    /// the level does not specify `shapes`.
    void let_levels_be_resized(const semantic::Shape& shape, const DeformResult& result);
    /// Index of the preceding hard constraint that contradicts hard constraint i, and the reason; solving for both would destroy
    /// the part.
    [[nodiscard]] std::optional<std::pair<std::size_t, std::string>> contradicted(std::size_t i,
                                                                                  const std::vector<bool>& active) const;
    /// For each constraint, whether it is part of the solve.
    static std::vector<bool> used(const DeformResult& result);
    /// Solves for the constraints marked in `active`; all others are only measured. Constraints that hold after the edit are
    /// solved for only if others violate them.
    Outcome solve(const std::vector<bool>& active);
    /// Solves for the constraints marked in `active`.
    Outcome solve_for(const std::vector<bool>& active);
    /// Repeats the solve until the references of constraints do not move. Returns the positions before the last pass.
    Points make_passes(const std::vector<bool>& active, Outcome& outcome);
    /// Max deviation of the active hard constraints with references, as a multiple of their tolerance.
    [[nodiscard]] double shortfall(const std::vector<bool>& active, const Outcome& outcome) const;
    /// Repeats passes with varying stretch factors of parts with required sizes, until the sizes are reached; otherwise keeps the
    /// best pass.
    Points search_sizes(const std::vector<bool>& active, Outcome& outcome);
    /// Whether the reference of a constraint has moved, except for constraints on measures.
    [[nodiscard]] bool other_references_moved(const std::vector<bool>& active, const Outcome& outcome,
                                              const Points& before) const;
    /// Whether the reference of a constraint may have moved.
    [[nodiscard]] bool another_pass(const std::vector<bool>& active, const Outcome& outcome) const;
    /// Writes the residuals of the low-level constraints of each constraint, divided by their numbers of points (section 4.2.3),
    /// on the final shape: relative to the axes of the final shape, and to the measures before the last pass.
    void keep_residuals(const std::vector<bool>& active, const Points& before, const semantic::State& finished,
                        Outcome& outcome) const;

    // The system of one pass: deformer_system.cpp
    /// Creates the low-level constraints; the current outcome determines the references. Returns false if there are no low-level
    /// constraints.
    bool lower(const std::vector<bool>& active, Outcome& outcome);
    /// Sets up the parts with required sizes.
    void begin_sizes(const std::vector<bool>& active);
    /// Whether the constraint is enforced by the values of its measures.
    [[nodiscard]] bool is_sized(std::size_t i) const;
    /// Adds resized copies of the parts with required sizes as targets. Containing parts blend towards the copies over a third of
    /// the spread.
    void add_sizes();
    /// Solves once, starting from the outcome. Returns false if there is nothing to solve.
    bool solve_once(const std::vector<bool>& active, Outcome& outcome);
    /// Moves the low-level constraints to the end of the list `others`, and sets first_ to the index of the first.
    std::vector<std::unique_ptr<Constraint>> take(std::vector<std::unique_ptr<Constraint>> others);
    /// For each mesh vertex, whether the edit itself moves it: the handles, or with a cage the vertices of the parts that the
    /// edit names, unless these are most of the object.
    [[nodiscard]] std::vector<bool> handles_on_mesh() const;
    /// Solves over the mesh's vertices.
    void solve_mesh(Outcome& outcome);
    /// For each handle of nested cages, whether it may move: handles of the levels that contain constrained parts; all others are
    /// fixed, so that each part is controlled by its own cage.
    [[nodiscard]] std::vector<bool> movable_handles() const;
    /// All constraints over the cage's vertices. The first constraint fixes the handles that steps of the edit moved, if there
    /// are any.
    CageSystem cage_system();
    /// Solves over the cage's vertices.
    void solve_cage(Outcome& outcome);

    const HandleSpace& space_;
    const RelationGraph& graph_;
    const DeformOptions& options_;
    const RelationOptions& tolerances_;
    std::string where_, graph_where_;
    Points rest_;                                       ///< positions of the mesh's vertices at rest
    EditState last_;                                    ///< state after the last step of the edit
    std::vector<bool> asked_;                           ///< for each vertex, whether the edit moves it; empty: no distinction
    bool is_under_way_ = false;                         ///< true: handles are being dragged
    bool fades_over_whole_spread_ = false;              ///< see fade_over_whole_spread
    Mesh edited_mesh_;                                  ///< the mesh after the edit
    Points edited_;                                     ///< positions of the mesh's vertices after the edit
    std::vector<semantic::Statement> statements_;       ///< for each constraint in the report, its interpretation
    std::deque<Relationship> resized_levels_;           ///< copies of relationships to which statements refer
    std::vector<std::unique_ptr<Constraint>> lowered_;  ///< low-level constraints
    std::vector<std::unique_ptr<Constraint>> support_;  ///< constraints that help the surface to follow
    std::vector<std::size_t> owner_;  ///< for each low-level constraint, the index of its constraint in the report
    std::size_t first_ = 0;           ///< index of the first low-level constraint in the solver's list
    /// Vertices that stay in place, that rotate, and of reference parts (see Statement).
    std::set<Index> anchors_, rotating_, referred_;
    std::optional<semantic::Sizes> sizes_;  ///< parts with required sizes
    double hard_scale_ = 1;                 ///< initial penalty scale of hard constraints, from previous passes
};

}  // namespace ostraka::semantic
