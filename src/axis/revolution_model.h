// Probability of the points of a wall for a given axis of revolution: profiles are smooth curves, vessels are slightly out of
// round, and both are integrated out.
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace ostraka::detail {

/// Vertices of a wall in a frame with the centroid at the origin and diagonal 1, with unit normals and the edges between them.
struct WallVertices {
    std::vector<Eigen::Vector3d> points, normals;
    std::vector<std::pair<std::size_t, std::size_t>> edges;
};

/// A straight line in space: a point and a unit direction.
struct SpaceLine {
    Eigen::Vector3d point = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::UnitZ();
};

/// Mean of a few neighbouring vertices on one sheet of the wall.
struct WallCell {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< mean in cylindrical coordinates about the axis of the last grouping
    double count = 0;                             ///< number of vertices
    std::size_t sheet = 0;                        ///< index of the sheet
};

/// A connected part of the wall whose normals in the half-plane of the axis lie within a quarter turn: outer side, inner side,
/// lip or floor. Its profile is the graph of a cubic spline over the tangent of the mean normal.
struct WallSheet {
    double angle = 0;     ///< angle of the mean normal: 0 away from the axis, a quarter turn along the axis
    double vertices = 0;  ///< number of vertices
    bool wall = false;    ///< true: part of the outer or inner side, not of a lip or floor
    int knots = 8;        ///< number of coefficients of the spline
    double sigma = 1;     ///< standard deviation of the noise of a vertex
    bool used = true;     ///< false: not round about the axis of the rest
};

/// Steps of the axis from a reference axis: curvature of the parallels, displacement aside, tilt towards the wall, tilt aside;
/// for more than a third of a circle two displacements and two tilts.
using AxisStep = Eigen::Vector4d;

/// Sum of squares, with the profiles and the deviations from roundness at their best, and its derivatives.
struct RevolutionFit {
    double squares = 0;  ///< weighted sum of squares
    /// Expected mean deviation from roundness over the arc, as a share of the radius: at the middle of the height, and its change
    /// over half the height; and the lower root of their covariance.
    Eigen::Vector2d deviation = Eigen::Vector2d::Zero();
    Eigen::Matrix2d deviation_root = Eigen::Matrix2d::Zero();
    double log_volume = 0;  ///< minus half the logarithm of the volume that the deviations from roundness lose
    Eigen::Matrix4d H = Eigen::Matrix4d::Zero();  ///< normal matrix, with profiles and deviations integrated out
    Eigen::Vector4d g = Eigen::Vector4d::Zero();  ///< half the gradient of the sum of squares
};

/// Levels of roundness that are compared: amplitude of the deviation as a share of the radius, and prior probability.
struct RoundnessLevel {
    double amplitude, prior;
};

class RevolutionModel {
public:
    /// Groups vertices into sheets, and sheets into at most about `max_cells` cells, about a line. `max_sine`: a vertex whose
    /// normal leaves the half-plane of the axis by more belongs to no sheet.
    RevolutionModel(const WallVertices& vertices, const SpaceLine& line, std::size_t max_cells, double max_sine = 0.35);

    /// False if there are too few vertices on walls.
    [[nodiscard]] bool enough() const;
    /// The line at a step from the reference. A negative curvature places the axis on the other side of the wall.
    [[nodiscard]] SpaceLine line(const AxisStep& step) const;
    /// The step of a line (inverse of `line`).
    [[nodiscard]] AxisStep step(const SpaceLine& line) const;
    /// Whether the first entry of a step is a curvature.
    [[nodiscard]] bool short_arc() const { return short_arc_; }

    /// Fits at a step, one for each amplitude of out-of-roundness; derivatives if required.
    [[nodiscard]] std::vector<RevolutionFit> fit(const AxisStep& step, const std::vector<RoundnessLevel>& levels,
                                                 bool derivatives) const;
    /// Estimates noise, slopes and robust weights at a step with the given amplitude; drops sheets that are not round.
    void weigh(const AxisStep& step, double amplitude);

    /// Signed radius of a cell about the line at a step: negative if the axis is on the other side of the wall.
    [[nodiscard]] std::vector<double> radii(const AxisStep& step) const;
    [[nodiscard]] std::vector<double> heights(const AxisStep& step) const;
    /// A height from -1 at one end of the wall to 1 at the other.
    [[nodiscard]] double relative_height(double height) const { return (height - middle_height_) / half_height_; }
    [[nodiscard]] const std::vector<WallCell>& cells() const { return cells_; }
    [[nodiscard]] const std::vector<WallSheet>& sheets() const { return sheets_; }
    [[nodiscard]] const std::vector<double>& residuals() const { return residuals_; }
    [[nodiscard]] const std::vector<double>& robust() const { return robust_; }
    /// Ratio of the variance of means over patches to the variance expected of independent noise, at least 1.
    [[nodiscard]] double correlation() const { return correlation_; }
    [[nodiscard]] const std::vector<std::size_t>& cell_of_vertex() const { return cell_of_vertex_; }
    [[nodiscard]] double arc() const { return arc_; }  ///< angle covered by the wall about the reference line

private:
    static constexpr int extras = 14;  ///< deviations from roundness: linear parameters

    struct Chart;
    void make_sheets(const WallVertices& vertices, double max_sine);
    void make_cells(const WallVertices& vertices, std::size_t max_cells);
    void make_frame();
    [[nodiscard]] Chart chart(const AxisStep& step) const;
    [[nodiscard]] double cell_weight(std::size_t cell) const;
    [[nodiscard]] std::vector<double> profile_slopes(const Chart& at) const;
    [[nodiscard]] std::vector<double> chart_derivatives(const AxisStep& x) const;
    void update_noise(const std::vector<std::vector<double>>& errors, bool select_sheets);
    void average_extras(const Chart& at);
    void estimate_correlation(const Chart& at, double amplitude);

    SpaceLine reference_;
    bool short_arc_ = true;
    double arc_ = 0;
    Eigen::Vector3d place_, normal_, tangent_, around_;  ///< frame on the wall
    double frame_angle_ = 0, curvature_ = 0;
    std::vector<WallSheet> sheets_;
    std::vector<std::size_t> sheet_of_vertex_, cell_of_vertex_;
    std::vector<WallCell> cells_;
    std::vector<double> slope_, robust_, residuals_;
    std::array<double, extras> mean_extra_{};  ///< mean of unit deviations over the arc
    double correlation_ = 1;
    double middle_height_ = 0, half_height_ = 1;
};

}  // namespace ostraka::detail
