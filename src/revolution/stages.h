// What the stages of a vessel's template hand on: sherds on one axis, the wall, its profile, the profile swept, annotations.
#pragma once

#include "ostraka/axis/axis.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/revolution/surface_of_revolution.h"

#include <cmath>
#include <string>
#include <vector>

namespace ostraka::detail {

/// A curve around the wall right of the axis, the wall on its left: from the axis to the axis, or closed.
struct Outline {
    std::vector<Eigen::Vector2d> points;  ///< radius, height
    bool closed = false;                  ///< the wall does not reach the axis
};

/// Square cells: rows are heights, columns radii from the axis on.
struct ProfileImage {
    double step = 0;
    std::size_t rows = 0, columns = 0;
    std::vector<double> wall_share;  ///< share of the rays that tell that is inside the wall
    std::vector<double> telling;     ///< rays that tell whether there is wall
    std::vector<double> present;     ///< rays that meet anything, of each row

    /// To the cells of a row between two radii, of one of the two above.
    void add(std::vector<double>& cells, std::size_t row, double from, double to) const;
    void clear(std::size_t row);
    /// In a row from `first` to before `end`.
    [[nodiscard]] bool reaches_axis(std::size_t first, std::size_t end) const;
    /// Rows without wall between others get the wall between those, straight.
    void bridge(std::vector<std::string>* notes);
    /// Gaussian of a standard deviation in cells, mirrored at the axis.
    void smooth(double deviation);
    /// The level line of one half of the largest piece (marching squares).
    [[nodiscard]] Outline outline() const;

private:
    [[nodiscard]] double at(long row, long column) const;
};

/// `count` points evenly along the curve (of an open one both ends too).
std::vector<Eigen::Vector2d> resampled(const std::vector<Eigen::Vector2d>& line, bool closed, int count);

}  // namespace ostraka::detail

namespace ostraka {

/// Everything in the frame of the axis: height along it, directions across it.
struct AxisFrame {
    Eigen::Vector3d foot = Eigen::Vector3d::Zero(), up = Eigen::Vector3d::UnitZ(), u = Eigen::Vector3d::UnitX(),
                    w = Eigen::Vector3d::UnitY();
    [[nodiscard]] double height(const Eigen::Vector3d& p) const { return (p - foot).dot(up); }
    [[nodiscard]] Eigen::Vector3d across(const Eigen::Vector3d& p) const { return p - foot - height(p) * up; }
    [[nodiscard]] Eigen::Vector3d direction(double angle) const { return std::cos(angle) * u + std::sin(angle) * w; }
};

AxisFrame frame_of(const Axis& axis);

/// A sherd on its way into the template.
struct LaidSherd {
    const Fragment* fragment = nullptr;
    bool inside_out = false;   ///< its faces count the other way round
    bool walls = true;         ///< it is closed, so that where its clay is can be told
    bool axis = true;          ///< what it tells of the axis counts
    bool contradicts = false;  ///< it was left out because of what it tells of the axis
    Motion motion;             ///< to where its axis and height are those of all
};

struct JoinedSherds {
    Mesh mesh;
    std::vector<std::vector<Index>> of_fragment;  ///< faces that are not of a break, sherd by sherd
    [[nodiscard]] std::vector<Index> faces() const;
    [[nodiscard]] std::vector<bool> broken() const;  ///< of each face of the mesh
};

/// The sherds for which `take` is true, moved; of the others no face.
JoinedSherds joined(const std::vector<LaidSherd>& sherds, const std::vector<bool>& take);

/// The axis of all sherds that are not left out, and how each has to be moved so that its own is that: fills in axis, errors and
/// sherds of the template, and the motions. Leaves out what tells nothing or contradicts the others. Throws Error (input) where
/// no sherd is left.
void find_common_axis(std::vector<LaidSherd>& sherds, const RevolutionOptions& options, RevolutionTemplate& result);

void leave_out(SherdOnProfile& sherd, const std::string& reason, const std::string& remedy = {});
/// Error (input) that names each sherd and why it is left out.
[[noreturn]] void fail_all_left_out(const RevolutionTemplate& result);

struct WallSection {
    detail::ProfileImage image;
    std::vector<double> tops;  ///< in each direction: the highest wall, above the lowest row; none: -1

    /// Heights with too little wall do not count.
    void drop_rare(const RevolutionOptions& options);
    /// A rim: where there is wall near the top, it ends at one height.
    [[nodiscard]] bool has_rim(const RevolutionOptions& options) const;
};

/// How much of the wall rays from the axis meet, by height and radius. A ray that leaves the clay, or enters it, by a break
/// (`broken` of its face, or a normal far from the plane through the axis) does not tell whether there was wall beyond.
WallSection wall_section(const SurfaceSearch& search, const std::vector<bool>& broken, const AxisFrame& frame, double low,
                         double high, double far, const RevolutionOptions& options);

/// Rings of vertices around the axis, each with as many as its size asks for, sewn together.
class ProfileSweep {
public:
    /// Heights are above `lowest`; the triangles' edges are about as long as `edge`.
    ProfileSweep(const AxisFrame& frame, double lowest, double edge) : frame_(frame), lowest_(lowest), edge_(edge) {}

    /// At this radius and height; one vertex where the radius is 0.
    void ring(const Eigen::Vector2d& at);
    /// Triangles between two rings.
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

/// The rings of vertices of the template, one a point of its profile.
struct ProfileRings {
    std::vector<std::vector<Vertex>> vertices;
    std::vector<std::size_t> of_vertex;
};

/// Regions "outer", "inner", "base", lines "rim" or "upper end", "widest girth", "foot", points "base centre", "floor centre",
/// and the axis, whose foot is `lowest` above that of the frame.
void annotate_revolution(RevolutionTemplate& result, const AxisFrame& frame, double lowest, const ProfileRings& made);

}  // namespace ostraka
