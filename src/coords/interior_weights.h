// Weights at the nodes of the tetrahedra inside a cage.
#pragma once

#include "coords/bounded_rows.h"
#include "coords/cage_interior.h"

namespace ostraka::coords {

/// Volumes and gradients of the linear (hat) functions of the tetrahedra.
struct CellGradients {
    std::vector<double> volume;  ///< one per tetrahedron
    /// Per tetrahedron: gradient of the hat function of each corner.
    std::vector<std::array<Eigen::Vector3d, 4>> of_corner;
};
CellGradients gradients_of(const CageInterior& inside);  ///< per tetrahedron

/// Boundary values of the weights, one row per node: linear on the cage, zero at interior nodes.
WeightMatrix weights_on_cage(const CageInterior& inside, const UnitCage& cage);

/// Harmonic weights, one row per node: linear on the cage, and harmonic in the interior (linear finite elements). Takes one
/// sparse factorisation and one solve per cage vertex. Each row sums to one and reproduces the position of its node; some weights
/// may be slightly negative.
WeightMatrix harmonic_weights(const CageInterior& inside, const UnitCage& cage);

/// Coordinates that are linear in each tetrahedron inside the cage; `weights_of` returns one row per node. `weights_of` is called
/// only if at least one point does not lie on the cage.
Coordinates interior_coordinates(const std::string& kind, const Mesh& mesh, const std::vector<Point>& points,
                                 const CoordinateOptions& options,
                                 const std::function<WeightMatrix(const CageInterior&, const UnitCage&)>& weights_of);

}  // namespace ostraka::coords
