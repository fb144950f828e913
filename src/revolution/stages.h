// Interfaces between the stages of the template construction: registered sherds, wall, profile, swept profile, annotations.
#pragma once

#include "ostraka/axis/axis.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/revolution/surface_of_revolution.h"

#include <cmath>
#include <string>
#include <vector>

namespace ostraka::detail {

/// Outline of the wall in the half-plane of positive radii, with the wall on its left: from axis to axis, or closed.
struct Outline {
    std::vector<Eigen::Vector2d> points;  ///< points (radius, height)
    bool closed = false;                  ///< true: the wall does not reach the axis
};

/// Image of the wall with square cells: rows are heights, columns are radii.
struct ProfileImage {
    double step = 0;                    ///< side of a cell
    std::size_t rows = 0, columns = 0;  ///< number of heights, and of radii
    std::vector<double> wall_share;     ///< for each cell, the share of its informative rays that are inside the wall
    /// For each cell, the number of informative rays: rays that determine whether there is wall.
    std::vector<double> informative;
    std::vector<double> present;  ///< for each row, the number of rays that hit a wall

    /// Adds to each cell of a row the share of the cell between two radii; `cells` is `wall_share` or `informative`.
    void add(std::vector<double>& cells, std::size_t row, double from, double to) const;
    void clear(std::size_t row);  ///< removes the wall from a row
    /// Whether the wall reaches the axis in one of the rows from `first` to before `end`.
    [[nodiscard]] bool reaches_axis(std::size_t first, std::size_t end) const;
    /// Fills rows without wall between rows with wall by linear interpolation; `notes` gets a remark for each gap.
    void bridge(std::vector<std::string>* notes);
    /// Gaussian smoothing with this standard deviation in cells, mirrored at the axis.
    void smooth(double deviation);
    /// The level line where half of the rays are inside the wall, for the largest component (marching squares).
    [[nodiscard]] Outline outline() const;

private:
    [[nodiscard]] double at(long row, long column) const;  ///< wall share of a cell, mirrored at the axis; 0 outside the image
};

/// `count` points at equal distances along the curve `line` (including both ends of an open curve).
std::vector<Eigen::Vector2d> resampled(const std::vector<Eigen::Vector2d>& line, bool closed, int count);

}  // namespace ostraka::detail

namespace ostraka {

/// Coordinate system of an axis: height along the axis, directions across it.
struct AxisFrame {
    Eigen::Vector3d foot = Eigen::Vector3d::Zero(), up = Eigen::Vector3d::UnitZ(), u = Eigen::Vector3d::UnitX(),
                    w = Eigen::Vector3d::UnitY();
    /// Height along the axis above the foot.
    [[nodiscard]] double height(const Eigen::Vector3d& p) const { return (p - foot).dot(up); }
    /// Component of p - foot perpendicular to the axis.
    [[nodiscard]] Eigen::Vector3d across(const Eigen::Vector3d& p) const { return p - foot - height(p) * up; }
    /// Unit vector at an angle around the axis.
    [[nodiscard]] Eigen::Vector3d direction(double angle) const { return std::cos(angle) * u + std::sin(angle) * w; }
};

/// The coordinate system of an axis; its height 0 is at the axis's point.
AxisFrame frame_of(const Axis& axis);

/// A sherd with its role in the construction of the template.
struct PlacedSherd {
    const Fragment* fragment = nullptr;  ///< fragment of the sherd, with its mesh and facets
    bool inside_out = false;             ///< true: the faces are oriented inwards
    bool walls = true;                   ///< true: the mesh is closed, so that the inside of the wall is known
    bool axis = true;                    ///< true: the axis of the sherd is used
    bool contradicts = false;            ///< true: the sherd was left out because its axis contradicts the others
    Motion motion;                       ///< maps the sherd to where its axis and height agree with the common ones
};

/// One mesh of the moved sherds.
struct JoinedSherds {
    Mesh mesh;                                       ///< faces of all selected sherds
    std::vector<std::vector<Index>> of_fragment;     ///< for each sherd, its faces in `mesh` that are not fracture
    [[nodiscard]] std::vector<Index> faces() const;  ///< faces of all sherds in `mesh` that are not fracture
    [[nodiscard]] std::vector<bool> broken() const;  ///< for each face of `mesh`, whether it belongs to a fracture
};

/// Joins the moved sherds for which `selected` is true into one mesh; the other sherds contribute no faces.
JoinedSherds joined(const std::vector<PlacedSherd>& sherds, const std::vector<bool>& selected);

/// Estimates the common axis of all sherds that are not left out, and the motion that aligns each sherd's own axis with the
/// common axis: fills in axis, errors and sherds of `result`, and the motions of `sherds`. Leaves out sherds without information
/// and sherds that contradict the others. Throws Error (input) if no sherd is left.
void find_common_axis(std::vector<PlacedSherd>& sherds, const RevolutionOptions& options, RevolutionTemplate& result);

/// Marks a sherd as left out, with the reason and the remedy.
void leave_out(SherdOnProfile& sherd, const std::string& reason, const std::string& remedy = {});
/// Throws Error (input) that names each sherd and why it is left out.
[[noreturn]] void fail_all_left_out(const RevolutionTemplate& result);

/// The wall in all directions around the axis.
struct WallSection {
    detail::ProfileImage image;  ///< share of rays inside the wall
    std::vector<double> tops;    ///< for each direction, height of the highest wall above the lowest row; -1: no wall

