// The interpretation of a relationship that is a constraint: low-level constraints on points, and a measurement of how well the
// relationship holds.
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

/// The shape on which constraints are stated. `rest`: positions of the mesh's vertices before the edit, one per column.
struct Shape : AnnotatedMeshView {
    const Points& rest;
    /// True: there is no rest state, and the mesh is judged by the explicit parameters of the constraint only.
    bool alone = false;
};

/// A shape with other vertex positions: edited or deformed.
struct State {
    explicit State(const Mesh& deformed) : mesh(deformed), points(columns_of(deformed)) {}
    const Mesh& mesh;
    Points points;
    std::vector<bool> asked = {};  ///< for an edited shape: for each vertex, whether the edit moves it; empty: not known
    bool is_dragging = false;      ///< for an edited shape: true while handles are being dragged
};

/// How well a relationship holds on a shape.
struct Measured {
    Verdict verdict = Verdict::unknown;  ///< whether the relationship holds
    std::vector<Deviation> deviations;   ///< measured deviations
    std::string text;                    ///< explanation of the verdict
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
    std::vector<Index> vertices;  ///< indices of the part's vertices, sorted
    std::vector<Index> anchors;   ///< indices of the part's vertices that stay fixed
    Eigen::Vector3d axis;         ///< direction of the measure, a unit vector
    Eigen::Matrix3d along;        ///< projection onto the stretched subspace: the axis, or all of space if the part is scaled
    bool extent = false;          ///< true: the measure is the extent of the vertices along the axis, and its range is constant
    std::function<double(const State& deformed)> value;                     ///< value of the measure
    std::function<std::pair<double, double>(const State& deformed)> range;  ///< required range of the measure
    /// For a part that follows a part led by the edit: its required range; the function may be empty, and returns nothing if
    /// there is no leader.
    std::function<std::optional<std::pair<double, double>>(const State& edited)> led = {};
};

/// What a relationship that is a constraint means for a solve.
struct Statement {
    using Constraints = std::vector<std::unique_ptr<Constraint>>;
    /// Creates low-level constraints: target shapes are taken from the state `edited`, parts that serve as references from the
    /// state `now`. Empty if there is nothing to solve.
    using Lowering = std::function<Constraints(const State& edited, const State& now)>;
    Lowering lower;    ///< creates the low-level constraints
    Lowering support;  ///< creates constraints that help the surface to follow, which are never hard; may be empty
    std::function<Measured(const State& deformed)> measure;  ///< measures how well the relationship holds
    /// Moves the part to its expected position in the initial state of the solve, so that the part is not dragged to that
    /// position through itself. May be empty.
    std::function<void(const State& now, Points& start)> prepare;
    std::vector<Index> rotating;  ///< indices of vertices whose surface is preserved by `support` alone, since it has to rotate
    std::vector<Index> anchors;   ///< indices of vertices that stay where the edit leaves them
    /// Indices of the vertices of the reference part, which stay where the edit leaves them unless another constraint moves them.
    std::vector<Index> referred;
    std::vector<Sized> sized;  ///< measures of parts to be enforced; for hard constraints by adjusting factors (see Sizes)
    std::optional<Reattachment> reattachment;  ///< features that are reattached to the deformed base
    bool follows = false;                      ///< true: `lower` must be called again after the shape has moved
    bool until_it_holds = false;               ///< true: `lower` is called again only until the constraint holds
    /// True: not part of the solve as long as the edit and other constraints leave the constraint satisfied.
    bool left_alone = false;
    bool resizes = false;  ///< true: the constraint concerns the size of its members
    bool hard = false;     ///< true: the constraint has to hold exactly
    /// A required angle (radians) between the axis of an annotation and a direction, or the axis of another annotation.
    struct Direction {
        int annotation = 0;         ///< id of the annotation
        Eigen::Vector3d direction;  ///< required direction, a unit vector
        double angle = 0;           ///< required angle, radians
        /// Id of the annotation whose axis is the reference; `direction` is then this axis at rest.
        std::optional<int> reference = {};
    };
    std::vector<Direction> directions;  ///< explicitly required directions of parts
    std::string unknown;                ///< why the constraint is ignored; empty if it is used
    /// Property of the shape at rest that the constraint preserves, which cannot be judged on a shape alone; empty: none.
    std::string keeps;
};

/// A list of one low-level constraint.
inline Statement::Constraints only(std::unique_ptr<Constraint> constraint) {
    Statement::Constraints list;
    list.push_back(std::move(constraint));
    return list;
}

/// The ids of a vertex, first, and of its neighbours; `first` is the id of the mesh's first vertex.
std::vector<int> vertex_star(const Mesh& mesh, Vertex vertex, int first = 0);

/// Interprets a relationship and validates it on the shape at rest; `where` names the file in errors. Throws Error (input) that
/// names the relationship if it is invalid.
Statement understand(const Shape& shape, const Relationship& relationship, const RelationOptions& tolerances,
                     const std::string& where);

/// The reason why no shape satisfies both statements, as far as the required directions of parts show; empty: no contradiction.
std::string contradiction(const Statement& one, const Statement& other);

/// The report of an interpreted constraint before measuring: its description, and whether it is part of the solve.
ConstraintReport report_of(const Relationship& relationship, const Statement& statement);

}  // namespace ostraka::semantic
