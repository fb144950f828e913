// Diffusion on a surface: Gaussian smoothing of a given standard deviation (a length), independent of the triangulation.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <Eigen/Geometry>

#include <memory>

namespace ostraka {

/// The heat equation on a mesh, M dx/dt = -L x, with the cotangent Laplacian L (Pinkall and Polthier 1993; negative weights are
/// set to zero to avoid overshoots) and the diagonal mass matrix M (each face gives a third of its area to each corner). After
/// the time s^2 / 2, a point source has become a Gaussian of standard deviation s. Border vertices are fixed.
class Diffusion {
public:
    explicit Diffusion(const Mesh& mesh);
    ~Diffusion();
    Diffusion(Diffusion&&) noexcept;

    /// Smooths `values` (one row per vertex) approximately by a Gaussian of standard deviation `sigma` (in the mesh's unit; 0
    /// changes nothing), in `steps` equal steps of backward Euler. Costs one sparse factorisation. Throws Error (usage) if sigma
    /// is negative or not finite, or if the number of rows is not the number of vertices.
    [[nodiscard]] Eigen::MatrixXd smoothed(const Eigen::MatrixXd& values, double sigma, int steps = 1) const;

private:
    struct System;
    std::unique_ptr<System> system_;
};

/// Vertex positions of a mesh, one per row.
Eigen::MatrixXd positions(const Mesh& mesh);
void set_positions(Mesh& mesh, const Eigen::MatrixXd& places);  ///< one row per vertex

}  // namespace ostraka
