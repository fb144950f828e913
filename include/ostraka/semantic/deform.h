// Deformation that preserves the semantics given by annotations and relations (thesis, chapters 4 and 5; doc/deformation.md).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/relation/check.h"
#include "ostraka/semantic/edit.h"
#include "ostraka/solver/hard.h"

namespace ostraka {

struct DeformOptions {
    /// Unknowns of the solve: mesh or cage vertices. Automatic: ornaments are seated and the rest is solved over the mesh; if the
    /// result is not acceptable, the solve is repeated without seating; if that is not acceptable either, over the cage. If no
    /// result is acceptable, the best one is used.
    enum class Space { mesh, cage, automatic } space = Space::mesh;
    enum class Details { edited, rest } details = Details::edited;  ///< Laplacian displacements that the surface approaches
    /// Length over which a change fades out, as a share of the diagonal; at least three edges. The weight of each vertex's edited
    /// position is laplacian (edge / length)^4, where edge is the mean edge, so that the result does not depend on the
    /// resolution.
    double spread = 0.1;
    double laplacian = 2;  ///< weight of the Laplacian displacements, on every vertex
    /// Weight of the handles that the edit moves, and of the joints of stretched parts. Handles that a constraint also moves have
    /// the weight that corresponds to a third of the spread.
    double handles = 100;
    double followed = 0.9;  ///< minimum share of the edit that an acceptable result follows
    /// Maximum distortion, as a share of the diagonal, of parts that were not meant to change, in an acceptable result.
    double distortion = 0.005;
    SolveOptions solve;
    int rounds = 100;   ///< maximum number of rounds in which hard constraints are enforced
    int passes = 5;     ///< maximum number of passes that update constraints on axes and measures of other parts
    int conflicts = 8;  ///< maximum number of constraints omitted, one at a time, to find conflicts if one fails; 0: none

