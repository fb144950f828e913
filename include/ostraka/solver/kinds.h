// Kinds of constraints on points as such: positions, fitted shapes, strain, Laplacians, groups that keep their shape, segments.
// Each type holds the parameters of its kind. part_kinds.h has the kinds that act on the parts of an object.
//
// A kind is defined by its rows B x and by what it admits (constraint.h). Rows are lengths in the points' unit. "Centred" rows
// are the points minus their mean. Where ShapeOp (Deuss et al. 2015) has the kind, its name and its order of ids are used.
#pragma once

#include "ostraka/solver/constraint.h"

#include <limits>

namespace ostraka::kinds {

/// The name of a kind, as in files and messages, and the number of points that it acts on.
struct KindInfo {
    std::string_view name;
    int min_points, max_points = 0;  ///< max_points 0: any number
};

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Admissible values. `max` may be infinite.
struct Interval {
    double min, max;
    [[nodiscard]] double clamp(double value) const { return value < min ? min : (value > max ? max : value); }
};

// ---- Positions and fitted shapes (ShapeUp, Bouaziz et al. 2012, section 4; the thesis, section 4.2)

/// Points at given positions: P(r) = targets. Rows: the points.
struct Closeness {
    static constexpr KindInfo kind{"Closeness", 1};
    std::optional<Points> targets = {};  ///< one per point; default: the rest positions
};

/// Points on a surface: P(r_i) is the closest point of the surface. Rows: the points.
struct OnSurface {
    static constexpr KindInfo kind{"OnSurface", 1};
    std::function<Eigen::Vector3d(const Eigen::Vector3d&)> closest_point;  ///< must be thread-safe
};

/// Points on a line: P(r) = d d^T r with the first principal axis d of the rows. Rows: the centred points.
struct Line {
    static constexpr KindInfo kind{"Line", 2};
};

/// Points on a plane: P(r) = r - n n^T r with the last principal axis n of the rows. Rows: the centred points.
struct Plane {
    static constexpr KindInfo kind{"Plane", 3};
};

/// Points on a plane with a given normal n (the thesis, section 5.2.1): P(r) = r - n n^T r. Rows: the centred points.
struct Orientation {
    static constexpr KindInfo kind{"Orientation", 2};
    Eigen::Vector3d normal;  ///< of any length
};

/// Points on the circle of least squared distance, or on a line, the limit of circles, if that is closer. Levenberg-Marquardt
/// from the algebraic fit (Kasa 1976). Rows: the centred points.
struct Circle {
    static constexpr KindInfo kind{"Circle", 3};
};

/// Points on the sphere of least squared distance, or on a plane if that is closer; computed as for Circle.
struct Sphere {
    static constexpr KindInfo kind{"Sphere", 4};
};

// ---- Strain (ShapeUp; Bouaziz et al. 2014, Projective Dynamics). F: the deformation gradient against the rest state in the
// Gram-Schmidt frame of the rest edges 0 1, 0 2 (, 0 3). Ranges are relative to the rest state or, if absolute, in the unit of
// the points.

/// The length of the segment is in a range. Row: x_1 - x_0.
struct EdgeStrain {
    static constexpr KindInfo kind{"EdgeStrain", 2, 2};
    Interval length{1, 1};
    bool absolute = false;
};

/// Both singular values of F are in a range. Rows: the columns of F times the square root of the rest area.
struct TriangleStrain {
    static constexpr KindInfo kind{"TriangleStrain", 3, 3};
    Interval stretch{1, 1};
};

/// The three singular values of F are in a range; an inverted tetrahedron is restored. Rows: the columns of F times the cube
/// root of the rest volume.
struct TetrahedronStrain {
    static constexpr KindInfo kind{"TetrahedronStrain", 4, 4};
    Interval stretch{1, 1};
};

/// The product of the singular values of F, the area, is in a range. Rows as for TriangleStrain.
struct Area {
    static constexpr KindInfo kind{"Area", 3, 3};
    Interval area{1, 1};
    bool absolute = false;
};

/// det F, the volume with its sign, is in a range. Rows as for TetrahedronStrain.
struct Volume {
    static constexpr KindInfo kind{"Volume", 4, 4};
    Interval volume{1, 1};
    bool absolute = false;
};

/// The length of the row is in a range: the cotangent-weighted bend of the triangles 0 1 2 and 0 1 3 across their edge 0 1
/// (ShapeOp's Bending without its area factor).
struct Bending {
    static constexpr KindInfo kind{"Bending", 4, 4};
    Interval bend{1, 1};
    bool absolute = false;
};

// ---- Laplacians. One row: the weighted mean of the neighbours minus the centre; ids: the centre, then the neighbours.

/// The row is zero; all neighbours have the same weight.
struct Laplacian {
    static constexpr KindInfo kind{"Laplacian", 2};
};

/// The row is a given displacement; all neighbours have the same weight.
struct LaplacianDisplacement {
    static constexpr KindInfo kind{"LaplacianDisplacement", 2};
    std::optional<Eigen::Vector3d> displacement = {};  ///< default: that of the rest state
};

/// The row is zero; cotangent weights (Pinkall and Polthier 1993), divided by their sum.
struct CotangentLaplacian {
    static constexpr KindInfo kind{"CotangentLaplacian", 2};
    std::vector<double> weights =
        {};  ///< weights of the neighbours; default: computed for neighbours that form the closed ring in order
};

/// The row is a given displacement; weights as for CotangentLaplacian.
struct CotangentLaplacianDisplacement {
    static constexpr KindInfo kind{"CotangentLaplacianDisplacement", 2};
    std::vector<double> weights = {};
    std::optional<Eigen::Vector3d> displacement = {};  ///< default: that of the rest state
};

// ---- Groups that keep their shape (ShapeUp, section 4). Rows: the centred points. Shapes have one point per id.

/// A copy s R q of a shape q with the proper rotation R that maximises tr(R^T sum r q^T) and the best factor s in a range.
struct Similarity {
    static constexpr KindInfo kind{"Similarity", 2};
    Interval scale{0, infinity};
    std::optional<Points> shape = {};  ///< default: the rest points
};

/// A rotated copy of a shape: Similarity with s = 1.
struct Rigid {
    static constexpr KindInfo kind{"Rigid", 2};
    std::optional<Points> shape = {};  ///< default: the rest points
};

/// A copy R (I + (s - 1) a a^T) q of a shape, stretched along its own axis a by a factor in a range.
struct NonUniformScaling {
    static constexpr KindInfo kind{"NonUniformScaling", 2};
    Eigen::Vector3d axis;  ///< of any length
    Interval scale{0, infinity};
    std::optional<Points> shape = {};  ///< default: the rest points
};

/// A regular polygon of any size, corners in order: Similarity of points on a circle.
struct Equilateral {
    static constexpr KindInfo kind{"Equilateral", 3};
};

/// A parallelogram, corners in order: a quarter of their alternating sum is subtracted from each.
struct Parallelogram {
    static constexpr KindInfo kind{"Parallelogram", 4, 4};
};

/// A rectangle: the closest parallelogram, both diagonals with their mean length.
struct Rectangle {
    static constexpr KindInfo kind{"Rectangle", 4, 4};
};

// ---- Segments. Rows: differences of points, which have lengths and directions. "Pairs": two ids for each segment.

/// The angle at the first point between the two others is in a range (radians, at most pi). Both sides turn, the shorter one
/// more: with squared lengths A, B and the excess D, A sin^2 a + B sin^2 (D - a) is minimal. Rows: both sides.
struct Angle {
    static constexpr KindInfo kind{"Angle", 3, 3};
    Interval angle{0, 3.14159265358979323846};
};

/// Two segments (pairs) at a right angle; computed as for Angle.
struct Perpendicular {
    static constexpr KindInfo kind{"Perpendicular", 4, 4};
};

/// All segments (pairs) are parallel or antiparallel: the matrix of rank one closest to the rows.
struct Parallel {
    static constexpr KindInfo kind{"Parallel", 4};
};

/// The length of a polyline is in a range: all edges change by the same amount, to zero at most.
struct PolylineLength {
    static constexpr KindInfo kind{"PolylineLength", 2};
    Interval length{1, 1};  ///< relative to the rest state or, if absolute, in the unit of the points
    bool absolute = false;
};

/// All segments (pairs) have the same length, that of their mean.
struct EqualLengths {
    static constexpr KindInfo kind{"EqualLengths", 4};
};

/// Two polylines have the same length; the edges change as for PolylineLength, with opposite signs.
struct EqualLength {
    static constexpr KindInfo kind{"EqualLength", 4};
    int first;  ///< number of points of the first polyline; the others form the second
};

}  // namespace ostraka::kinds