    /// Removes the wall from heights with too little wall.
    void drop_rare(const RevolutionOptions& options);
    /// Whether there is a rim: all wall near the top ends at one height, within a tolerance.
    [[nodiscard]] bool has_rim(const RevolutionOptions& options) const;
};

/// For each height and radius, the share of rays from the axis that are inside the wall. A ray that enters or leaves the solid
/// through a fracture (`broken` is true for the face, or the normal is far from the plane through the axis) gives no information
/// on the wall beyond. `low`, `high`: range of heights.
WallSection wall_section(const SurfaceSearch& search, const std::vector<bool>& broken, const AxisFrame& frame, double low,
                         double high, double max_radius, const RevolutionOptions& options);

/// Rings of vertices around the axis, connected by triangles; the number of vertices of a ring is proportional to its
/// circumference.
class ProfileSweep {
public:
    /// `lowest`: height of the profile's lowest point in `frame`; `edge`: approximate mean edge length.
    ProfileSweep(const AxisFrame& frame, double lowest, double edge) : frame_(frame), lowest_(lowest), edge_(edge) {}

    /// Adds a ring at this radius and height above `lowest`; a single vertex if the radius is 0.
    void ring(const Eigen::Vector2d& point);
    /// Connects the rings with indices `a` and `b` by triangles.
    void sew(std::size_t a, std::size_t b);
    [[nodiscard]] TriangleSoup soup() const;  ///< the swept surface

    /// Vertices of a ring.
    struct Ring {
        std::vector<Vertex> vertices;  ///< indices of the vertices around the axis
        bool pole = false;             ///< true: the ring is a single vertex on the axis
    };
    std::vector<Ring> rings;  ///< rings in the order in which they were added

private:
    void add(Vertex a, Vertex b, Vertex c) { triangles_.push_back({Index(a), Index(b), Index(c)}); }
    const AxisFrame& frame_;
    double lowest_, edge_;  ///< height of the lowest point; approximate mean edge length
    Mesh mesh_;             ///< the vertices, without faces
    std::vector<std::array<Index, 3>> triangles_;
};

/// The rings of vertices of the template, one ring per point of its profile.
struct ProfileRings {
    std::vector<std::vector<Vertex>> vertices;  ///< vertices of each ring
    std::vector<std::size_t> of_vertex;         ///< for each vertex, index of its ring
};

/// Annotates the template: regions "outer", "inner", "base", lines "rim" or "upper end", "widest girth", "foot", points "base
/// centre", "floor centre", and the axis. `lowest`: height of the template's foot in `frame`.
void annotate_revolution(RevolutionTemplate& result, const AxisFrame& frame, double lowest, const ProfileRings& profile_rings);

}  // namespace ostraka
