// Divides the faces of a mesh into parts along the outlines of all regions.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <utility>
#include <vector>

namespace ostraka {

double edge_length(const Mesh& mesh, Halfedge h);

/// Parts of a mesh: sets of faces connected across edges that are not walls. A region whose outlines are walls is a union of
/// parts, so that the mesh is traversed only once for all regions.
class FaceParts {
public:
    /// `walls`: edges between parts, in any order, possibly repeated. Time: O(n) on all threads; parts are numbered by their
    /// lowest faces, independently of the number of threads. The mesh must outlive this object.
    FaceParts(const Mesh& mesh, std::vector<Edge> walls);

    /// A region as a union of parts.
    struct Choice {
        std::vector<bool> parts;         ///< for each part, whether it belongs to the region
        bool crossing = false;           ///< true: a part reached from the left of the outline's edges also lies on their right
        double area = 0, perimeter = 0;  ///< sums over the parts of the region
    };
    /// The region to the left of directed edges, all of which must be walls: the parts reached from the left without crossing any
    /// of the edges. Edges traversed in both directions are not boundaries.
    [[nodiscard]] Choice left_of(const std::vector<Halfedge>& edges) const;

    /// For each face, whether it belongs to the region.
    [[nodiscard]] std::vector<bool> faces(const Choice& choice) const;

private:
    void number(const std::vector<Edge>& walls);    ///< assigns each face to a part
    void measure();                                 ///< computes areas and border lengths of the parts
    [[nodiscard]] Index part_at(Halfedge h) const;  ///< part of the face to the left of the halfedge

    /// Adjacency of a part with another part.
    struct Link {
        Index part;         ///< index of the other part
        std::size_t edges;  ///< number of walls between the two parts
    };
    const Mesh& mesh_;
    std::vector<Index> part_;               ///< for each face, index of its part
    std::vector<Index> begin_, faces_;      ///< for each part, index of its first face in `faces_`; faces ordered by part
    std::vector<Halfedge> border_;          ///< halfedges of the border of the mesh
    std::vector<double> areas_, borders_;   ///< for each part: its area, and the length of the mesh's border along it
    std::vector<std::vector<Link>> links_;  ///< for each part, its adjacent parts
};

}  // namespace ostraka
