// Translates relationships of each type of constraint to statements.
#pragma once

#include "semantic/constraint_members.h"

#include "ostraka/axis/axis.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/rigid_fit.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka::semantic {

/// Verdict that follows from deviations and their tolerances.
Measured verdict_of(std::vector<Deviation> deviations);

// Functions that translate relationships to statements, for one or several types each: shapes.cpp, axis_constraints.cpp,
// measures.cpp, places.cpp, parts_kept.cpp, low_level.cpp.
Statement keep_shape(const MembersPtr&, const spec::KeepShape&, const RelationOptions&);
Statement same_level(const MembersPtr&, const spec::SameLevel&, const RelationOptions&);
Statement co_axiality(const MembersPtr&, const spec::None&, const RelationOptions&);
Statement axis_angle(const MembersPtr&, const spec::None&, const RelationOptions&);
Statement structural_continuity(const MembersPtr&, const spec::StructuralContinuity&, const RelationOptions&);
Statement proportion(const MembersPtr&, const spec::Proportion&, const RelationOptions&);
Statement keep_measure(const MembersPtr&, const spec::KeepMeasure&, const RelationOptions&);
Statement same_measure(const MembersPtr&, const spec::SameMeasure&, const RelationOptions&);
Statement co_planarity(const MembersPtr&, const spec::None&, const RelationOptions&);
Statement co_linearity(const MembersPtr&, const spec::None&, const RelationOptions&);
Statement mirror_symmetry(const MembersPtr&, const spec::MirrorSymmetry&, const RelationOptions&);
Statement adjacency(const MembersPtr&, const spec::None&, const RelationOptions&);
Statement selections_kept(const MembersPtr&, const spec::None&, const RelationOptions&);
Statement support(const MembersPtr&, const spec::Upward&, const RelationOptions&);
Statement contact(const MembersPtr&, const spec::Upward&, const RelationOptions&);
Statement part_similarity(const MembersPtr&, const spec::Alike&, const RelationOptions&);
Statement same_length(const MembersPtr&, const spec::Alike&, const RelationOptions&);
Statement keep_direction(const MembersPtr&, const spec::KeepDirection&, const RelationOptions&);
Statement keep_position(const MembersPtr&, const spec::KeepPosition&, const RelationOptions&);
/// Whether the type has the name of one of the solver's kinds of constraint ("edge strain").
bool is_low_level(const std::string& type);
/// Exponent of the unit of length in the absolute range of a constraint of the solver; 0 for types without such a range.
int length_power(const std::string& type);
/// Statement of a constraint of one of the solver's kinds; reads the parameters, including parameters that the kind does not use.
Statement low_level(const MembersPtr&, const ParameterReader&, const RelationOptions&);

/// The rigid motion that maps the current positions of the vertices best onto their positions at rest.
Motion motion_back(const ConstraintMembers& members, const std::vector<Index>& vertices, const State& now);
/// The axis of a member as measured on the current shape, transformed to the member at rest by the best rigid motion, so that a
/// constraint that transforms the axis forward reproduces the measured axis. Returns `rest`, the axis at rest, if the current
/// shape has no axis.
Axis axis_carried_back(const ConstraintMembers& members, std::size_t i, const Axis& rest, const State& now);
/// Constraints that keep the surface around each vertex as in `shape`, scaled by `grown`, up to a rotation.
Statement::Constraints keep_vertex_stars(const ConstraintMembers& members, const std::vector<Index>& vertices,
                                         const Points& shape, double grown = 1);
/// Lets the first `count` members rotate: their surface is kept by `keep_vertex_stars`, since Laplacian displacements, which do
/// not rotate, would shear parts that rotate far.
void allow_rotation(const MembersPtr& members, std::size_t count, Statement& statement);
/// Sets the verdict to unknown for an angle within its tolerance if the axis of a part is less certain than the tolerance: the
/// axis of its slices and the longest principal axis of its area differ by more, for a part at least twice as long as wide.
void doubt_axes(const ConstraintMembers& members, const State& deformed, double tolerance, Measured& measured);

/// A measurement of the relationship `stated` by RelationMeter, as for relationships that are no constraints.
std::function<Measured(const State&)> as_related(const MembersPtr& members, Relationship stated,
                                                 const RelationOptions& tolerances);
/// The mean of the vertices' positions.
Vector3d mean_of(const std::vector<Index>& vertices, const Points& points);
/// The unit normal of the plane fitted to the vertices.
Vector3d normal_of(const Points& points, const std::vector<Index>& vertices);
/// Tolerance of distances in the mesh's unit.
double length_tolerance(const ConstraintMembers& members, const RelationOptions& tolerances);

}  // namespace ostraka::semantic
