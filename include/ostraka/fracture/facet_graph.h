// Patch graph of a fragment's surface: the units that are classified.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// Patches of a surface and their adjacency. A patch is a face; in a mesh with many faces, a group of close faces with similar
/// normals.
struct FacetGraph {
    std::vector<Index> patch_of_face;
    std::vector<Point> places;    ///< centroids
    std::vector<Vector> normals;  ///< unit vectors, averaged with similar neighbours; null vectors where the area is 0
    std::vector<double> areas;
    std::vector<double> ruffle;  ///< 1 less the mean cosine between the normals of the faces and the normal of the patch
    /// Two adjacent patches, a < b.
    struct Contact {
        Index a = 0, b = 0;
        double length = 0;  ///< total length of the edges between them
        double turn = 0;    ///< dihedral angle in radians; positive where convex
        Point middle{0, 0, 0};
    };
    std::vector<Contact> contacts;  ///< ordered by a, then b
    double area = 0;
    double size = 0;     ///< square root of the area: the unit of length
    double edge = 0;     ///< mean edge length of the mesh
    double border = 0;   ///< total length of the borders
    bool closed = true;  ///< no border but for pinholes

    [[nodiscard]] std::size_t count() const { return places.size(); }
};

/// At most about `max_patches` patches. Throws Error (input) for a mesh without area.
FacetGraph facet_graph(const Mesh& mesh, std::size_t max_patches = 24000);

/// Results of rays cast from each patch into the solid.
struct Walls {
    std::vector<double> depth;     ///< median distance to the exit; infinite if fewer than half of the rays exit
    std::vector<double> opposite;  ///< mean of -cos of the angle between the normals at both ends, -1 to 1
    std::vector<Index> behind;     ///< the patch hit by the middle ray; no_index: none
    double typical = 0;            ///< median depth over the area that lies over a wall (with an opposite side); 0: there is none
    double share = 0;              ///< share of the area that lies over a wall of about the typical depth
};
Walls measure_walls(const Mesh& mesh, const FacetGraph& graph);

/// Segments the patches into parts whose mutual boundary turns outward by more than `sharpest` (radians) on average. Merges
/// small parts first, over the smallest turns, then the pairs with the smallest mean turn. Returns the part number of each
/// patch.
std::vector<std::size_t> convex_parts(const FacetGraph& graph, double sharpest);

/// Labels that minimise the sum of `costs[label][patch]` plus `boundary[contact]` over contacts between different labels (alpha
/// expansion, initialised with the cheapest labels; Boykov, Veksler and Zabih 2001).
std::vector<std::size_t> min_labels(const FacetGraph& graph, const std::vector<std::vector<double>>& costs,
                                    const std::vector<double>& boundary);

}  // namespace ostraka
