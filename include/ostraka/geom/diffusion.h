// Diffusion over a surface: smoothing whose strength is a length, whatever the triangles.
#pragma once

#include "ostraka/core/mesh.h"

#include <Eigen/Geometry>

#include <memory>

namespace ostraka {

/// The heat equation on a mesh, M dx/dt = -L x with the cotangent Laplacian L (Pinkall and Polthier 1993; negative weights count
/// as zero, so that nothing overshoots) and a third of the faces' areas as M. After the time s^2 / 2 a point is spread like a
/// Gaussian of standard deviation s. Border vertices stay as they are.
class Diffusion {
public:
    explicit Diffusion(const Mesh& mesh);
    ~Diffusion();
    Diffusion(Diffusion&&) noexcept;

    /// One row a vertex, diffused as by a Gaussian of standard deviation `sigma` (in the mesh's unit; 0 changes nothing), in
    /// `steps` equal steps of backward Euler. Time: one sparse factorisation. Throws Error (usage) if sigma is negative or not
    /// finite, or the rows are not the vertices.
    [[nodiscard]] Eigen::MatrixXd smoothed(const Eigen::MatrixXd& values, double sigma, int steps = 1) const;

private:
    struct System;
    std::unique_ptr<System> system_;
};

/// The vertices' places, one a row.
Eigen::MatrixXd positions(const Mesh& mesh);
void set_positions(Mesh& mesh, const Eigen::MatrixXd& places);

}  // namespace ostraka
