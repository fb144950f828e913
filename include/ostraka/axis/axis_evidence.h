// What a part tells of an axis of rotation that is known nearly: where it would move it, and how surely.
#pragma once

#include "ostraka/axis/axis.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace ostraka {

/// A line near which evidence is asked for, with two unit vectors across it that name the directions of steps.
struct AxisGuess {
    Eigen::Vector3d point, direction, u, w;
};

struct AxisEvidence {
    double round = 0;     ///< share of the area that the line can be an axis of: on the profile about it, normals that meet it
    double residual = 0;  ///< standard deviation from that profile after the best step, in the mesh's unit
    double samples = 0;   ///< independent places on the surface that this rests on
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< of the line, next to the part's centroid: steps are about it
    /// Normal equations: `information` x step = -`gradient` is solved by the best step, whose inverse covariance is
    /// `information`. A step shifts the line along u and w, in the mesh's unit, and tilts it towards u and w, in radians.
    Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
    Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
};

/// A part prepared once, asked about many lines.
class AxisWitness {
public:
    /// Throws Error (input) if there are no faces with area, (usage) for options out of range.
    AxisWitness(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options = {});
    ~AxisWitness();
    AxisWitness(AxisWitness&&) noexcept;

    /// The equations that `rotation_axis` refines an axis by, weighted by what lies off the profile: deviations that neighbouring
    /// places share (a wall that is not quite round) count once, by the ratio of the variance of means over patches to that of
    /// single places. Parts that are no surface of revolution about any line near give little `round`.
    [[nodiscard]] AxisEvidence at(const AxisGuess& guess) const;

    /// Enough faces for `at`.
    [[nodiscard]] bool enough() const;
    [[nodiscard]] const Eigen::Vector3d& centroid() const;
    [[nodiscard]] double area() const;
    [[nodiscard]] double diagonal() const;  ///< of the part's bounding box

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
