// The linear system of a fit's levels on one mesh of the template: built once, used by every fit.
#pragma once

#include "ostraka/mesh/mesh.h"
#include "ostraka/solver/solve.h"

#include <memory>
#include <vector>

namespace ostraka {

/// Each vertex's neighbours at rest with their cotangent weights, and its area.
struct Rings {
    std::vector<std::size_t> begin;
    std::vector<int> neighbour;
    std::vector<double> weight;
    std::vector<double> area, sum;  ///< area around each vertex; sum of its weights
};

/// Rotation of the surroundings of each vertex: the nearest rotation over two rings.
std::vector<Eigen::Matrix3d> local_rotations(const Rings& rings, const Points& rest, const Points& current);

/// Scale of the surroundings of each vertex relative to rest: root mean square of the edges within three rings, from 0.5 to 2.
/// Edges around unobserved vertices have the mean scale of all observed ones: their size in the solution is not evidence, and
/// would propagate.
std::vector<double> local_scales(const Rings& rings, const Points& rest, const Points& current,
                                 const std::vector<bool>& observed);

/// The terms of the three costs of equation 5.2, over the vertices of a mesh. Independent of fragments.
class LevelSystem {
public:
    /// The mesh must outlive it unchanged.
    explicit LevelSystem(const Mesh& template_mesh);

    const Mesh& mesh;
    Points rest;
    Rings rings;
    double mean_area = 1;  ///< of the areas around vertices
    /// Indices of the solver's constraints that attract a vertex to a point, to its earlier position, and to its Laplacian
    /// displacement.
    [[nodiscard]] std::size_t match(std::size_t vertex) const { return match_[vertex]; }
    [[nodiscard]] std::size_t stay(std::size_t vertex) const { return stay_[vertex]; }
    [[nodiscard]] std::size_t laplacian(std::size_t vertex) const { return laplacian_[vertex]; }  ///< no_constraint: isolated
    static constexpr std::size_t no_constraint = static_cast<std::size_t>(-1);

    /// The solver for a new fit, whose weights are not set yet. Keeps the fill-reducing order and the symbolic factorisation of
    /// an earlier fit, which depend on the mesh alone, but no numbers: results equal those of a new solver to the bit.
    Solver& renewed_solver();

    /// The constraints of a solver, with the indices above; matches have weight 0.
    std::vector<std::unique_ptr<Constraint>> constraints();

private:
    std::vector<std::size_t> match_, stay_, laplacian_;
    std::unique_ptr<MeshSpaceSolver> solver_;
};

}  // namespace ostraka
