// Creates constraints of all kinds.
#pragma once

#include "ostraka/solver/part_kinds.h"

#include <variant>

namespace ostraka {

/// A kind of low-level constraint with its parameters.
using ConstraintKind =
    std::variant<kinds::Closeness, kinds::OnSurface, kinds::Line, kinds::Plane, kinds::Orientation, kinds::Circle, kinds::Sphere,
                 kinds::EdgeStrain, kinds::TriangleStrain, kinds::TetrahedronStrain, kinds::Area, kinds::Volume, kinds::Bending,
                 kinds::Laplacian, kinds::LaplacianDisplacement, kinds::CotangentLaplacian, kinds::CotangentLaplacianDisplacement,
                 kinds::Similarity, kinds::Rigid, kinds::NonUniformScaling, kinds::Equilateral, kinds::Parallelogram,
                 kinds::Rectangle, kinds::Angle, kinds::Perpendicular, kinds::Parallel, kinds::PolylineLength,
                 kinds::EqualLengths, kinds::EqualLength, kinds::FittedPlaneOrientation, kinds::CoAxiality, kinds::AxisDirection,
                 kinds::AxisOnLine, kinds::MeansOnLevel, kinds::MeanPosition, kinds::MirrorSymmetry, kinds::MirrorInTriangles,
                 kinds::Proportion>;

/// The name and the number of points of a kind.
const kinds::KindInfo& info_of(const ConstraintKind& kind);

/// Creates a constraint on the points `ids`. `rest` holds all points of the shape in their rest state. Throws Error (usage) for
/// ids out of range, too few or too many ids, weights that are negative or not finite, min > max, values that are not finite, a
/// direction of zero length, and a degenerate rest state for which the kind is undefined.
std::unique_ptr<Constraint> make_constraint(const ConstraintKind& kind, std::vector<int> ids, double weight, const Points& rest);

}  // namespace ostraka
