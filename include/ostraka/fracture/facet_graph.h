// Patch graph of a fragment's surface: the units that are classified.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// Patches of a surface and their adjacency. In a mesh with few faces each patch is one face; in a mesh with many faces a patch
/// is a group of neighbouring faces with similar normals.
struct FacetGraph {
    std::vector<Index> patch_of_face;  ///< for each face: index of its patch
    std::vector<Point> places;         ///< centroid of each patch
    /// For each patch: unit normal, averaged with neighbours of similar normal; null vector if the area is 0.
    std::vector<Vector> normals;
    std::vector<double> areas;  ///< area of each patch
    /// For each patch: 1 minus the mean cosine of the angles between the normals of its faces and the normal of the patch.
    std::vector<double> normal_deviation;
    /// A pair of adjacent patches.
    struct Contact {
        Index a = 0, b = 0;         ///< indices of the patches, a < b
        double length = 0;          ///< total length of the edges between the two patches
        double dihedral_angle = 0;  ///< dihedral angle in radians; positive where convex
        Point middle{0, 0, 0};      ///< middle of the common boundary
    };
    std::vector<Contact> contacts;  ///< pairs of adjacent patches, sorted by a, then by b
    double area = 0;                ///< area of the surface
    double size = 0;                ///< square root of `area`: unit in which lengths of the fragment are measured
    double edge = 0;                ///< mean edge length of the mesh
    bool closed = true;             ///< true: the mesh has no opening (`has_opening`)

    [[nodiscard]] std::size_t count() const { return places.size(); }  ///< number of patches
};

/// Whether the surface is open: its borders together are at least a fifth of the square root of its area long. Smaller holes let
/// few rays out. Borders of loose scraps, each with less than a thousandth of the area, do not count. Time: linear.
bool has_opening(const Mesh& mesh);

/// Divides the surface of a mesh into about `max_patches` patches at most. Throws Error (input) for a mesh without area.
FacetGraph facet_graph(const Mesh& mesh, std::size_t max_patches = 24000);

/// Wall thickness of a fragment, measured with rays cast from each patch into the solid.
struct Walls {
    /// For each patch: median distance at which rays leave the solid; infinite if fewer than half of the rays do.
    std::vector<double> depth;
    /// For each patch: mean over its rays of -cos(angle between the surface normals at both ends of the ray), from -1 to 1; 1
    /// for parallel sides.
    std::vector<double> opposite;
    std::vector<Index> behind;  ///< for each patch: the patch hit by its middle ray; no_index: none
    double thickness = 0;       ///< median `depth` over the area that has an opposite side (a wall); 0: no wall
    double share = 0;           ///< fraction of the area where `depth` is close to `thickness`
};
/// Casts rays from each patch into the solid.
Walls measure_walls(const Mesh& mesh, const FacetGraph& graph);

/// Segments the patches into parts whose mutual boundary turns outward by more than `sharpest` (radians) on average. Small
/// parts are merged first, each with the neighbour across the boundary of smallest mean dihedral angle; then the pairs of parts
/// with the smallest mean dihedral angle are merged. Returns for each patch the index of its part.
std::vector<std::size_t> convex_parts(const FacetGraph& graph, double sharpest);

/// For each patch, the label of the labelling that minimises the sum of `costs[label][patch]` plus `boundary[contact]` over
/// contacts between different labels (alpha expansion, initialised with the cheapest labels; Boykov, Veksler and Zabih 2001).
std::vector<std::size_t> min_cost_labels(const FacetGraph& graph, const std::vector<std::vector<double>>& costs,
                                         const std::vector<double>& boundary);

}  // namespace ostraka
