// Deformation that preserves the semantics given by annotations and relations (thesis, chapters 4 and 5; doc/deformation.md).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/relation/check.h"
#include "ostraka/semantic/edit.h"
#include "ostraka/solver/hard.h"

namespace ostraka {

struct DeformOptions {
    /// Unknowns of the solve: mesh or cage vertices. Automatic: ornaments are seated and all other constraints are solved over
    /// the mesh; if the result is not acceptable, the solve is repeated over the mesh without seating; if that result is not
    /// acceptable either, over the cage. If no result is acceptable, the best result is used.
    enum class Space { mesh, cage, automatic } space = Space::mesh;
    /// Shape whose Laplacians are preserved. edited: the shape after the edit; rest: the undeformed shape.
    enum class Details { edited, rest } details = Details::edited;
    /// Changes decrease to zero over this length, a share of the mesh's diagonal; at least three edges. The weight of each
    /// vertex's edited position is laplacian (edge / length)^4, where edge is the mean edge length, so that the result does not
    /// depend on the resolution.
    double spread = 0.1;
    double laplacian = 2;  ///< weight of the Laplacian displacement of each vertex
    /// Weight of the positions of the handles that the edit moves, and of the joints of stretched parts. Handles that a
    /// constraint moves too have a lower weight, which corresponds to a third of the spread.
    double handles = 100;
    double followed = 0.9;  ///< min value of EditFollowed::share in an acceptable result, 0 to 1
    /// Max distortion, in an acceptable result, of a part whose shape should not change; a share of the mesh's diagonal.
    double distortion = 0.005;
    SolveOptions solve;  ///< options of the solver
    int rounds = 100;    ///< max number of rounds in which hard constraints are enforced
    int passes = 5;      ///< max number of passes; each pass updates constraints that refer to axes and measures of other parts
    /// If a constraint is violated, conflicts are found by omitting other constraints, one at a time; max number of omitted
    /// constraints. 0: conflicts are not searched.
    int conflicts = 8;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Tolerances for the result of a deformation, which are tighter than the tolerances for relations of scans, since deviations of
/// edited shapes, such as a wobbling chair, are visible.
inline RelationOptions deform_tolerances() {
    RelationOptions tolerances;
    tolerances.distance = 0.002;
    tolerances.angle = 1;
    return tolerances;
}

/// Outcome of one constraint of a deformation.
struct ConstraintReport {
    int id = 0;                    ///< id of the relationship
    std::vector<int> annotations;  ///< ids of the constrained annotations
    std::string type, text;        ///< type of the constraint; message why the constraint is left out or how it is violated
    bool used = false;             ///< true: the constraint was part of the solve
    bool hard = false;             ///< true: the constraint has to be satisfied exactly (hard constraint)
    double weight = 1;             ///< weight of a soft constraint
    /// Whether the constraint holds on the edited shape, and after solving.
    Verdict before = Verdict::unknown, verdict = Verdict::unknown;
    std::vector<Deviation> deviations;  ///< deviations after solving, each with unit and tolerance
    std::vector<double> before_values;  ///< values of the same quantities on the edited shape
    /// Normalised residuals of the constraint's low-level constraints, in the mesh's unit (section 4.2.3 with its erratum).
    double mean = 0, median = 0, minimum = 0, maximum = 0;
    std::size_t low_level = 0;  ///< number of low-level constraints
    double distance = 0;        ///< max distance of a row of the low-level constraints from its projection, in the mesh's unit
    /// Term of the constraint in the solver's objective, on the edited shape (cost_before) and after solving (cost): weight
    /// times the sum of squared distances of the rows from their projections. 0 for a constraint that is hard or not part of
    /// the solve.
    double cost_before = 0, cost = 0;
};

/// A conflict: failing constraints that hold in the solution without another constraint.
struct ConstraintConflict {
    int id = 0;                         ///< id of the omitted constraint
    std::vector<int> freed;             ///< ids of the constraints that are satisfied if the constraint `id` is omitted
    std::vector<Deviation> deviations;  ///< deviations of the omitted constraint in the solution without it
};

/// Measures how closely a result follows the edit, over the vertices that the edit moves. Without a cage the edit moves the
/// handles; with a cage it moves the vertices of the parts that the edit names or, if the edit names cage vertices, the mesh
/// vertices that it moves by at least half of the maximum displacement.
struct EditFollowed {
    std::size_t vertices = 0;  ///< number of vertices that the edit moves
    double share = 1;          ///< 1 - (root mean square deviation) / (root mean square displacement by the edit); not below 0
    double mean = 0, largest = 0;  ///< mean and largest deviation of a vertex from its edited position, in the mesh's unit
    /// A part that moved although the edit does not name most of its vertices. Displacements are those of the vertices that the
    /// edit does not name (if the edit selects cage vertices: relative to the edited positions), as a share of the mesh's
    /// diagonal.
    struct Moved {
        int annotation = 0;  ///< id of the annotation
        std::string tag;     ///< tag of the annotation
        double share = 0;    ///< mean displacement
        double largest = 0;  ///< max displacement of a vertex
    };
    /// Parts that moved by more than 0.1 % of the diagonal in the mean, or by more than 0.5 % at one vertex, in descending order.
    std::vector<Moved> others;
};

/// A part whose shape changed, although neither the edit nor a violated constraint should change its shape.
struct DistortedPart {
    int annotation = 0;  ///< id of the annotation
    std::string tag;     ///< tag of the annotation
    /// Distance of the part's vertices from the edited part moved by the best-fitting rigid motion: root mean square and
    /// maximum, in the mesh's unit.
    double distance = 0, largest = 0;
    bool distorted = false;  ///< true: `distance` exceeds the permitted distortion
    bool thinned = false;    ///< true: `thin` exceeds the permitted share
    /// Share of the part's area that is less than half as thick as at rest and less than half as thick as after the edit alone.
    double thin = 0;
};

/// Defects of the deformed surface, compared with the surface at rest and after the edit.
struct SurfaceChange {
    /// Number of pairs of faces that cross each other, after solving and at rest.
    std::size_t crossings = 0, crossings_before = 0;
    std::size_t crossings_new = 0;  ///< number of pairs of faces that cross after solving and did not cross at rest
    /// Number of edges whose face normals differ by more than 150 degrees, and by at least 30 degrees more than at rest.
    std::size_t folds = 0;
    /// Number of edges at which solving increased the angle between the face normals by more than 60 degrees, to more than 90
    /// degrees.
    std::size_t kinks = 0;
};

/// Result of a deformation.
struct DeformResult {
    std::vector<Point> points;                  ///< positions of the mesh's vertices
    std::vector<Point> edited;                  ///< positions of the mesh's vertices after the edit alone
    EditFollowed followed;                      ///< how closely the result follows the edit
    SurfaceChange surface;                      ///< defects of the deformed surface
    std::vector<DistortedPart> distorted;       ///< distorted parts, the most distorted first
    std::vector<Point> cage;                    ///< positions of the cage's vertices after solving; empty without a cage
    std::vector<ConstraintReport> constraints;  ///< outcome of each constraint
    SolveSummary summary;                       ///< summary of the solve; with hard constraints in mesh space, of the last round
    int rounds = 0;                             ///< number of rounds in which hard constraints were enforced
    bool solved = false;                        ///< true: there were constraints to solve
    DeformOptions::Space space = DeformOptions::Space::mesh;  ///< unknowns of the solve: mesh or cage vertices
    std::vector<int> seated;  ///< ids of the constraints whose parts were seated by the space `automatic`
    /// True if every constraint holds, the edit is followed, and there are no new crossings or folds of faces compared with the
    /// shape at rest (for `restore_constraints`: true if every constraint holds).
    bool acceptable = true;
    std::vector<std::string> objections;        ///< why the result is not acceptable
    int passes = 0;                             ///< number of passes until the reference parts of constraints no longer moved
    std::vector<ConstraintConflict> conflicts;  ///< constraints that contradict each other
    std::vector<std::size_t> selected;          ///< for each step of the edit, number of handles that the step selected
    /// Number of constraints that the search for conflicts did not try to omit, because of the limit `conflicts`.
    std::size_t untried = 0;
};

/// Deforms a mesh: applies the edit and solves for the constraints of the graph (relationships that are constraints). With a cage
/// the edit moves vertices of the cage, and the mesh is deformed by the cage coordinates; without a cage it moves vertices of
/// the mesh, and the surrounding vertices follow (shape_of_edit). Then constraints are solved over the vertices of the mesh or
/// of the cage (options.space). `edit_name` and `graph_name` are used in errors. Throws the errors of follow_edit; Error
/// (input) for invalid constraints: a missing annotation, attribute or measure, an inverted range, an empty region, a part
/// without an axis; (usage) for cage space without a cage.
DeformResult deform(const HandleSpace& space, const RelationGraph& graph, const Edit& edit, const std::string& edit_name,
                    const DeformOptions& options = {}, const RelationOptions& tolerances = {},
                    const std::string& graph_name = "graph");

/// Positions of the mesh's vertices after a step of an edit alone. With a cage, they follow from the coordinates of the mesh in
/// the cage. Without a cage, the handles are at their new positions, and the other vertices have the smoothest displacement
/// that decreases to zero over the spread.
std::vector<Point> shape_of_edit(const HandleSpace& space, const EditState& state, const DeformOptions& options = {});

/// Solves for the constraints of the graph starting from given vertex positions (of a fit, for example) instead of an edit:
/// vertices marked in `held` count as handles that were moved, the other vertices are attracted to their positions in `points`.
/// `object` is the shape at rest, to which the constraints refer. Throws Error (usage) if the numbers of positions, flags and
/// vertices differ, and for cage space; (input) as deform.
DeformResult restore_constraints(AnnotatedMeshView object, const RelationGraph& graph, const std::vector<Point>& points,
                                 const std::vector<bool>& held, const DeformOptions& options = {},
                                 const RelationOptions& tolerances = {}, const std::string& graph_name = "graph");

/// Validates a relationship that is a constraint; throws the same errors as deform if it is invalid. `where` names the file in
/// errors.
void check_constraint(AnnotatedMeshView object, const Relationship& relationship, const std::string& where);

}  // namespace ostraka
