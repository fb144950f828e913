// The faces of a mesh parted along the outlines of all regions at once.
#pragma once

#include "ostraka/core/mesh.h"

#include <utility>
#include <vector>

namespace ostraka {

double edge_length(const Mesh& mesh, Halfedge h);

/// Parts hang together over edges that are no walls; a region whose outlines are walls is made of whole parts. So the mesh is
/// gone through once, however many regions there are.
class FaceParts {
public:
    /// `walls`: edges, in any order, as often as one likes. O(n) on all threads; parts are numbered by their lowest faces,
    /// whatever the number of threads. The mesh outlives them.
    FaceParts(const Mesh& mesh, std::vector<Edge> walls);

    struct Choice {
        std::vector<bool> parts;  ///< a flag per part
        bool crossing = false;    ///< something was reached from the left of the edges that lies on their right
        double area = 0, perimeter = 0;
    };
    /// What lies to the left of directed edges, which are walls all: grown from there without crossing any of them. Edges that
    /// are run through in both directions bound nothing.
    [[nodiscard]] Choice left_of(const std::vector<Halfedge>& edges) const;

    /// A flag per face.
    [[nodiscard]] std::vector<bool> faces(const Choice& choice) const;

private:
    void number(const std::vector<Edge>& walls);
    void measure();
    [[nodiscard]] Index part_at(Halfedge h) const;

    struct Link {
        Index part;         ///< on the other side
        std::size_t edges;  ///< how many walls lie between the two
    };
    const Mesh& mesh_;
    std::vector<Index> part_;               ///< by face
    std::vector<Index> begin_, faces_;      ///< by part: where its faces begin in the list
    std::vector<Halfedge> border_;          ///< of the mesh
    std::vector<double> areas_, borders_;   ///< by part: area, length of the mesh's border
    std::vector<std::vector<Link>> links_;  ///< by part
};

}  // namespace ostraka
