// A fragment's surface as a bounded number of patches: what facets are told of, and what is taken to be alike.
#pragma once

#include "ostraka/core/mesh.h"

#include <vector>

namespace ostraka {

/// Patches of a surface and which of them touch. A patch is a face; of a mesh with many, faces that lie close together and face
/// the same way.
struct FacetGraph {
    std::vector<Index> patch_of_face;
    std::vector<Point> places;    ///< centroids
    std::vector<Vector> normals;  ///< unit vectors, averaged with neighbours that look alike; null where there is no area
    std::vector<double> areas;
    std::vector<double> ruffle;  ///< 1 less the mean cosine between the faces' own normals and the patch's
    /// Where two patches touch, a < b.
    struct Contact {
        Index a = 0, b = 0;
        double length = 0;  ///< of the edges between them
        double turn = 0;    ///< radians by which the surface turns over them; positive where convex
        Point middle{0, 0, 0};
    };
    std::vector<Contact> contacts;  ///< by a, then b
    double area = 0;
    double size = 0;     ///< square root of the area: the unit of length
    double edge = 0;     ///< mean length of the mesh's edges
    double border = 0;   ///< length of the borders
    bool closed = true;  ///< but for pinholes

    [[nodiscard]] std::size_t count() const { return places.size(); }
};

/// At most about `most` patches. Throws Error (input) for a mesh without area.
FacetGraph facet_graph(const Mesh& mesh, std::size_t most = 24000);

/// What rays into the solid meet under each patch.
struct Walls {
    std::vector<double> depth;     ///< median way to where they leave; infinite where fewer than half of them leave at all
    std::vector<double> opposite;  ///< mean of -cos of the angle between the normals there and here, -1 to 1
    std::vector<Index> behind;     ///< the patch that the middle ray meets; no_index: none
    double typical = 0;            ///< median depth over the area that has a wall: another side opposite; 0: there is none
    double share = 0;              ///< of the area over a wall of about the typical depth
};
Walls walls_under(const Mesh& mesh, const FacetGraph& graph);

/// Parts between which the surface turns outward by more than `sharpest` (radians), averaged over their boundary: small ones
/// joined over the least turns first, then those pairs whose boundary turns least. Number of the part of each patch.
std::vector<std::size_t> convex_parts(const FacetGraph& graph, double sharpest);

/// For each patch the label with the least sum of `costs[label][patch]` and, over contacts whose patches have different ones,
/// `boundary[contact]` (alpha expansion from the cheapest labels; Boykov, Veksler and Zabih 2001).
std::vector<std::size_t> min_labels(const FacetGraph& graph, const std::vector<std::vector<double>>& costs,
                                    const std::vector<double>& boundary);

}  // namespace ostraka
