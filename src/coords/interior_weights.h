// Weights at the nodes of tetrahedra inside a cage.
#pragma once

#include "bounded_rows.h"
#include "cage_interior.h"

namespace ostraka::coords {

/// Of each tetrahedron its volume and the gradients of the hat functions of its corners.
struct CellGradients {
    std::vector<double> volume;
    std::vector<std::array<Eigen::Vector3d, 4>> of_corner;
};
CellGradients gradients_of(const CageInterior& inside);

/// A row a node: linear on the cage, zero within it.
WeightMatrix weights_on_cage(const CageInterior& inside, const UnitCage& cage);

/// A row a node: on the cage linear, within it harmonic by linear finite elements. One sparse factorisation, one solve a cage
/// vertex. Rows sum to one and give their node; some weights may be a little below zero.
WeightMatrix harmonic_weights(const CageInterior& inside, const UnitCage& cage);

/// Coordinates that are linear in each tetrahedron inside the cage: `weights_of` gives a row a node. It is asked only where a
/// point does not lie on the cage.
Coordinates interior_coordinates(const std::string& kind, const Mesh& mesh, const std::vector<Point>& points,
                                 const CoordinateOptions& options,
                                 const std::function<WeightMatrix(const CageInterior&, const UnitCage&)>& weights_of);

}  // namespace ostraka::coords
