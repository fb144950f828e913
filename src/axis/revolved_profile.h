// The profile of a part about a line, and the step of the line that makes the part closer to a surface of revolution.
#pragma once

#include "axis/axis_methods.h"

#include <cstddef>
#include <vector>

namespace ostraka::detail {

/// A surface sample in the part's own frame (centroid at the origin, diagonal 1), with its normal and area.
struct RoundSample {
    Vector3d p, n;  ///< position; unit normal
    double weight;  ///< area of the surface that the sample represents
};

/// A candidate axis in the frame of the part.
struct AxisLine {
    Vector3d point = Vector3d::Zero(), direction = Vector3d::UnitZ();
};

/// What is known about a part before its posterior is sampled.
struct RotationSearch {
    Axis axis;                         ///< axis with its figures, or the reason why there is none
    bool determined = false;           ///< true: most of the surface is on a profile revolved about `line`
    bool sphere = false;               ///< true: the surface resembles a part of a sphere
    AxisLine line;                     ///< best line in the frame of the part
    std::vector<RoundSample> samples;  ///< samples of the surface in the frame of the part
    Vector3d centroid = Vector3d::Zero();
    double scale = 1;  ///< diagonal of the part
};
/// The axis in a given direction that the normals of the samples meet best.
AxisLine axis_along(const std::vector<RoundSample>& samples, const Vector3d& direction);
/// The search of `rotation_axis`.
RotationSearch search_rotation(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options);

/// Surface samples, one per face or 8000 spread by area; their normals come from vertex normals averaged `rounds` times over
/// edges of the part.
std::vector<RoundSample> take_samples(const Mesh& mesh, const std::vector<Index>& faces, int rounds, const Vector3d& centre,
                                      double scale);

/// Sine of the angle between a sample's normal and the plane through the axis and the sample; 0 for a sample on the axis.
double sine(const RoundSample& s, const AxisLine& axis);

/// The profile revolved about a line, as bins of height, separate for the two walls of a hollow part. In each bin the radius is a
/// linear function of the height.
struct RevolvedProfile {
    struct Bin {
        /// Total weight; mean height; radius at the mean height; slope of the radius.
        double weight = 0, height = 0, radius = 0, slope = 0;
        /// Weighted sums of squared heights, and of heights times radii, about their means.
        double hh = 0, hr = 0;
        std::vector<std::size_t> members;  ///< indices of the samples
    };
    std::vector<Bin> bins;    ///< one per bin of height and wall
    std::vector<int> bin_of;  ///< for each sample: its bin; -1 for samples that face along the axis
    /// Per sample: height, radius, distance from the profile, robust weight.
    std::vector<double> height, radius, error, robust;
    double sigma = 0;  ///< robust standard deviation of the distances from the profile

    RevolvedProfile(const std::vector<RoundSample>& samples, const AxisLine& axis);

private:
    void fit(const std::vector<RoundSample>& samples, bool first);
};

/// Normal equations of two translations and two tilts of the axis along `u` and `w`, with each bin's radius and slope
/// eliminated.
struct AxisRefinement {
    Eigen::Matrix4d H = Eigen::Matrix4d::Zero();  ///< normal matrix
    Eigen::Vector4d g = Eigen::Vector4d::Zero();  ///< right-hand side: gradient
    /// Total weight; weighted sum of squares; mean radius; effective number of samples.
    double weight = 0, squares = 0, radius = 0, count = 0;
    Vector3d u, w;  ///< unit vectors across the axis, the directions of steps

    AxisRefinement(const std::vector<RoundSample>& samples, const AxisLine& axis, const RevolvedProfile& profile);
    AxisRefinement(const std::vector<RoundSample>& samples, const AxisLine& axis, const RevolvedProfile& profile,
                   const Vector3d& u, const Vector3d& w);
    /// For each sample: derivative of its distance from the profile with respect to a step of the axis; zero for unused samples.
    std::vector<Eigen::Vector4d> rows;

    /// Variance of the axis's translation along the combination `along` of u and w, with free tilts, for unit weight and unit
    /// noise.
    [[nodiscard]] double radius_uncertainty(const Eigen::Vector2d& along) const;
    /// Smallest eigenvalue of the translation block, for unit weight: 0.5 for a full circle, close to 0 for a short arc.
    [[nodiscard]] double shift_information() const;
    /// Smallest eigenvalue of the tilt block after elimination of the translations, for unit weight: 0 if some tilt has no
    /// effect.
    [[nodiscard]] double tilt_information() const;
};

}  // namespace ostraka::detail
