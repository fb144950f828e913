// The interpretation of a relationship that is a constraint: low-level constraints on points, and a measurement of how well it
// holds.
#pragma once

#include "semantic/reattachment.h"

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/relation/check.h"
#include "ostraka/semantic/deform.h"
#include "ostraka/semantic/edit.h"
#include "ostraka/solver/constraint.h"

#include <algorithm>

namespace ostraka::semantic {

/// The shape on which constraints are stated. `rest`: the mesh's points before the edit, one per column.
struct Shape : AnnotatedMeshView {
    const Points& rest;
    /// There is no rest state: the mesh is judged by the explicit parameters of the constraint only.
    bool alone = false;
};

/// The shape with other points.
struct State {
    explicit State(const Mesh& deformed) : mesh(deformed), points(columns_of(deformed)) {}
    const Mesh& mesh;
    Points points;
    std::vector<bool> asked = {};  ///< for an edited shape: vertices that the edit moves; empty: not given
    bool is_under_way = false;     ///< for an edited shape: handles are still being dragged
};

struct Measured {
    Verdict verdict = Verdict::unknown;
    std::vector<Deviation> deviations;
    std::string text;
};

/// True if all measured deviations are within their tolerances, even if the verdict is unknown.
inline bool is_within(const Measured& measured) {
    return measured.verdict == Verdict::holds ||
           (measured.verdict == Verdict::unknown && !measured.deviations.empty() &&
            std::all_of(measured.deviations.begin(), measured.deviations.end(),
                        [](const Deviation& one) { return one.value && one.tolerance && *one.value <= *one.tolerance; }));
}

/// A part, a measure of it, and the required range of the measure.
struct Sized {
    std::vector<Index> vertices;  ///< vertices of the part, sorted
    std::vector<Index> anchors;   ///< vertices of the part that stay fixed
    Eigen::Vector3d axis;         ///< direction of the measure, a unit vector
    Eigen::Matrix3d along;        ///< projection onto the stretched subspace: the axis, or all of space if the part is scaled
    bool extent = false;          ///< the measure is the extent of the vertices along the axis, and its range is constant
    std::function<double(const State& deformed)> value;
    std::function<std::pair<double, double>(const State& deformed)> range;
    /// For a part that follows the one led by the edit: the range it must have; nothing if there is no leader. May be empty.
    std::function<std::optional<std::pair<double, double>>(const State& edited)> led = {};
};

struct Statement {
    using Constraints = std::vector<std::unique_ptr<Constraint>>;
    /// Creates low-level constraints; shapes are those of the edited state, parts used as references are in the state `now`.
    /// Empty if there is nothing to solve.
    using Lowering = std::function<Constraints(const State& edited, const State& now)>;
    Lowering lower;
    Lowering support;  ///< helps the surface to follow; never hard; may be empty
    std::function<Measured(const State& deformed)> measure;
    /// Moves the part to its expected position in the initial state of the solve, so that it is not dragged there through
    /// itself. May be empty.
    std::function<void(const State& now, Points& start)> prepare;
    std::vector<Index> rotating;  ///< vertices whose surface is preserved by `support` alone, since it has to rotate
    std::vector<Index> anchors;   ///< vertices that stay where the edit leaves them
    /// Vertices of the reference part: they stay where the edit leaves them unless another constraint moves them.
    std::vector<Index> referred;
    std::vector<Sized> sized;                  ///< measures of parts to be enforced; hard ones by adjusting factors (see Sizes)
    std::optional<Reattachment> reattachment;  ///< features that are reattached to the deformed base
    bool follows = false;                      ///< `lower` must be called again after the shape has moved
    bool until_it_holds = false;               ///< follows only until it holds
    bool left_alone = false;                   ///< not solved for as long as the edit and other constraints leave it satisfied
    bool resizes = false;                      ///< it concerns the size of its members
    bool hard = false;
    /// The angle (radians) between the axis of an annotation and a direction, or the axis of another annotation.
    struct Direction {
        int annotation = 0;
        Eigen::Vector3d direction;
        double angle = 0;
        std::optional<int> reference = {};  ///< annotation of the other axis; `direction` is then its direction at rest
    };
    std::vector<Direction> directions;  ///< explicitly required directions of parts
    std::string unknown;                ///< reason why the constraint is ignored, if it is
    std::string keeps;  ///< what it preserves of the shape at rest, which cannot be judged on a shape alone; empty: nothing
};

/// A list of one constraint.
inline Statement::Constraints only(std::unique_ptr<Constraint> constraint) {
    Statement::Constraints list;
    list.push_back(std::move(constraint));
    return list;
}

/// The ids of a vertex and its neighbours; `first` is the id of the mesh's first vertex.
std::vector<int> star_of(const Mesh& mesh, Vertex vertex, int first = 0);

/// Interprets a relationship and validates it on the shape at rest. Throws Error (input) that names it if it is invalid.
Statement understand(const Shape& shape, const Relationship& relationship, const RelationOptions& tolerances,
                     const std::string& where);

/// The reason why no shape satisfies both, as far as the directions of parts show; empty if there is none.
std::string contradiction(const Statement& one, const Statement& other);

/// The report of an interpreted constraint before measuring: its description, and whether it is used.
ConstraintReport report_of(const Relationship& relationship, const Statement& statement);

}  // namespace ostraka::semantic
