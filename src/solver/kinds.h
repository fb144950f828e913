// Declarations shared by the sources of constraint kinds.
#pragma once

#include "ostraka/core/dense.h"
#include "ostraka/solver/constraint.h"

namespace ostraka::solver {

/// Arguments from which a constraint is created. `rest` holds the constraint's own points in the order of ids.
struct Making {
    std::string_view kind;
    std::vector<int> ids;
    double weight;
    const ConstraintParameters& parameters;
    Points rest;

    [[noreturn]] void fail(const std::string& what, const std::string& remedy = {}) const;
    /// The direction as a unit vector; fails if it is missing or has zero length.
    [[nodiscard]] Eigen::Vector3d direction() const;
    [[nodiscard]] Eigen::Vector3d point() const;
    struct Interval {
        double min, max;
        [[nodiscard]] double clamp(double value) const { return value < min ? min : (value > max ? max : value); }
    };
    /// The range of the parameters, at least `minimum`. range_of: multiplied by `rest_measure` unless absolute.
    [[nodiscard]] Interval range(double default_min, double default_max, double minimum = 0) const;
    [[nodiscard]] Interval range_of(double rest_measure) const;
    /// The target's points if given, otherwise the rest points; the number of columns must be the same.
    [[nodiscard]] Points target_or(const Points& rest_rows) const;
};

using Maker = std::unique_ptr<Constraint> (*)(Making&&);

// fits.cpp
std::unique_ptr<Constraint> make_closeness(Making&&);
std::unique_ptr<Constraint> make_on_surface(Making&&);
std::unique_ptr<Constraint> make_line(Making&&);
std::unique_ptr<Constraint> make_plane(Making&&);
std::unique_ptr<Constraint> make_orientation(Making&&);
// radial_constraints.cpp
std::unique_ptr<Constraint> make_circle(Making&&);
std::unique_ptr<Constraint> make_sphere(Making&&);
// strain.cpp
std::unique_ptr<Constraint> make_edge_strain(Making&&);
std::unique_ptr<Constraint> make_triangle_strain(Making&&);
std::unique_ptr<Constraint> make_tetrahedron_strain(Making&&);
std::unique_ptr<Constraint> make_area(Making&&);
std::unique_ptr<Constraint> make_volume(Making&&);
// laplacian.cpp
std::unique_ptr<Constraint> make_laplacian(Making&&);
std::unique_ptr<Constraint> make_laplacian_displacement(Making&&);
std::unique_ptr<Constraint> make_cotangent_laplacian(Making&&);
std::unique_ptr<Constraint> make_cotangent_laplacian_displacement(Making&&);
std::unique_ptr<Constraint> make_bending(Making&&);
// shape_groups.cpp
std::unique_ptr<Constraint> make_rigid(Making&&);
std::unique_ptr<Constraint> make_similarity(Making&&);
std::unique_ptr<Constraint> make_equilateral(Making&&);
std::unique_ptr<Constraint> make_non_uniform_scaling(Making&&);
std::unique_ptr<Constraint> make_parallelogram(Making&&);
std::unique_ptr<Constraint> make_rectangle(Making&&);
// orientations.cpp
std::unique_ptr<Constraint> make_fitted_plane_orientation(Making&&);
std::unique_ptr<Constraint> make_co_axiality(Making&&);
std::unique_ptr<Constraint> make_axis_direction(Making&&);
// levels_and_symmetry.cpp
std::unique_ptr<Constraint> make_axis_on_line(Making&&);
std::unique_ptr<Constraint> make_means_on_level(Making&&);
std::unique_ptr<Constraint> make_mean_position(Making&&);
std::unique_ptr<Constraint> make_mirror_symmetry(Making&&);
std::unique_ptr<Constraint> make_proportion(Making&&);
// edges.cpp
std::unique_ptr<Constraint> make_angle(Making&&);
std::unique_ptr<Constraint> make_perpendicular(Making&&);
std::unique_ptr<Constraint> make_parallel(Making&&);
std::unique_ptr<Constraint> make_polyline_length(Making&&);
std::unique_ptr<Constraint> make_equal_lengths(Making&&);
std::unique_ptr<Constraint> make_equal_length(Making&&);

/// Sum of a_i b_i^T in the order of the columns.
Eigen::Matrix3d outer_sum(const RowsIn& a, const RowsIn& b);

/// The proper rotation R that maximises tr(R^T M): R q_i is closest to r_i for M = sum of r_i q_i^T.
Eigen::Matrix3d best_rotation(const Eigen::Matrix3d& m);

/// Unit eigenvectors of a symmetric matrix, in ascending order of eigenvalues.
SymmetricEigen3 principal(const Eigen::Matrix3d& symmetric);

/// An arbitrary unit vector perpendicular to a unit vector.
Eigen::Vector3d any_perpendicular(const Eigen::Vector3d& unit);

/// A constraint whose projection is determined by moments. Rows: the centred points.
class MomentConstraint : public Constraint {
public:
    explicit MomentConstraint(const Making& m) : Constraint(m.kind, m.ids, m.weight) {
        map_.direct = map_.rows = static_cast<Eigen::Index>(ids().size());
        map_.centred = true;
    }
    [[nodiscard]] bool by_moments() const final { return true; }
    void project(const RowsIn& rows, RowsOut projected) const final;
};

}  // namespace ostraka::solver
