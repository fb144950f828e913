// Slices of a mesh by parallel planes: nested, oriented contours.
//
// Vertices on a plane are treated consistently, because the signed height of each vertex is computed once. A vertex is ON a plane
// if its distance from the plane is at most 1e-9 of the mesh's bounding box diagonal; contours then pass through the vertex
// itself. ON is treated as above the plane, so that a slice equals the slice by an infinitesimally lower plane. If the plane
// passes through the lowest point of the cut faces, ON is treated as below, so that the slice of an object on a flat base is the
// outline of the base. Contours that degenerate (to a point, or a curve traversed back and forth) are removed.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace ostraka {

/// Vertices whose distance from a plane is at most this share of the bounding box diagonal are on the plane.
inline constexpr double on_plane_share = 1e-9;

/// Coordinate system of slices: the point (x, y) at height h is origin + x u + y v + h normal. Right-handed, unit vectors.
struct SliceFrame {
    Point origin{0, 0, 0};
    Vector u{1, 0, 0}, v{0, 1, 0}, normal{0, 0, 1};

    [[nodiscard]] double height(const Point& p) const { return normal * (p - origin); }  ///< height of a point
    /// Coordinates (x, y) of a point along u and v.
    [[nodiscard]] Eigen::Vector2d place(const Point& p) const { return {u * (p - origin), v * (p - origin)}; }
    /// The point with coordinates (x, y) at a height.
    [[nodiscard]] Point point(const Eigen::Vector2d& at, double height) const {
        return origin + (at.x() * u + at.y() * v + height * normal);
    }
};

/// A contour of a slice. On a mesh oriented outwards the material lies to the left of the contour, seen from the side to which
/// the normal points.
struct Contour {
    /// For a closed contour the first point is not repeated; consecutive points are distinct.
    std::vector<Eigen::Vector2d> points;
    bool closed = true;  ///< false: the contour ends at the border of the mesh or of the selected part, and encloses no area
    bool hole = false;   ///< true: the contour is closed and clockwise and bounds a hole in the material
    /// Index of the smallest closed contour of the slice that contains this contour; -1: none, as for open contours.
    int parent = -1;
    int depth = 0;             ///< number of closed contours that contain this contour
    std::vector<Index> faces;  ///< faces[i] contains the segment from points[i] to the next point
    double length = 0;         ///< length of the contour
    double area = 0;           ///< signed area of a closed contour, positive if counter-clockwise; 0 for an open contour
    double gap = 0;            ///< distance between the ends of an open contour
    bool crosses = false;      ///< true: a closed contour that intersects another closed contour or itself
    /// True: a closed contour that was reversed because its orientation contradicted its nesting (a wrongly oriented shell).
    bool reversed = false;
};

/// Areas are reliable if intersecting contours affect at most this share of the outer contours' area. Small folds, as in scans,
/// affect less.
inline constexpr double max_doubtful = 1e-3;

/// Completeness of a slice's outline, and reliability of its areas. The ends of an open contour are never joined, because the
/// course of the missing part is unknown. If the open contours are longer than the closed ones and lie on a circle, `share` is
/// the covered fraction of that circle.
struct Completeness {
    double closed_share = 1;  ///< length of closed contours / length of all contours
    /// Preserved fraction of the outline. 1 if all contours are closed; otherwise the angle of the circle that the open
    /// contours cover, divided by the full turn. NaN if the open contours do not lie on a circle or if there is a longer closed
    /// contour.
    double share = 1;
    /// Bounds of the 95 % confidence interval of `share` (`ArcFit`); NaN where `share` is NaN.
    double share_low = 1, share_high = 1;
    /// Upper bound of the preserved fraction for an outline of any shape: length / (length + min total length of lines that
    /// join the ends of open contours).
    double share_at_most = 1;
    /// Number of closed contours that intersect other contours or themselves, because the mesh intersects itself.
    int crossing = 0;
    int reversed_contours =
        0;  ///< number of closed contours that were reversed because their orientation contradicted their nesting
    /// Upper bound of the error of the area due to intersecting contours, divided by the area of the outer contours.
    double doubtful = 0;

    /// True if all contours are closed.
    [[nodiscard]] bool complete() const { return closed_share == 1; }
    /// Angle, in radians, of the circle that the open contours cover; NaN if they do not lie on a circle.
    [[nodiscard]] double angle() const { return 2 * 3.141592653589793 * share; }
    /// True if the areas of the slice are reliable.
    [[nodiscard]] bool has_areas() const { return doubtful <= max_doubtful; }
};

/// The contours at one height: closed contours by decreasing area, then open contours by decreasing length.
struct Slice {
    double height = 0;  ///< height of the plane above the frame's origin
    std::vector<Contour> contours;
    Completeness completeness;  ///< for a slice without contours all fractions are 1
};

/// Slices of a mesh by parallel planes.
struct SliceStack {
    SliceFrame frame;           ///< frame of all slices
    std::vector<Slice> slices;  ///< one slice per height, in the given order
    bool reversed = false;      ///< true: the mesh is closed and inside out, and all contours were reversed
};

/// Slices the mesh (or the given faces) at `heights` above the frame's origin. Faces are assigned to the planes that cross
/// them, and segments are joined at shared mesh edges, without comparing coordinates. Time: O(faces log heights + output log
/// output), in parallel; the result does not depend on the number of threads. A plane that does not intersect the mesh gives a
/// slice without contours. Open and self-intersecting meshes are sliced as well: contours may be open or intersect; a contour
/// that intersects another contour is nested in it if at least three of five sample points lie inside. A shell is reversed if
/// the orientation of most of its contours contradicts their nesting (a contour is oriented like its parent, or an outermost
/// contour of a closed mesh is a hole). Throws Error (usage) for a frame that is not right-handed with unit vectors, a height
/// that is not finite, or a face that is not in the mesh; Error (input) for a mesh (or part) without faces.
SliceStack slice_mesh(const Mesh& mesh, const SliceFrame& frame, const std::vector<double>& heights,
                      const std::vector<Index>& faces = {});

/// A frame whose normal has this direction (of any length): u is the x axis projected into the plane (the y axis if the normal is
/// nearly along x), so that (0, 0, 1) gives u = x, v = y. Throws Error (usage) for a direction without length.
SliceFrame slice_frame(const Point& origin, const Vector& direction);

/// Min and max height of the faces (of all faces if the list is empty) above the frame's origin.
std::pair<double, double> height_range(const Mesh& mesh, const SliceFrame& frame, const std::vector<Index>& faces = {});

/// The heights of the mid-planes of `count` equal layers between `lowest` and `highest`. Throws Error (usage) for a count below 1
/// or above a million.
std::vector<double> slice_heights(double lowest, double highest, int count);
/// The heights lowest, lowest + spacing, ... up to `highest`. Throws Error (usage) for a spacing that is not positive or gives
/// more than a million heights.
std::vector<double> slice_heights_spaced(double lowest, double highest, double spacing);

/// Splits a slice into components: each outer contour with the holes directly in it, as a separate slice (an island in a hole
/// is a component too). The completeness of a component refers to its closed contours. Open contours, and holes that lie in no
/// outer contour, are in no component.
std::vector<Slice> components(const Slice& slice);

}  // namespace ostraka
