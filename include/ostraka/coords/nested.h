// Nested cages: an inner cage deforms the part of the mesh inside it, in addition to the cages around it (thesis, section
// 6.1.1; doc/cages.md).
#pragma once

#include "ostraka/coords/coordinates.h"
#include "ostraka/geom/submesh.h"

namespace ostraka {

/// One cage of several nested cages, which together form one cage mesh.
struct CageLevel {
    SubMesh cage;  ///< the cage as a mesh, with the indices of its vertices and faces in the whole cage mesh
    /// Index of the level that encloses this level; the outermost level has its own index.
    std::size_t parent = 0;
};

/// Splits a cage mesh into levels. The first level is the outermost cage (all components that lie in no other component, and
/// cavities). The inner cages follow, each after its parent, otherwise in the order of their smallest face indices. Component A
/// lies in component B if most vertices of A lie inside B and both components have the same orientation. A cage mesh that is
/// open or has one component is a single level.
std::vector<CageLevel> cage_levels(const Mesh& cage);

/// For each level except the first, the mean value coordinates of its vertices in its parent level; with these weights the parent
/// moves the level. The matrix of level 0, which has no parent, is empty.
std::vector<WeightMatrix> carrying_weights(const std::vector<CageLevel>& levels);

/// Coordinates of the vertices of a mesh with respect to all levels of nested cages. Let x be the position of a vertex after the
/// deformation by the parent, h the influence of the level at the vertex, w the weights of the vertex in the level, c the
/// positions of the level's vertices and c' the positions to which the parent moves them. The level then yields x + h w (c - c').
/// The influence h is 0 outside the level and in all pieces of the mesh inside the level except the largest piece; in the largest
/// piece h rises from 0 where the mesh enters the level to 1 at a distance of `fade` times the level's diagonal. Written in terms
/// of all vertices of the cage mesh, this position is a combination with one row of weights; the row sums to one and reproduces
/// the vertex from the undeformed cage. Throws Error (usage) for kinds with a normal term, otherwise as compute_coordinates.
Coordinates nested_coordinates(const std::string& kind, const std::vector<CageLevel>& levels, const Mesh& mesh,
                               const CoordinateOptions& options);

/// The weights of points in one level, multiplied by the influence of the level: one row per point, one column per vertex of the
/// level. `vertex`: weights of the points in all levels together. `carrying`: the result of carrying_weights.
WeightMatrix weights_of_level(const WeightMatrix& vertex, const std::vector<CageLevel>& levels,
                              const std::vector<WeightMatrix>& carrying, std::size_t level);

/// The innermost level whose influence, averaged over the given points (rows of `vertex`), is at least 0.5.
std::size_t governing_level(const WeightMatrix& vertex, const std::vector<Index>& points, const std::vector<CageLevel>& levels,
                            const std::vector<WeightMatrix>& carrying);

}  // namespace ostraka
