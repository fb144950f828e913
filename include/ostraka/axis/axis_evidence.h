// What one part of an object says about an approximately known axis of rotation: least-squares correction and information matrix.
#pragma once

#include "ostraka/axis/axis.h"

#include <Eigen/Core>

#include <memory>
#include <vector>

namespace ostraka {

/// A candidate axis at which the evidence is evaluated.
struct AxisGuess {
    /// Point and unit direction of the line; u, w: orthogonal unit vectors across the line, the directions of steps.
    Eigen::Vector3d point, direction, u, w;
};

/// How well a line fits a part as axis of rotation, and how to improve the line.
struct AxisEvidence {
    /// Fraction of the area that is consistent with the axis: on the profile revolved about the axis, with normals that meet the
    /// axis.
    double round = 0;
    /// Standard deviation of the distances from the profile after the least-squares step, in the mesh's unit.
    double residual = 0;
    double samples = 0;  ///< effective number of independent samples of the surface
    /// The point of the line closest to the part's centroid: origin of the steps.
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    /// Normal equations: the least-squares step solves `information` * step = -`gradient`; `information` is the inverse
    /// covariance of the step. A step translates the line along u and w (in the mesh's unit) and tilts the line towards u and w
    /// (in radians).
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

    /// Normal equations by which `rotation_axis` refines an axis, weighted by the variance of the distance from the profile.
    /// Correlated deviations of neighbouring samples (a wall that is not quite round) count once, by the ratio of the variance of
    /// patch means to the variance of single samples. The member `round` is small for a part that is not a surface of revolution
    /// about any line near the guess.
    [[nodiscard]] AxisEvidence at(const AxisGuess& guess) const;

    /// True if the part has enough faces for `at`.
    [[nodiscard]] bool enough() const;
    [[nodiscard]] const Eigen::Vector3d& centroid() const;  ///< centroid of the part
    [[nodiscard]] double area() const;                      ///< area of the part
    [[nodiscard]] double diagonal() const;                  ///< diagonal of the part's bounding box

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
