// The linear system of a fit's levels on one mesh of the template; it is built once and used by every fit.
#pragma once

#include "ostraka/mesh/mesh.h"
#include "ostraka/solver/solve.h"

#include <memory>
#include <vector>

namespace ostraka {

/// Neighbours of each vertex with their cotangent weights at rest; the neighbours of vertex v are at indices begin[v] to begin[v
/// + 1] - 1.
struct Rings {
    std::vector<std::size_t> begin;  ///< for each vertex, index of its first neighbour
    std::vector<int> neighbour;      ///< indices of vertices
    std::vector<double> weight;      ///< cotangent weight of each entry of `neighbour`
    std::vector<double> area, sum;   ///< for each vertex: area around it; sum of its weights
};

/// For each vertex, the rotation of its neighbourhood from rest to the current positions: best fit over two rings.
std::vector<Eigen::Matrix3d> local_rotations(const Rings& rings, const Points& rest, const Points& current);

/// For each vertex, the scale of its neighbourhood relative to rest, from 0.5 to 2: ratio of the root mean squares of the edge
/// lengths within three rings. Edges around unobserved vertices count with the mean scale of all observed vertices, since their
/// length in the solution is not evidence.
std::vector<double> local_scales(const Rings& rings, const Points& rest, const Points& current,
                                 const std::vector<bool>& observed);

/// The terms of the three costs of equation 5.2 over the vertices of a mesh, independent of fragments.
class LevelSystem {
public:
    /// `template_mesh` must outlive the system unchanged.
    explicit LevelSystem(const Mesh& template_mesh);

    const Mesh& mesh;
    Points rest;           ///< positions of the vertices at rest
    Rings rings;           ///< neighbours of each vertex
    double mean_area = 1;  ///< mean of the areas around vertices
    /// Indices of the solver's constraints that attract a vertex to its match, to its earlier position, and to its Laplacian
    /// displacement.
    [[nodiscard]] std::size_t match(std::size_t vertex) const { return match_[vertex]; }
    [[nodiscard]] std::size_t stay(std::size_t vertex) const { return stay_[vertex]; }
    /// Index of the Laplacian constraint of a vertex; no_constraint if the vertex is isolated.
    [[nodiscard]] std::size_t laplacian(std::size_t vertex) const { return laplacian_[vertex]; }
    static constexpr std::size_t no_constraint = static_cast<std::size_t>(-1);  ///< index of no constraint

    /// The solver for a new fit, without weights. Keeps the fill-reducing order and the symbolic factorisation of an earlier fit,
    /// which depend on the mesh alone, but no numbers: results equal the results of a new solver to the bit.
    Solver& renewed_solver();

    /// Constraints of a solver, at the indices that `match`, `stay` and `laplacian` return; match constraints have weight 0.
    std::vector<std::unique_ptr<Constraint>> constraints();

private:
    /// For each vertex, the indices of its constraints.
    std::vector<std::size_t> match_, stay_, laplacian_;
    std::unique_ptr<MeshSpaceSolver> solver_;
};

}  // namespace ostraka