    void list_options(OptionList& list);
};

/// Tolerances for the result of a deformation: tighter than those for relations of scans, since deviations of edited shapes, such
/// as a wobbling chair, are visible.
inline RelationOptions deform_tolerances() {
    RelationOptions tolerances;
    tolerances.distance = 0.002;
    tolerances.angle = 1;
    return tolerances;
}

/// Outcome of one constraint.
struct ConstraintReport {
    int id = 0;  ///< id of the relationship
    std::vector<int> annotations;
    std::string type, text;  ///< text: why it is left out, or its violation
    bool used = false;       ///< whether it was part of the solve
    bool hard = false;
    double weight = 1;
    Verdict before = Verdict::unknown, verdict = Verdict::unknown;  ///< verdicts on the edited shape, and after solving
    std::vector<Deviation> deviations;                              ///< each with its unit and tolerance
    std::vector<double> before_values;                              ///< the same quantities on the edited shape
    /// Normalised residuals of its low-level constraints, in the mesh's unit (section 4.2.3 with its erratum).
    double mean = 0, median = 0, minimum = 0, maximum = 0;
    std::size_t low_level = 0;
    double distance = 0;  ///< maximum distance of one of their rows from its projection, in the mesh's unit
    /// Its term of the solver's objective, on the edited shape and after solving: weight times the squared distances of its rows
    /// from their projections. 0 for a constraint that is hard or not solved for.
    double cost_before = 0, cost = 0;
};

/// Conflict: constraints that hold only if another one is omitted.
struct ConstraintConflict {
    int id = 0;                         ///< id of the omitted constraint
    std::vector<int> freed;             ///< ids of the constraints that hold without it
    std::vector<Deviation> deviations;  ///< residual of the omitted constraint: the amount by which it would have to yield
};

/// Agreement of a result with the edit, over the vertices that the edit moves: its handles; through a cage the vertices of the
/// parts that it names or, if it names handles of the cage, the vertices that it moves by at least half of the maximum.
struct EditFollowed {
    std::size_t vertices = 0;
    double share = 1;              ///< 1 - root mean square of the deviations / that of the requested displacements; not below 0
    double mean = 0, largest = 0;  ///< deviations, in the mesh's unit
    /// A part that moved although the edit mostly does not name it: the mean displacement of its unnamed vertices (if the edit
    /// selects handles of a cage: relative to their edited positions), as a share of the diagonal.
    struct Moved {
        int annotation = 0;
        std::string tag;
        double share = 0;
        double largest = 0;  ///< maximum of one vertex
    };
    /// Parts that moved by more than 0.1 % of the diagonal in the mean, or by more than 0.5 % at one vertex; the largest first.
    std::vector<Moved> others;
};

/// A part whose shape changed although neither the edit nor a violated constraint was meant to change it.
struct DistortedPart {
    int annotation = 0;
    std::string tag;
    /// Distance from the best rigid motion of the edited part: root mean square and maximum over its vertices, in the mesh's
    /// unit.
    double distance = 0, largest = 0;
    bool distorted = false;  ///< whether `distance` exceeds the permitted distortion
    bool thinned = false;    ///< whether `thin` exceeds the permitted share
    double thin = 0;         ///< share of its area that is less than half as thick as at rest and as after the edit alone
};

/// Defects of the deformed surface.
struct SurfaceChange {
    std::size_t crossings = 0, crossings_before = 0;  ///< pairs of faces that cross each other, after and at rest
    std::size_t crossings_new = 0;                    ///< pairs after that did not cross at rest
    std::size_t folds = 0;  ///< edges with a dihedral deviation of more than 150 degrees, 30 more than at rest
    std::size_t kinks = 0;  ///< edges whose dihedral deviation solving increased by more than 60 degrees, to over 90
};

struct DeformResult {
    std::vector<Point> points;  ///< points of the mesh
    std::vector<Point> edited;  ///< positions after the edit alone
    EditFollowed followed;
    SurfaceChange surface;
    std::vector<DistortedPart> distorted;  ///< the worst first
    std::vector<Point> cage;               ///< handles after solving, if there is a cage
    std::vector<ConstraintReport> constraints;
    SolveSummary summary;                                     ///< with hard constraints in mesh space: summary of the last round
    int rounds = 0;                                           ///< number of rounds in which hard constraints were enforced
    bool solved = false;                                      ///< whether there were constraints to solve
    DeformOptions::Space space = DeformOptions::Space::mesh;  ///< unknowns of the solve: mesh or cage
    std::vector<int> seated;  ///< ids of constraints whose parts were seated by the automatic choice
    /// Whether every constraint holds, the edit is followed, and no faces cross or fold over that did not at rest (for restored
    /// positions, without an edit: whether every constraint holds).
    bool acceptable = true;
    std::vector<std::string> objections;  ///< why it is not acceptable
    int passes = 0;                       ///< number of passes until the parts to which constraints refer did not move
    std::vector<ConstraintConflict> conflicts;
    std::vector<std::size_t> selected;  ///< number of handles that each step selected
    std::size_t untried = 0;            ///< number of constraints that were not omitted, because of the limit `conflicts`
};

/// Applies the edit and solves for the constraints of the graph (relationships that are constraints). With a cage the edit moves
/// its vertices, and the mesh follows through the weights; without a cage it moves vertices of the mesh, and the surrounding
/// vertices follow (shape_of_edit). Then constraints are solved over the points of the mesh or of the cage (options.space).
/// Throws Error as follow_edit does; (input) for invalid constraints: a missing annotation, attribute or measure, an inverted
/// range, an empty region, a part without an axis; (usage) for cage space without a cage.
DeformResult deform(const HandleSpace& space, const RelationGraph& graph, const Edit& edit, const std::string& edit_name,
                    const DeformOptions& options = {}, const RelationOptions& tolerances = {},
                    const std::string& graph_name = "graph");

/// The mesh's points after a step of an edit alone: through a cage by its coordinates; without a cage the handles at their new
/// positions, and the other vertices with the smoothest displacement that fades out over the spread.
std::vector<Point> shape_of_edit(const HandleSpace& space, const EditState& state, const DeformOptions& options = {});

/// As `deform`, with given positions (of a fit, for example) instead of an edit: `held` vertices count as moved handles, the
/// other vertices approach their positions. Constraints refer to `object` as the shape at rest. Throws Error (usage) if the
/// numbers of positions, flags and vertices differ, and for cage space; (input) as deform.
DeformResult restore_constraints(AnnotatedMeshView object, const RelationGraph& graph, const std::vector<Point>& points,
                                 const std::vector<bool>& held, const DeformOptions& options = {},
                                 const RelationOptions& tolerances = {}, const std::string& graph_name = "graph");

/// Throws as deform does if a relationship that is a constraint is invalid.
void check_constraint(AnnotatedMeshView object, const Relationship& relationship, const std::string& where);

}  // namespace ostraka
