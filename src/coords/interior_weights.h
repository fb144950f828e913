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

/// Adds the weights at a place to a row, linear in its tetrahedron.
void interpolate(const CageInterior& inside, const WeightMatrix& weights, const Eigen::Vector3d& place, std::span<double> row);

}  // namespace ostraka::coords
