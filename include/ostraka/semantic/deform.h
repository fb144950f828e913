// Deformation that keeps what annotations and relations ask for (thesis, chapters 4 and 5; doc/deformation.md).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/relation/check.h"
#include "ostraka/semantic/edit.h"
#include "ostraka/solver/hard.h"

namespace ostraka {

struct DeformOptions {
    /// Where constraints are solved: the points of which. Automatic: ornaments are seated and the rest is solved over the mesh;
    /// where that is not acceptable, nothing is seated; where that is not either, over the cage. The best of them, if none is
    /// acceptable.
    enum class Space { mesh, cage, automatic } space = Space::mesh;
    enum class Details { edited, rest } details = Details::edited;  ///< what the surface tends to between constraints
    /// Over what length a change fades out, as a share of the diagonal. Each vertex tends to its edited position with the weight
    /// laplacian (edge / length)^4, edge the mean edge: what it is does not depend on the resolution. Three edges at least.
    double spread = 0.1;
    double laplacian = 2;  ///< weight of the Laplacian displacements, on every vertex
    /// Weight of the handles that the edit moves, and of the joints that parts stretch from. Handles that a constraint moves as
    /// well are held as by a third of the spread.
    double handles = 100;
    double followed = 0.9;  ///< share of the edit that an acceptable result follows
    /// Share of the diagonal by which an acceptable result may distort parts that were not to change.
    double distortion = 0.005;
    SolveOptions solve;
    int rounds = 100;   ///< of the loop that enforces hard constraints
    int passes = 5;     ///< in which constraints on the axes and measures of other parts follow those
    int conflicts = 8;  ///< where a constraint fails, at most so many are left out in turn to see which fight; 0: none

