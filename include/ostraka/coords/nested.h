// Cages nested in a cage: each steers what lies within it, beyond what the cages around it do (thesis, section 6.1.1;
// doc/cages.md).
#pragma once

#include "ostraka/coords/coordinates.h"
#include "ostraka/geom/submesh.h"

namespace ostraka {

/// One of the cages that a mesh of several components holds.
struct CageLevel {
    SubMesh cage;            ///< with the vertices and faces of the whole that it is made of
    std::size_t parent = 0;  ///< the level around it; its own number for the outermost
};

/// The outermost cage first (all components that lie in none, and cavities), then those within others, each after its parent,
/// otherwise in the order of their lowest faces. A component lies in another if most of its vertices do and both are oriented
/// alike. A cage that is open, or of one component, is one level.
std::vector<CageLevel> cage_levels(const Mesh& cage);

/// For each level but the first the mean value coordinates of its vertices in its parent: by them it is carried. Level 0: 0 x 0.
std::vector<WeightMatrix> carrying_weights(const std::vector<CageLevel>& levels);

/// Coordinates of the vertices of a mesh in all levels together. Where x is what the parent makes of a vertex, h its hold and w
/// its weights in a level, the level makes of it x + h w (c - c'), c being the level's vertices and c' where the parent carries
/// them. The hold is one inside, zero outside and in all pieces of the mesh within the level but the largest, and rises over
/// `fade` times the level's diagonal from where the mesh enters. Written out this is one row for all vertices of the cage, which
/// sums to one and reproduces the vertex. Throws Error (usage) for kinds with a normal term, else as compute_coordinates.
Coordinates nested_coordinates(const std::string& kind, const std::vector<CageLevel>& levels, const Mesh& mesh,
                               const CoordinateOptions& options);

/// The hold of a level times its weights, of points with these rows of `vertex` in all levels: a column for each of its vertices.
/// `carrying` as above.
WeightMatrix weights_of_level(const WeightMatrix& vertex, const std::vector<CageLevel>& levels,
                              const std::vector<WeightMatrix>& carrying, std::size_t level);

/// The innermost level that holds most of these points (rows of `vertex`).
std::size_t level_that_holds(const WeightMatrix& vertex, const std::vector<Index>& points, const std::vector<CageLevel>& levels,
                             const std::vector<WeightMatrix>& carrying);

}  // namespace ostraka
