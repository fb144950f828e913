// A relationship that is a constraint, understood: constraints on points, and how well it holds in its own unit.
#pragma once

#include "reattachment.h"

#include "ostraka/geom/eigen.h"
#include "ostraka/relation/check.h"
#include "ostraka/semantic/deform.h"
#include "ostraka/semantic/edit.h"
#include "ostraka/solver/constraint.h"

#include <algorithm>

namespace ostraka::semantic {

/// What constraints are stated on. `rest` are the mesh's points before the edit, a column each.
struct Shape {
    const Mesh& mesh;
    const AnnotationSet& set;
    const Points& rest;
    /// There is no other state: the mesh is to be judged as it is, by what a constraint says outright.
    bool alone = false;
};

/// The shape with other points.
struct State {
    explicit State(const Mesh& deformed) : mesh(deformed), points(columns_of(deformed)) {}
    const Mesh& mesh;
    Points points;
    std::vector<bool> asked = {};  ///< of an edited shape: vertices that the edit asked to move; empty: any
    bool is_under_way = false;     ///< of an edited shape: handles are being dragged, it is not yet what they ask for
};

struct Measured {
    Verdict verdict = Verdict::unknown;
    std::vector<Deviation> deviations;
    std::string text;
};

/// Whether all that was measured is within its tolerance, be it certain or not.
inline bool is_within(const Measured& measured) {
    return measured.verdict == Verdict::holds ||
           (measured.verdict == Verdict::unknown && !measured.deviations.empty() &&
            std::all_of(measured.deviations.begin(), measured.deviations.end(),
                        [](const Deviation& one) { return one.value && one.tolerance && *one.value <= *one.tolerance; }));
}

/// A part, a measure of it, and the range that this is to be in.
struct Sized {
    std::vector<Index> vertices;  ///< of the part, sorted
    std::vector<Index> anchors;   ///< of them, those that stay where they are
    Eigen::Vector3d axis;         ///< of the measure, a unit vector
    Eigen::Matrix3d along;        ///< projects on what is stretched: the axis, or all where the part is scaled
    bool extent = false;          ///< the measure is how far the vertices reach along the axis, and its range does not change
    std::function<double(const State& deformed)> value;
    std::function<std::pair<double, double>(const State& deformed)> range;
    /// Where it follows a part that the edit leads: the range that this one gives it; none where nothing leads. May be empty.
    std::function<std::optional<std::pair<double, double>>(const State& edited)> led = {};
};

struct Statement {
    using Constraints = std::vector<std::unique_ptr<Constraint>>;
    /// Low-level constraints; shapes are those of the edited state, parts that others refer to are as they are `now`. Empty where
    /// there is nothing to solve.
    using Lowering = std::function<Constraints(const State& edited, const State& now)>;
    Lowering lower;
    Lowering support;  ///< what helps the surface to follow; never hard; may be empty
    std::function<Measured(const State& deformed)> measure;
    /// Where to start from: the part where it is to be, so that it need not be pulled there through itself. May be empty.
    std::function<void(const State& now, Points& start)> prepare;
    std::vector<Index> rotating;  ///< vertices whose surface is kept by `support` alone, since it has to turn
    std::vector<Index> anchors;   ///< vertices that are to stay where the edit leaves them
    /// Vertices of the part that is referred to: they stay where the edit leaves them unless another constraint moves them.
    std::vector<Index> referred;
    std::vector<Sized> sized;  ///< what it says as measures of parts; hard ones are enforced by their values (see Sizes)
    std::optional<Reattachment> reattachment;  ///< features that are put back on the deformed base
    bool follows = false;                      ///< lower gives others when the shape has moved
    bool until_it_holds = false;               ///< follows only as long as it does not hold
    bool left_alone = false;                   ///< not solved for as long as it holds where edit and other constraints leave it
    bool resizes = false;                      ///< it is about how large its members are
    bool hard = false;
    /// The axis of an annotation at an angle (radians) with a direction, or with the axis of another.
    struct Direction {
        int annotation = 0;
        Eigen::Vector3d direction;
        double angle = 0;
        std::optional<int> reference = {};  ///< then the direction is that at rest
    };
    std::vector<Direction> directions;  ///< of parts, that it asks for outright
    std::string unknown;                ///< why it is left out, if it is
    std::string keeps;  ///< what it keeps of the shape at rest: nothing says that of a shape alone; empty: nothing
};

/// A list of one constraint.
inline Statement::Constraints only(std::unique_ptr<Constraint> constraint) {
    Statement::Constraints list;
    list.push_back(std::move(constraint));
    return list;
}

/// A vertex and its neighbours, as the ids of points of which the mesh's begin at `first`.
std::vector<int> star_of(const Mesh& mesh, Vertex vertex, int first = 0);

/// Reads a relationship and checks it on the shape at rest. Throws Error (input) naming it where it makes no sense.
Statement understand(const Shape& shape, const Relationship& relationship, const RelationOptions& tolerances,
                     const std::string& where);

/// Why no shape can meet both, as far as the directions of parts tell; empty: it can.
std::string contradiction(const Statement& one, const Statement& other);

/// Of a constraint that was understood, before anything is measured: what it is, and whether it is used.
ConstraintReport report_of(const Relationship& relationship, const Statement& statement);

}  // namespace ostraka::semantic
