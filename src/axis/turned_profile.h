// The profile that a part has about a line, and how the line has to move for the part to be rounder about it.
#pragma once

#include "axis_methods.h"

#include <cstddef>
#include <vector>

namespace ostraka::detail {

/// A point of the surface, in the part's own frame (centroid at the origin, diagonal 1), with its normal and area.
struct RoundSample {
    Vector3d p, n;
    double weight;
};

struct AxisLine {
    Vector3d point = Vector3d::Zero(), direction = Vector3d::UnitZ();
};

/// Vertex normals of the part, averaged `rounds` times over edges of the part; then one sample a face, or 8000 spread by area.
std::vector<RoundSample> take_samples(const Mesh& mesh, const std::vector<Index>& faces, int rounds, const Vector3d& centre,
                                      double scale);

/// Sine of the angle between the normal and the plane through the axis and the point; 0 on the axis.
double sine(const RoundSample& s, const AxisLine& axis);

/// The turned profile: heights in bins, the two walls of a hollow part apart, radius = R + S (height - mean) in each.
struct TurnedProfile {
    struct Bin {
        double weight = 0, height = 0, radius = 0, slope = 0;
        double hh = 0, hr = 0;
        std::vector<std::size_t> members;
    };
    std::vector<Bin> bins;
    std::vector<int> bin_of;  ///< -1: faces along the axis, or next to it
    std::vector<double> height, radius, error, robust;
    double sigma = 0;

    TurnedProfile(const std::vector<RoundSample>& samples, const AxisLine& axis);

private:
    void fit(const std::vector<RoundSample>& samples, bool first);
};

/// Normal equations of two shifts and two tilts of the axis along `u` and `w`, each bin's radius and slope eliminated.
struct AxisRefinement {
    Eigen::Matrix4d H = Eigen::Matrix4d::Zero();
    Eigen::Vector4d g = Eigen::Vector4d::Zero();
    double weight = 0, squares = 0, radius = 0, count = 0;
    Vector3d u, w;

    AxisRefinement(const std::vector<RoundSample>& samples, const AxisLine& axis, const TurnedProfile& profile);
    AxisRefinement(const std::vector<RoundSample>& samples, const AxisLine& axis, const TurnedProfile& profile, const Vector3d& u,
                   const Vector3d& w);
    /// Of each sample: what a step of the axis changes of its distance from the profile; zero where it does not count.
    std::vector<Eigen::Vector4d> rows;

    /// Variance of the shift of the axis along a vector across it, tilts free, for unit weight and noise.
    [[nodiscard]] double radius_uncertainty(const Eigen::Vector2d& along) const;
    /// Least eigenvalue of the shifts, for unit weight: a half of a full turn, little of a short arc.
    [[nodiscard]] double shift_information() const;
    /// Least eigenvalue of the tilts with the shifts eliminated, for unit weight: 0 where a tilt changes nothing.
    [[nodiscard]] double tilt_information() const;
};

}  // namespace ostraka::detail
