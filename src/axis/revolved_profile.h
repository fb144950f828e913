// The profile of a part about a line, and the step of the line that makes the part rounder about it.
#pragma once

#include "axis/axis_methods.h"

#include <cstddef>
#include <vector>

namespace ostraka::detail {

/// A surface sample in the part's own frame (centroid at the origin, diagonal 1), with its normal and area.
struct RoundSample {
    Vector3d p, n;
    double weight;
};

struct AxisLine {
    Vector3d point = Vector3d::Zero(), direction = Vector3d::UnitZ();
};

/// Samples with vertex normals averaged `rounds` times over edges of the part: one per face, or 8000 spread by area.
std::vector<RoundSample> take_samples(const Mesh& mesh, const std::vector<Index>& faces, int rounds, const Vector3d& centre,
                                      double scale);

/// Sine of the angle between the normal and the plane through the axis and the point; 0 on the axis.
double sine(const RoundSample& s, const AxisLine& axis);

/// The revolved profile: heights in bins, separate for the two walls of a hollow part, with radius = R + S (height - mean) in
/// each.
struct RevolvedProfile {
    struct Bin {
        double weight = 0, height = 0, radius = 0, slope = 0;
        double hh = 0, hr = 0;
        std::vector<std::size_t> members;
    };
    std::vector<Bin> bins;
    std::vector<int> bin_of;  ///< -1: on faces across the axis, or too close to it
    std::vector<double> height, radius, error, robust;
    double sigma = 0;

    RevolvedProfile(const std::vector<RoundSample>& samples, const AxisLine& axis);

private:
    void fit(const std::vector<RoundSample>& samples, bool first);
};

/// Normal equations of two translations and two tilts of the axis along `u` and `w`, with each bin's radius and slope
/// eliminated.
struct AxisRefinement {
    Eigen::Matrix4d H = Eigen::Matrix4d::Zero();
    Eigen::Vector4d g = Eigen::Vector4d::Zero();
    double weight = 0, squares = 0, radius = 0, count = 0;
    Vector3d u, w;

    AxisRefinement(const std::vector<RoundSample>& samples, const AxisLine& axis, const RevolvedProfile& profile);
    AxisRefinement(const std::vector<RoundSample>& samples, const AxisLine& axis, const RevolvedProfile& profile,
                   const Vector3d& u, const Vector3d& w);
    /// Per sample: derivative of its distance from the profile with respect to a step of the axis; zero if the sample is
    /// unused.
    std::vector<Eigen::Vector4d> rows;

    /// Variance of the translation of the axis along a vector across it, tilts free, for unit weight and noise.
    [[nodiscard]] double radius_uncertainty(const Eigen::Vector2d& along) const;
    /// Smallest eigenvalue of the translations, for unit weight: a half for a full circle, little for a short arc.
    [[nodiscard]] double shift_information() const;
    /// Smallest eigenvalue of the tilts with the translations eliminated, for unit weight: 0 if a tilt has no effect.
    [[nodiscard]] double tilt_information() const;
};

}  // namespace ostraka::detail
