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

/// Outline of the wall at positive radii, with the wall on its left: from axis to axis, or closed.
struct Outline {
    std::vector<Eigen::Vector2d> points;  ///< radius, height
    bool closed = false;                  ///< the wall does not reach the axis
};

/// Image with square cells: rows are heights, columns are radii.
struct ProfileImage {
    double step = 0;
    std::size_t rows = 0, columns = 0;
    std::vector<double> wall_share;   ///< share of the informative rays that are inside the wall
    std::vector<double> informative;  ///< number of informative rays: those that determine whether there is wall
    std::vector<double> present;      ///< per row, number of rays that hit anything

    /// Adds to the cells of a row between two radii; `cells` is one of the two arrays above.
    void add(std::vector<double>& cells, std::size_t row, double from, double to) const;
    void clear(std::size_t row);
    /// Whether the wall reaches the axis in a row from `first` to before `end`.
    [[nodiscard]] bool reaches_axis(std::size_t first, std::size_t end) const;
    /// Fills rows without wall between others by linear interpolation.
    void bridge(std::vector<std::string>* notes);
    /// Gaussian smoothing with a standard deviation in cells, mirrored at the axis.
    void smooth(double deviation);
    /// The level line of one half of the largest component (marching squares).
    [[nodiscard]] Outline outline() const;

private:
    [[nodiscard]] double at(long row, long column) const;
};

/// `count` points at equal distances along the curve (including both ends of an open curve).
std::vector<Eigen::Vector2d> resampled(const std::vector<Eigen::Vector2d>& line, bool closed, int count);

}  // namespace ostraka::detail

namespace ostraka {

/// Frame of the axis: height along it, directions across it.
struct AxisFrame {
    Eigen::Vector3d foot = Eigen::Vector3d::Zero(), up = Eigen::Vector3d::UnitZ(), u = Eigen::Vector3d::UnitX(),
                    w = Eigen::Vector3d::UnitY();
    [[nodiscard]] double height(const Eigen::Vector3d& p) const { return (p - foot).dot(up); }
    [[nodiscard]] Eigen::Vector3d across(const Eigen::Vector3d& p) const { return p - foot - height(p) * up; }
    [[nodiscard]] Eigen::Vector3d direction(double angle) const { return std::cos(angle) * u + std::sin(angle) * w; }
};

AxisFrame frame_of(const Axis& axis);

/// A sherd with its state in the template construction.
struct PlacedSherd {
    const Fragment* fragment = nullptr;
    bool inside_out = false;   ///< its faces are oriented inwards
    bool walls = true;         ///< it is closed, so that the inside of its wall is known
    bool axis = true;          ///< its axis is used
    bool contradicts = false;  ///< it was left out because its axis contradicts the others
    Motion motion;             ///< to where its axis and height agree with the common ones
};

struct JoinedSherds {
    Mesh mesh;
    std::vector<std::vector<Index>> of_fragment;  ///< per sherd, its faces that are not fracture
    [[nodiscard]] std::vector<Index> faces() const;
    [[nodiscard]] std::vector<bool> broken() const;  ///< per face of the mesh
};

/// The moved sherds for which `selected` is true; the others contribute no faces.
JoinedSherds joined(const std::vector<PlacedSherd>& sherds, const std::vector<bool>& selected);

/// Estimates the axis of all sherds that are not left out, and the motion that aligns each sherd's own axis with it: fills in
/// axis, errors and sherds of the template, and the motions. Leaves out sherds without information and those that contradict
/// the others. Throws Error (input) if no sherd is left.
void find_common_axis(std::vector<PlacedSherd>& sherds, const RevolutionOptions& options, RevolutionTemplate& result);

void leave_out(SherdOnProfile& sherd, const std::string& reason, const std::string& remedy = {});
/// Error (input) that names each sherd and why it is left out.
[[noreturn]] void fail_all_left_out(const RevolutionTemplate& result);

struct WallSection {
    detail::ProfileImage image;
    std::vector<double> tops;  ///< per direction, height of the highest wall above the lowest row; none: -1

    /// Clears heights with too little wall.
    void drop_rare(const RevolutionOptions& options);
    /// Whether there is a rim: all wall near the top ends at one height.
    [[nodiscard]] bool has_rim(const RevolutionOptions& options) const;
};

/// The share of rays from the axis that are inside the wall, by height and radius. A ray that enters or leaves the solid
/// through a fracture (`broken` of its face, or a normal far from the plane through the axis) gives no information on the wall
/// beyond.
WallSection wall_section(const SurfaceSearch& search, const std::vector<bool>& broken, const AxisFrame& frame, double low,
                         double high, double max_radius, const RevolutionOptions& options);

/// Rings of vertices around the axis, with a vertex count proportional to their circumference, connected by triangles.
class ProfileSweep {
public:
    /// Heights are above `lowest`; the mean edge length is about `edge`.
    ProfileSweep(const AxisFrame& frame, double lowest, double edge) : frame_(frame), lowest_(lowest), edge_(edge) {}

    /// Adds a ring at this radius and height; a single vertex for radius 0.
    void ring(const Eigen::Vector2d& point);
    /// Connects two rings by triangles.
    void sew(std::size_t a, std::size_t b);
    [[nodiscard]] TriangleSoup soup() const;

    struct Ring {
        std::vector<Vertex> vertices;
        bool pole = false;
    };
    std::vector<Ring> rings;

private:
    void add(Vertex a, Vertex b, Vertex c) { triangles_.push_back({Index(a), Index(b), Index(c)}); }
    const AxisFrame& frame_;
    double lowest_, edge_;
    Mesh mesh_;  ///< vertices only
    std::vector<std::array<Index, 3>> triangles_;
};

/// The rings of vertices of the template, one per point of its profile.
struct ProfileRings {
    std::vector<std::vector<Vertex>> vertices;
    std::vector<std::size_t> of_vertex;
};

/// Regions "outer", "inner", "base", lines "rim" or "upper end", "widest girth", "foot", points "base centre", "floor centre",
/// and the axis, whose foot is `lowest` above that of the frame.
void annotate_revolution(RevolutionTemplate& result, const AxisFrame& frame, double lowest, const ProfileRings& profile_rings);

}  // namespace ostraka
