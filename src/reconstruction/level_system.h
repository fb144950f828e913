// The linear system of a fit's levels on one mesh of the template: made once, used by every fit.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/solver/solve.h"

#include <memory>
#include <vector>

namespace ostraka {

/// Each vertex's neighbours at rest with their cotangent weights, and the area around it.
struct Rings {
    std::vector<std::size_t> begin;
    std::vector<int> neighbour;
    std::vector<double> weight;
    std::vector<double> area, sum;  ///< area around each vertex; sum of its weights
};

/// How the surroundings of each vertex have rotated: the nearest rotation over two rings.
std::vector<Eigen::Matrix3d> local_rotations(const Rings& rings, const Points& rest, const Points& now);

/// How many times as large the surroundings of each vertex are now as at rest: root mean square of the edges within three rings,
/// from 0.5 to 2. Edges around vertices that were not observed count as if they had grown as all that was observed did: a size
/// that the solution gave to them says nothing of them, and would be carried on from there.
std::vector<double> local_scales(const Rings& rings, const Points& rest, const Points& now, const std::vector<bool>& observed);

/// What the three costs of equation 5.2 are made of, over the vertices of a mesh. Nothing here depends on fragments.
class LevelSystem {
public:
    /// The mesh outlives it and does not change.
    explicit LevelSystem(const Mesh& of);

    const Mesh& mesh;
    Points rest;
    Rings rings;
    double mean_area = 1;  ///< of the areas around vertices
    /// Positions in the solver of what draws a vertex to a place, to where it was, and to its Laplacian displacement.
    [[nodiscard]] std::size_t match(std::size_t vertex) const { return match_[vertex]; }
    [[nodiscard]] std::size_t stay(std::size_t vertex) const { return stay_[vertex]; }
    [[nodiscard]] std::size_t laplacian(std::size_t vertex) const { return laplacian_[vertex]; }  ///< no_constraint: isolated
    static constexpr std::size_t no_constraint = static_cast<std::size_t>(-1);

    /// The solver for a new fit, whose weights have yet to be set. Of an earlier one the order of the unknowns and the symbolic
    /// factorisation are kept, which depend on the mesh alone, and no numbers: results are those of a new solver to the bit.
    Solver& renewed_solver();

    /// The constraints of a solver, in the positions above; matches weigh nothing yet.
    std::vector<std::unique_ptr<Constraint>> constraints();

private:
    std::vector<std::size_t> match_, stay_, laplacian_;
    std::unique_ptr<MeshSpaceSolver> solver_;
};

}  // namespace ostraka
