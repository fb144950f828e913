// Kinds of constraints on points: positions, fitted shapes, strain, Laplacians, preserved shapes, segments. Each type holds the
// parameters of one kind. part_kinds.h has the kinds for the parts of an object.
//
// A kind is defined by its rows B x and by the set of admissible rows, onto which P projects (constraint.h). Rows are lengths
// in the points' unit. "Centred" rows are the points minus their mean. Where ShapeOp (Deuss et al. 2015) has the kind, its name
// and its order of ids are used.
#pragma once

#include "ostraka/solver/constraint.h"

#include <limits>

namespace ostraka::kinds {

/// The name of a kind, as in files and messages, and the number of points that a constraint of this kind has.
struct KindInfo {
    std::string_view name;           ///< name of the kind
    int min_points, max_points = 0;  ///< min and max number of points; max_points 0: any number
};

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Interval of admissible values. `max` may be infinite.
struct Interval {
    double min, max;  ///< bounds of the interval
    /// The value of the interval nearest to `value`.
    [[nodiscard]] double clamp(double value) const { return value < min ? min : (value > max ? max : value); }
};

// ---- Positions and fitted shapes (ShapeUp, Bouaziz et al. 2012, section 4; the thesis, section 4.2)

/// Points are at given positions: P(r) = targets. Rows: the points.
struct Closeness {
    static constexpr KindInfo kind{"Closeness", 1};  ///< name of the kind, and min number of points
    std::optional<Points> targets = {};              ///< target position of each point; empty: the rest positions
};

/// Points lie on a surface: P(r_i) is the closest point of the surface. Rows: the points.
struct OnSurface {
    static constexpr KindInfo kind{"OnSurface", 1};  ///< name of the kind, and min number of points
    /// Returns the point of the surface closest to a point; must be thread-safe.
    std::function<Eigen::Vector3d(const Eigen::Vector3d&)> closest_point;
};

/// Points lie on a line: P(r) = d d^T r with the first principal axis d of the rows. Rows: the centred points.
struct Line {
    static constexpr KindInfo kind{"Line", 2};  ///< name of the kind, and min number of points
};

/// Points lie on a plane: P(r) = r - n n^T r with the last principal axis n of the rows. Rows: the centred points.
struct Plane {
    static constexpr KindInfo kind{"Plane", 3};  ///< name of the kind, and min number of points
};

/// Points lie on a plane with a given normal n (thesis, section 5.2.1): P(r) = r - n n^T r. Rows: the centred points.
struct Orientation {
    static constexpr KindInfo kind{"Orientation", 2};  ///< name of the kind, and min number of points
    Eigen::Vector3d normal;                            ///< normal of any length
};

/// Points lie on the circle of least squared distance, or on a line, the limit of circles, if the line is closer. The circle is
/// fitted by Levenberg-Marquardt, starting from the algebraic fit (Kasa 1976). Rows: the centred points.
struct Circle {
    static constexpr KindInfo kind{"Circle", 3};  ///< name of the kind, and min number of points
};

/// Points lie on the sphere of least squared distance, or on a plane if the plane is closer. The sphere is fitted as the circle
/// of kind Circle. Rows: the centred points.
struct Sphere {
    static constexpr KindInfo kind{"Sphere", 4};  ///< name of the kind, and min number of points
};

// ---- Strain (ShapeUp; Bouaziz et al. 2014, Projective Dynamics). F: the deformation gradient relative to the rest state in the
// Gram-Schmidt frame of the rest edges 0 1, 0 2 (, 0 3). Ranges are relative to the rest state or, if absolute, in the unit of
// the points.

/// The length of a segment is in a range. Row: x_1 - x_0.
struct EdgeStrain {
    static constexpr KindInfo kind{"EdgeStrain", 2, 2};  ///< name of the kind, min and max number of points
    Interval length{1, 1};                               ///< range of the length, relative to the length at rest or absolute
    bool absolute = false;  ///< true: the range is in the unit of the points; false: relative to the rest state
};

/// Both singular values of the deformation gradient F of a triangle are in a range. Rows: the columns of F times the square root
/// of the rest area.
struct TriangleStrain {
    static constexpr KindInfo kind{"TriangleStrain", 3, 3};  ///< name of the kind, min and max number of points
    Interval stretch{1, 1};                                  ///< range of the singular values
};

/// The three singular values of the deformation gradient F of a tetrahedron are in a range; an inverted tetrahedron is restored.
/// Rows: the columns of F times the cube root of the rest volume.
struct TetrahedronStrain {
    static constexpr KindInfo kind{"TetrahedronStrain", 4, 4};  ///< name of the kind, min and max number of points
    Interval stretch{1, 1};                                     ///< range of the singular values
};

/// The area of a triangle, the product of the singular values of the deformation gradient F, is in a range. Rows: the columns of
/// F times the square root of the rest area.
struct Area {
    static constexpr KindInfo kind{"Area", 3, 3};  ///< name of the kind, min and max number of points
    Interval area{1, 1};                           ///< range of the area, relative to the area at rest or absolute
    bool absolute = false;  ///< true: the range is in the squared unit of the points; false: relative to the rest state
};

/// The signed volume of a tetrahedron, det F, is in a range. Rows: the columns of the deformation gradient F times the cube root
/// of the rest volume.
struct Volume {
    static constexpr KindInfo kind{"Volume", 4, 4};  ///< name of the kind, min and max number of points
    Interval volume{1, 1};                           ///< range of the volume, relative to the volume at rest or absolute
    bool absolute = false;  ///< true: the range is in the cubed unit of the points; false: relative to the rest state
};

/// The bend of the triangles 0 1 2 and 0 1 3 across their edge 0 1, the length of the row, is in a range. Row: the
/// cotangent-weighted bend (ShapeOp's Bending without its area factor).
struct Bending {
    static constexpr KindInfo kind{"Bending", 4, 4};  ///< name of the kind, min and max number of points
    Interval bend{1, 1};                              ///< range of the bend, relative to the bend at rest or absolute
    bool absolute = false;                            ///< true: the range is absolute; false: relative to the rest state
};

// ---- Laplacians. One row: the weighted mean of the neighbours minus the centre. Order of ids: the centre, then the neighbours.

/// The Laplacian row is zero; all neighbours have the same weight.
struct Laplacian {
    static constexpr KindInfo kind{"Laplacian", 2};  ///< name of the kind, and min number of points
};

/// The Laplacian row is a given displacement; all neighbours have the same weight.
struct LaplacianDisplacement {
    static constexpr KindInfo kind{"LaplacianDisplacement", 2};  ///< name of the kind, and min number of points
    std::optional<Eigen::Vector3d> displacement = {};            ///< target displacement; empty: the displacement at rest
};

/// The Laplacian row is zero, with cotangent weights (Pinkall and Polthier 1993) divided by their sum.
struct CotangentLaplacian {
    static constexpr KindInfo kind{"CotangentLaplacian", 2};  ///< name of the kind, and min number of points
    /// Weight of each neighbour; empty: cotangent weights of neighbours that form the closed ring around the centre in order.
    std::vector<double> weights = {};
};

/// The Laplacian row is a given displacement, with cotangent weights divided by their sum.
struct CotangentLaplacianDisplacement {
    static constexpr KindInfo kind{"CotangentLaplacianDisplacement", 2};  ///< name of the kind, and min number of points
    std::vector<double> weights = {};                                     ///< weight of each neighbour; empty: cotangent weights
    std::optional<Eigen::Vector3d> displacement = {};  ///< target displacement; empty: the displacement at rest
};

// ---- Groups that keep their shape (ShapeUp, section 4). Rows: the centred points. A shape has one point per id.

/// The points are a copy s R q of a shape q, with the proper rotation R that maximises tr(R^T sum r q^T) and the optimal factor s
/// in a range.
struct Similarity {
    static constexpr KindInfo kind{"Similarity", 2};  ///< name of the kind, and min number of points
    Interval scale{0, infinity};                      ///< range of the factor s
    std::optional<Points> shape = {};                 ///< shape q, one point per id; empty: the rest positions of the points
};

/// The points are a rotated copy of a shape: Similarity with s = 1.
struct Rigid {
    static constexpr KindInfo kind{"Rigid", 2};  ///< name of the kind, and min number of points
    std::optional<Points> shape = {};            ///< shape, one point per id; empty: the rest positions of the points
};

/// The points are a copy R (I + (s - 1) a a^T) q of a shape q, stretched along the shape's axis a by a factor s in a range.
struct NonUniformScaling {
    static constexpr KindInfo kind{"NonUniformScaling", 2};  ///< name of the kind, and min number of points
    Eigen::Vector3d axis;                                    ///< axis a of the shape, of any length
    Interval scale{0, infinity};                             ///< range of the factor s
    std::optional<Points> shape = {};  ///< shape q, one point per id; empty: the rest positions of the points
};

/// The points are the corners, in order, of a regular polygon of any size: Similarity to points on a circle.
struct Equilateral {
    static constexpr KindInfo kind{"Equilateral", 3};  ///< name of the kind, and min number of points
};

/// The points are the corners, in order, of a parallelogram: a quarter of their alternating sum is subtracted from each corner.
struct Parallelogram {
    static constexpr KindInfo kind{"Parallelogram", 4, 4};  ///< name of the kind, min and max number of points
};

/// The points are the corners, in order, of a rectangle: the closest parallelogram with both diagonals set to their mean length.
struct Rectangle {
    static constexpr KindInfo kind{"Rectangle", 4, 4};  ///< name of the kind, min and max number of points
};

// ---- Segments. Rows: differences of points, which have lengths and directions. "Pairs": two ids for each segment.

/// The angle at the first point between the directions to the two others is in a range (radians, at most pi). The projection
/// rotates both sides, the shorter side more: if the angle has to change by D, one side is rotated by a and the other by D - a
/// so that A sin^2 a + B sin^2 (D - a) is minimal, where A and B are the squared lengths. Rows: both sides.
struct Angle {
    static constexpr KindInfo kind{"Angle", 3, 3};  ///< name of the kind, min and max number of points
    Interval angle{0, 3.14159265358979323846};      ///< range of the angle, radians
};

/// Two segments (pairs of ids) are at a right angle; both rotate as the sides of kind Angle.
struct Perpendicular {
    static constexpr KindInfo kind{"Perpendicular", 4, 4};  ///< name of the kind, min and max number of points
};

/// All segments (pairs of ids) are parallel or antiparallel: the projection is the matrix of rank one closest to the rows.
struct Parallel {
    static constexpr KindInfo kind{"Parallel", 4};  ///< name of the kind, and min number of points
};

/// The length of a polyline is in a range: the projection changes the lengths of all edges by the same amount, but not below
/// zero.
struct PolylineLength {
    static constexpr KindInfo kind{"PolylineLength", 2};  ///< name of the kind, and min number of points
    Interval length{1, 1};                                ///< range of the length, relative to the length at rest or absolute
    bool absolute = false;  ///< true: the range is in the unit of the points; false: relative to the rest state
};

/// All segments (pairs of ids) have the same length; the projection sets it to their mean length.
struct EqualLengths {
    static constexpr KindInfo kind{"EqualLengths", 4};  ///< name of the kind, and min number of points
};

/// Two polylines have the same length: all edges of one polyline become longer, and all edges of the other shorter, by the same
/// amount.
struct EqualLength {
    static constexpr KindInfo kind{"EqualLength", 4};  ///< name of the kind, and min number of points
    int first;  ///< number of points of the first polyline; the other points form the second
};

}  // namespace ostraka::kinds
