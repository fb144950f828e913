// Parallel planes through a mesh: nested, oriented contours.
//
// What happens at vertices on a plane is ruled once: each vertex has one signed height a frame. Within 1e-9 of the mesh's box
// diagonal of a plane it lies ON it, and contours pass through the vertex itself. ON counts as above, so that a slice is that of
// the plane a hair lower; but where the plane passes through the lowest place of what is cut, ON counts as below, so that an
// object on a flat base has the base's outline there. What then has no extent (a point, or a curve there and back) is removed.
#pragma once

#include "ostraka/core/mesh.h"

#include <Eigen/Core>

#include <utility>
#include <vector>

namespace ostraka {

/// Heights within this share of the box diagonal of a plane count as on it.
inline constexpr double on_plane_share = 1e-9;

/// Where slices lie: the place (x, y) at height h is origin + x u + y v + h normal. Right-handed, unit vectors.
struct SliceFrame {
    Point origin{0, 0, 0};
    Vector u{1, 0, 0}, v{0, 1, 0}, normal{0, 0, 1};

    [[nodiscard]] double height(const Point& p) const { return normal * (p - origin); }
    [[nodiscard]] Eigen::Vector2d place(const Point& p) const { return {u * (p - origin), v * (p - origin)}; }
    [[nodiscard]] Point point(const Eigen::Vector2d& at, double height) const {
        return origin + (at.x() * u + at.y() * v + height * normal);
    }
};

/// A curve of a slice. On a mesh oriented outwards the material lies to its left, seen from where the normal points to.
struct Contour {
    std::vector<Eigen::Vector2d> points;  ///< closed: the first is not repeated; no two neighbours are the same
    bool closed = true;                   ///< an open one ends at the mesh's border, or that of the part; it bounds nothing
    bool hole = false;                    ///< closed and clockwise: it bounds material from within
    int parent = -1;           ///< the smallest closed contour of the slice that contains it (-1: none); open contours have none
    int depth = 0;             ///< number of closed contours that contain it
    std::vector<Index> faces;  ///< faces[i] holds the piece from points[i] to the next point
    double length = 0;
    double area = 0;       ///< closed: signed, positive counter-clockwise; 0 for open ones
    double gap = 0;        ///< open: the straight distance between its ends
    bool crosses = false;  ///< closed: it crosses another closed one, or itself
    bool turned = false;   ///< closed: it ran the other way round, against its nesting (a shell that is oriented wrongly)
};

/// Contours that cross by more than this share of the area have no area: a fold of a scan has less.
inline constexpr double max_doubtful = 1e-3;

/// How much of its outline a slice has, and how sound that is. What an open contour leaves open is not known: its ends are never
/// joined. If the longer part of it is open and runs along a circle, `share` is what is there of that circle's turn.
struct Completeness {
    double closed_share = 1;  ///< length of closed contours / length of all contours
    double share = 1;         ///< of the outline: 1 if all is closed; the angle of the circle over the full turn; NaN where it
                              ///< cannot be told: the open contours run along no circle, or beside a longer closed one
    double share_low = 1, share_high = 1;  ///< 95 % interval of that (`ArcFit`); NaN where that is
    /// Whatever the outline's shape: length / (that + the least by which the ends of open contours can be joined).
    double share_at_most = 1;
    int crossing = 0;     ///< closed contours that cross others or themselves: the mesh passes through itself
    int turned = 0;       ///< closed contours that were turned around, since their nesting says otherwise
    double doubtful = 0;  ///< area that may count twice or not at all through crossings, at most, over that of the outer contours

    [[nodiscard]] bool complete() const { return closed_share == 1; }
    /// Of the circle of the open contours, radians; NaN where there is none.
    [[nodiscard]] double angle() const { return 2 * 3.141592653589793 * share; }
    /// Whether areas mean what they say.
    [[nodiscard]] bool has_areas() const { return doubtful <= max_doubtful; }
};

/// The contours at one height: closed ones first, larger areas first, then open ones, longer ones first.
struct Slice {
    double height = 0;
    std::vector<Contour> contours;
    Completeness completeness;  ///< of a slice without contours: all 1, and it bounds nothing
};

struct SliceStack {
    SliceFrame frame;
    std::vector<Slice> slices;  ///< one a height, in the order asked for
    bool reversed = false;      ///< the mesh is closed and inside out: all contours were turned around
};

/// Cuts the mesh (or the given faces of it) at `heights` over the frame's origin. Faces are sorted into the planes that cross
/// them and joined by their shared edges, no coordinates are compared: O(faces log heights + output log output), in parallel, the
/// same for any number of threads. A plane that misses has a slice without contours. Meshes that are open or pass through
/// themselves are cut as well: contours may be open, or cross; a contour that crosses another one lies in it if most of five of
/// its points do. Shells most of whose contours run against their nesting (the way their parent does; or an
/// outermost hole of a closed mesh) are turned around. Throws
/// Error (usage) for a frame that is not right-handed with unit vectors, a height that is not finite, or a face that is not in
/// the mesh; Error (input) for a mesh (or part) without faces.
SliceStack slice_mesh(const Mesh& mesh, const SliceFrame& frame, const std::vector<double>& heights,
                      const std::vector<Index>& faces = {});

/// A frame with this normal (of any length): u is the x axis turned into the plane (the y axis where the normal is nearly along
/// x), so that (0, 0, 1) gives u = x, v = y. Throws Error (usage) for a direction without length.
SliceFrame slice_frame(const Point& origin, const Vector& direction);

/// Lowest and highest height of the faces (of all, if none are given) over the frame's origin.
std::pair<double, double> height_range(const Mesh& mesh, const SliceFrame& frame, const std::vector<Index>& faces = {});

/// The middles of `count` equal layers between `lowest` and `highest`. Throws Error (usage) below 1 or above a million.
std::vector<double> slice_heights(double lowest, double highest, int count);
/// lowest, lowest + spacing, ... up to `highest`. Throws Error (usage) for a spacing that is not positive or gives over a
/// million.
std::vector<double> slice_heights_spaced(double lowest, double highest, double spacing);

/// Each outer contour with the holes directly in it, as slices of their own (an island in a hole is a component too; the
/// completeness is that of its closed contours). Open contours, and holes that lie in no outer contour, belong to none.
std::vector<Slice> components(const Slice& slice);

}  // namespace ostraka
