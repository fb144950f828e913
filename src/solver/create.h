// Declarations shared by the sources of constraint kinds.
#pragma once

#include "ostraka/algebra/dense.h"
#include "ostraka/solver/make_constraint.h"

namespace ostraka::solver {

using kinds::Interval;

/// Arguments from which a constraint of any kind is created. `rest` holds the rest positions of the constraint's own points, in
/// the order of `ids`.
struct ConstraintArguments {
    std::string_view kind;  ///< name of the kind
    std::vector<int> ids;   ///< indices of the constrained points in the shape
    double weight;          ///< weight of the constraint
    Points rest;            ///< rest positions of the constrained points, in the order of `ids`

    /// Throws Error (usage) that names the kind, with the problem and the remedy.
    [[noreturn]] void fail(const std::string& what, const std::string& remedy = {}) const;
    /// A direction as a unit vector; throws Error (usage) if the direction is not finite or has no length.
    Eigen::Vector3d unit(const Eigen::Vector3d& direction, const char* name = "direction") const;
    /// The point; throws Error (usage) if the point is not finite.
    [[nodiscard]] Eigen::Vector3d finite(const Eigen::Vector3d& point, const char* name = "point") const;
    /// The range; throws Error (usage) unless 0 <= min <= max.
    [[nodiscard]] Interval checked(const Interval& range) const;
    /// The range, multiplied by the measure at rest unless `absolute`.
    [[nodiscard]] Interval range_of(const Interval& range, bool absolute, double rest_measure) const;
    /// The given points, or the rest positions if empty; throws Error (usage) if the number of columns differs from the number of
    /// ids.
    [[nodiscard]] Points given_or_rest(const std::optional<Points>& points) const;
};

using ConstraintPtr = std::unique_ptr<Constraint>;

// fits.cpp
ConstraintPtr create(const kinds::Closeness&, const ConstraintArguments&);
ConstraintPtr create(const kinds::OnSurface&, const ConstraintArguments&);
ConstraintPtr create(const kinds::Line&, const ConstraintArguments&);
ConstraintPtr create(const kinds::Plane&, const ConstraintArguments&);
ConstraintPtr create(const kinds::Orientation&, const ConstraintArguments&);
// radial_constraints.cpp
ConstraintPtr create(const kinds::Circle&, const ConstraintArguments&);
ConstraintPtr create(const kinds::Sphere&, const ConstraintArguments&);
// strain.cpp
ConstraintPtr create(const kinds::EdgeStrain&, const ConstraintArguments&);
ConstraintPtr create(const kinds::TriangleStrain&, const ConstraintArguments&);
ConstraintPtr create(const kinds::TetrahedronStrain&, const ConstraintArguments&);
ConstraintPtr create(const kinds::Area&, const ConstraintArguments&);
ConstraintPtr create(const kinds::Volume&, const ConstraintArguments&);
// laplacian.cpp
ConstraintPtr create(const kinds::Laplacian&, const ConstraintArguments&);
ConstraintPtr create(const kinds::LaplacianDisplacement&, const ConstraintArguments&);
ConstraintPtr create(const kinds::CotangentLaplacian&, const ConstraintArguments&);
ConstraintPtr create(const kinds::CotangentLaplacianDisplacement&, const ConstraintArguments&);
ConstraintPtr create(const kinds::Bending&, const ConstraintArguments&);
// shape_groups.cpp
ConstraintPtr create(const kinds::Rigid&, const ConstraintArguments&);
ConstraintPtr create(const kinds::Similarity&, const ConstraintArguments&);
ConstraintPtr create(const kinds::Equilateral&, const ConstraintArguments&);
ConstraintPtr create(const kinds::NonUniformScaling&, const ConstraintArguments&);
ConstraintPtr create(const kinds::Parallelogram&, const ConstraintArguments&);
ConstraintPtr create(const kinds::Rectangle&, const ConstraintArguments&);
// orientations.cpp
ConstraintPtr create(const kinds::FittedPlaneOrientation&, const ConstraintArguments&);
ConstraintPtr create(const kinds::CoAxiality&, const ConstraintArguments&);
ConstraintPtr create(const kinds::AxisDirection&, const ConstraintArguments&);
// levels_and_symmetry.cpp
ConstraintPtr create(const kinds::AxisOnLine&, const ConstraintArguments&);
ConstraintPtr create(const kinds::MeansOnLevel&, const ConstraintArguments&);
ConstraintPtr create(const kinds::MeanPosition&, const ConstraintArguments&);
ConstraintPtr create(const kinds::MirrorSymmetry&, const ConstraintArguments&);
ConstraintPtr create(const kinds::MirrorInTriangles&, const ConstraintArguments&);
ConstraintPtr create(const kinds::Proportion&, const ConstraintArguments&);
// edges.cpp
ConstraintPtr create(const kinds::Angle&, const ConstraintArguments&);
ConstraintPtr create(const kinds::Perpendicular&, const ConstraintArguments&);
ConstraintPtr create(const kinds::Parallel&, const ConstraintArguments&);
ConstraintPtr create(const kinds::PolylineLength&, const ConstraintArguments&);
ConstraintPtr create(const kinds::EqualLengths&, const ConstraintArguments&);
ConstraintPtr create(const kinds::EqualLength&, const ConstraintArguments&);

/// Sum of a_i b_i^T over the columns, in their order.
Eigen::Matrix3d outer_sum(const RowsIn& a, const RowsIn& b);

/// The proper rotation R that maximises tr(R^T M); for M = sum of r_i q_i^T the points R q_i are closest to r_i.
Eigen::Matrix3d best_rotation(const Eigen::Matrix3d& m);

/// Unit eigenvectors of a symmetric matrix, in ascending order of eigenvalues.
SymmetricEigen3 principal(const Eigen::Matrix3d& symmetric);

/// An arbitrary unit vector perpendicular to the unit vector `unit`.
Eigen::Vector3d any_perpendicular(const Eigen::Vector3d& unit);

/// A constraint whose projection is determined by the moments of its rows. Rows: the centred points.
class MomentConstraint : public Constraint {
public:
    explicit MomentConstraint(const ConstraintArguments& a) : Constraint(a.kind, a.ids, a.weight) {
        map_.direct = map_.rows = static_cast<Eigen::Index>(ids().size());
        map_.centred = true;
    }
    [[nodiscard]] bool by_moments() const final { return true; }
    void project(const RowsIn& rows, RowsOut projected) const final;
};

}  // namespace ostraka::solver
