// Evidence of a part on an approximately known axis of rotation: the best correction, with its information matrix.
#pragma once

#include "ostraka/axis/axis.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace ostraka {

/// A line at which the evidence is evaluated, with two orthogonal unit vectors across it that define the directions of steps.
struct AxisGuess {
    Eigen::Vector3d point, direction, u, w;
};

struct AxisEvidence {
    double round = 0;     ///< share of the area consistent with the axis: on the profile about it, with normals that meet it
    double residual = 0;  ///< standard deviation from that profile after the best step, in the mesh's unit
    double samples = 0;   ///< effective number of independent samples of the surface
    Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< point of the line nearest to the part's centroid: origin of the steps
    /// Normal equations: the best step solves `information` x step = -`gradient`; `information` is its inverse covariance. A
    /// step translates the line along u and w, in the mesh's unit, and tilts it towards u and w, in radians.
    Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
    Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
};

/// A part prepared once for queries with many lines.
class AxisEvidenceEvaluator {
public:
    /// Throws Error (input) if there are no faces with area, (usage) for options out of range.
    AxisEvidenceEvaluator(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& options = {});
    ~AxisEvidenceEvaluator();
    AxisEvidenceEvaluator(AxisEvidenceEvaluator&&) noexcept;

    /// The equations by which `rotation_axis` refines an axis, weighted by the variance of the distance from the profile.
    /// Correlated deviations of neighbouring samples (a wall that is not quite round) count once, by the ratio of the variance
    /// of patch means to that of single samples. `round` is small for parts that are no surface of revolution about any nearby
    /// line.
    [[nodiscard]] AxisEvidence at(const AxisGuess& guess) const;

    /// Whether there are enough faces for `at`.
    [[nodiscard]] bool enough() const;
    [[nodiscard]] const Eigen::Vector3d& centroid() const;
    [[nodiscard]] double area() const;
    [[nodiscard]] double diagonal() const;  ///< diagonal of the part's bounding box

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
