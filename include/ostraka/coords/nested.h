// Nested cages: an inner cage deforms the part of the mesh inside it, in addition to the cages around it (thesis, section
// 6.1.1; doc/cages.md).
#pragma once

#include "ostraka/coords/coordinates.h"
#include "ostraka/geom/submesh.h"

namespace ostraka {

/// One of the cages in a cage mesh of several components.
struct CageLevel {
    SubMesh cage;            ///< the cage with its vertices and faces in the whole cage mesh
    std::size_t parent = 0;  ///< index of the level around it; its own index for the outermost
};

/// Splits a cage mesh into levels. The first is the outermost cage (all components that lie in no other, and cavities); the
/// inner cages follow, each after its parent, otherwise in the order of their lowest faces. A component lies in another if most
/// of its vertices do and both have the same orientation. A cage that is open or has one component is a single level.
std::vector<CageLevel> cage_levels(const Mesh& cage);

/// For each level except the first the mean value coordinates of its vertices in its parent, by which the parent moves it.
/// Entry 0 is 0 x 0.
std::vector<WeightMatrix> carrying_weights(const std::vector<CageLevel>& levels);

/// Coordinates of the vertices of a mesh in all levels together. Let x be the position of a vertex after the deformation by the
/// parent, h the influence of the level at the vertex, w the weights of the vertex in the level, c the positions of the level's
/// vertices and c' the positions to which the parent moves them. The level then yields x + h w (c - c'). The influence h is 0
/// outside the level and in all pieces of the mesh within it except the largest; in the largest it rises from 0 to 1 over the
/// distance of `fade` times the level's diagonal from where the mesh enters. Expanded, this is one row over all vertices of the
/// cage, which sums to one and reproduces the vertex. Throws Error (usage) for kinds with a normal term, otherwise as
/// compute_coordinates.
Coordinates nested_coordinates(const std::string& kind, const std::vector<CageLevel>& levels, const Mesh& mesh,
                               const CoordinateOptions& options);

/// The influence of a level times its weights, for points whose weights in all levels are the rows of `vertex`; one column for
/// each vertex of the level. `carrying`: the result of carrying_weights.
WeightMatrix weights_of_level(const WeightMatrix& vertex, const std::vector<CageLevel>& levels,
                              const std::vector<WeightMatrix>& carrying, std::size_t level);

/// The innermost level whose influence on these points (rows of `vertex`) averages at least one half.
std::size_t governing_level(const WeightMatrix& vertex, const std::vector<Index>& points, const std::vector<CageLevel>& levels,
                            const std::vector<WeightMatrix>& carrying);

}  // namespace ostraka