    void describe(OptionList& visit);
};

/// The tolerances by which the result of a deformation is judged: tighter than what relations ask of scans, since a wobbling
/// chair shows.
inline RelationOptions deform_tolerances() {
    RelationOptions tolerances;
    tolerances.distance = 0.002;
    tolerances.angle = 1;
    return tolerances;
}

/// What became of one constraint.
struct ConstraintReport {
    int id = 0;  ///< of the relationship
    std::vector<int> annotations;
    std::string type, text;  ///< text: why it is left out, or what is wrong
    bool used = false;       ///< it took part in the solution
    bool hard = false;
    double weight = 1;
    Verdict before = Verdict::unknown, verdict = Verdict::unknown;  ///< on the edited shape, and after solving
    std::vector<Deviation> deviations;                              ///< each with its unit and tolerance
    std::vector<double> before_values;                              ///< of the same quantities on the edited shape
    /// Normalised residuals of its low-level constraints, in the mesh's unit (section 4.2.3 with its erratum).
    double mean = 0, median = 0, minimum = 0, maximum = 0;
    std::size_t low_level = 0;
    double distance = 0;  ///< greatest distance of one of their rows from what it admits, in the mesh's unit
    /// What it adds to what the solver minimises, on the edited shape and after solving: weight times the squared distances of
    /// its rows from what they admit. Of a constraint that is hard or not solved for: 0.
    double cost_before = 0, cost = 0;
};

/// Without one constraint, others hold that do not hold with it.
struct ConstraintConflict {
    int id = 0;                         ///< of the constraint that was left out
    std::vector<int> freed;             ///< ids of those that hold without it
    std::vector<Deviation> deviations;  ///< how far off it is then: what it would have to give
};

/// How far a result does what the edit asked, over the vertices that it asked to move: its handles; through a cage those of the
/// parts that it names, and where it names handles of the cage itself those that it moves by half as much as any.
struct EditFollowed {
    std::size_t vertices = 0;
    double share = 1;  ///< 1 - root mean square of the deviations / that of the displacements that were asked; not below 0
    double mean = 0, largest = 0;  ///< deviations, in the mesh's unit
    /// A part moved of which most was not asked to: the mean displacement of those vertices (where the edit selects handles of a
    /// cage, that beside where it leaves them), as a share of the diagonal.
    struct Moved {
        int annotation = 0;
        std::string tag;
        double share = 0;
        double largest = 0;  ///< of one vertex
    };
    /// By more than 0.1 % of the diagonal, or by more than 0.5 % in one vertex; the largest first.
    std::vector<Moved> others;
};

/// A part that has become another shape, though neither the edit nor a constraint that did not hold before asked it to.
struct DistortedPart {
    int annotation = 0;
    std::string tag;
    /// From the best rigid motion of the part as the edit leaves it: root mean square, and of one vertex, in the mesh's unit.
    double distance = 0, largest = 0;
    bool distorted = false;  ///< by more than it may
    bool thinned = false;    ///< on more of its area than it may
    double thin = 0;         ///< share of its area where it is less than half as thick as at rest and as the edit leaves it
};

/// What became of the surface as such.
struct SurfaceChange {
    std::size_t crossings = 0, crossings_before = 0;  ///< pairs of faces that cross each other, after and at rest
    std::size_t crossings_new = 0;                    ///< of those after: pairs that did not cross at rest
    std::size_t folds = 0;  ///< edges whose faces turn away from each other by more than 150 degrees, 30 more than at rest
    std::size_t kinks = 0;  ///< edges at which solving turned the faces by more than 60 degrees away from each other, to over 90
};

struct DeformResult {
    std::vector<Point> points;  ///< of the mesh
    std::vector<Point> edited;  ///< as the edit alone leaves them
    EditFollowed followed;
    SurfaceChange surface;
    std::vector<DistortedPart> distorted;  ///< the worst first
    std::vector<Point> cage;               ///< handles after solving, if there is a cage
    std::vector<ConstraintReport> constraints;
    SolveSummary summary;                                     ///< with hard constraints in mesh space: of the last round
    int rounds = 0;                                           ///< in which hard constraints were enforced
    bool solved = false;                                      ///< there were constraints to solve
    DeformOptions::Space space = DeformOptions::Space::mesh;  ///< where they were solved: over the mesh or over the cage
    std::vector<int> seated;  ///< ids of constraints whose parts were seated by the automatic choice
    /// Every constraint holds, the edit is followed, and no faces cross or fold over that did not at rest (of restored positions,
    /// which follow no edit: the constraints alone).
    bool acceptable = true;
    std::vector<std::string> objections;  ///< why it is not acceptable
    int passes = 0;                       ///< solutions until the parts that constraints refer to stood still
    std::vector<ConstraintConflict> conflicts;
    std::vector<std::size_t> selected;  ///< handles that each step selected
    std::size_t untried = 0;            ///< constraints that were not left out, since there are so many
};

/// Follows the edit and solves for the constraints of the graph (relationships that are constraints). With a cage the edit moves
/// its vertices and the mesh by the weights; without one it moves vertices of the mesh, and those around follow (shape_of_edit).
/// Constraints are then solved over the mesh's points or over the cage's, as options.space says. Throws Error
/// as follow_edit does, (input) for constraints that cannot be made sense of: a missing annotation, attribute or measure, a range
/// upside down, an empty region, a part without an axis; (usage) for cage space without a cage.
DeformResult deform(const HandleSpace& space, const RelationGraph& graph, const Edit& edit, const std::string& edit_name,
                    const DeformOptions& options = {}, const RelationOptions& tolerances = {},
                    const std::string& graph_name = "graph");

/// The mesh's points as a step of an edit alone leaves them: through a cage by its coordinates; without one the vertices that it
/// moves where it puts them and the others by the smoothest displacement that fades out over the spread.
std::vector<Point> shape_of_edit(const HandleSpace& space, const EditState& state, const DeformOptions& options = {});

/// The same from positions that stand already (of a fit, say) instead of an edit: `held` vertices count as handles that were
/// moved there, the others tend to their positions. Constraints refer to `object` as the shape at rest. Throws Error (usage)
/// unless there are as many positions and flags as vertices, and for cage space; (input) as deform.
DeformResult restore_constraints(AnnotatedMeshView object, const RelationGraph& graph, const std::vector<Point>& points,
                                 const std::vector<bool>& held, const DeformOptions& options = {},
                                 const RelationOptions& tolerances = {}, const std::string& graph_name = "graph");

/// Throws as deform does where it could not make sense of a relationship that is a constraint.
void check_constraint(AnnotatedMeshView object, const Relationship& relationship, const std::string& where);

}  // namespace ostraka
