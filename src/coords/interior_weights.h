// Weights at the nodes of the tetrahedra inside a cage.
#pragma once

#include "coords/bounded_rows.h"
#include "coords/cage_interior.h"

namespace ostraka::coords {

/// For each tetrahedron its volume and the gradients of the hat functions of its corners.
struct CellGradients {
    std::vector<double> volume;
    std::vector<std::array<Eigen::Vector3d, 4>> of_corner;
};
CellGradients gradients_of(const CageInterior& inside);

/// Weights at the nodes, one row per node: linear on the cage, zero in the interior.
WeightMatrix weights_on_cage(const CageInterior& inside, const UnitCage& cage);

/// Harmonic weights, one row per node: linear on the cage, in the interior harmonic by linear finite elements. One sparse
/// factorisation, one solve per cage vertex. Rows sum to one and reproduce their node; some weights may be slightly negative.
WeightMatrix harmonic_weights(const CageInterior& inside, const UnitCage& cage);

/// Coordinates that are linear in each tetrahedron inside the cage; `weights_of` returns one row per node. It is called only if
/// there is a point that does not lie on the cage.
Coordinates interior_coordinates(const std::string& kind, const Mesh& mesh, const std::vector<Point>& points,
                                 const CoordinateOptions& options,
                                 const std::function<WeightMatrix(const CageInterior&, const UnitCage&)>& weights_of);

}  // namespace ostraka::coords
