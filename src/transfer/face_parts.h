// Partition of the faces of a mesh along the outlines of all regions.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <utility>
#include <vector>

namespace ostraka {

double edge_length(const Mesh& mesh, Halfedge h);

/// Parts are connected across edges that are not walls; a region whose outlines are walls is a union of parts. Thereby the mesh
/// is traversed only once for all regions.
class FaceParts {
public:
    /// `walls`: edges in any order, possibly repeated. O(n) on all threads; parts are numbered by their lowest faces,
    /// independently of the number of threads. The mesh must outlive this object.
    FaceParts(const Mesh& mesh, std::vector<Edge> walls);

    struct Choice {
        std::vector<bool> parts;  ///< one flag per part
        bool crossing = false;    ///< a part reached from the left of the edges lies on their right
        double area = 0, perimeter = 0;
    };
    /// The parts to the left of directed edges, all of which must be walls: grown from there without crossing any of the edges.
    /// Edges traversed in both directions are not boundaries.
    [[nodiscard]] Choice left_of(const std::vector<Halfedge>& edges) const;

    /// One flag per face.
    [[nodiscard]] std::vector<bool> faces(const Choice& choice) const;

private:
    void number(const std::vector<Edge>& walls);
    void measure();
    [[nodiscard]] Index part_at(Halfedge h) const;

    struct Link {
        Index part;         ///< on the other side
        std::size_t edges;  ///< number of walls between the two parts
    };
    const Mesh& mesh_;
    std::vector<Index> part_;               ///< by face
    std::vector<Index> begin_, faces_;      ///< by part: start of its faces in the list
    std::vector<Halfedge> border_;          ///< of the mesh
    std::vector<double> areas_, borders_;   ///< by part: area, length of the mesh's border
    std::vector<std::vector<Link>> links_;  ///< by part
};

}  // namespace ostraka
