// Connected components (flood fill) of faces, vertices and elements of any graph.
#pragma once

#include "ostraka/mesh/mesh.h"

namespace ostraka {

/// Returns the elements that can be reached from `starts`, in breadth-first order and including `starts`. The elements in
/// `starts` must already be marked in `visited`. The function each_neighbour(element, reach) calls reach(neighbour) for each
/// neighbour to visit. Reached elements are marked in `visited`; elements that were marked before are not visited. `visited`
/// has one flag per element.
template <class Element, class Visited, class EachNeighbour>
std::vector<Element> flood(std::vector<Element> starts, Visited& visited, EachNeighbour&& each_neighbour) {
    std::vector<Element> reached = std::move(starts);
    const auto reach = [&](Element next) {
        if (visited[next]) return;
        visited[next] = true;
        reached.push_back(next);
    };
    for (std::size_t i = 0; i < reached.size(); ++i) each_neighbour(Element(reached[i]), reach);
    return reached;
}

/// Faces that can be reached from `start` across edges, in breadth-first order, `start` first. Only faces not yet marked in
/// `visited` are visited, and visited faces are marked. An edge is crossed if `crosses(halfedge)` is true for the edge's halfedge
/// in the face already reached; `crosses` is called once for each halfedge of a reached face, border edges included.
template <class Crosses>
std::vector<Face> flood_faces(const Mesh& mesh, Face start, std::vector<bool>& visited, Crosses&& crosses) {
    visited[start] = true;
    return flood(std::vector<Face>{start}, visited, [&](Face face, auto&& reach) {
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(face)))
            if (crosses(h) && !mesh.is_border(mesh.opposite(h))) reach(mesh.face(mesh.opposite(h)));
    });
}
/// Faces that can be reached from `start` across any edges: the connected component without the faces already visited.
inline std::vector<Face> flood_faces(const Mesh& mesh, Face start, std::vector<bool>& visited) {
    return flood_faces(mesh, start, visited, [](Halfedge) { return true; });
}

/// Vertices that can be reached from `start` along edges through vertices for which `enters` is true; otherwise like
/// flood_faces.
template <class Enters>
std::vector<Vertex> flood_vertices(const Mesh& mesh, Vertex start, std::vector<bool>& visited, Enters&& enters) {
    visited[start] = true;
    return flood(std::vector<Vertex>{start}, visited, [&](Vertex vertex, auto&& reach) {
        if (mesh.is_isolated(vertex)) return;
        for (const Vertex next : mesh.vertices_around_target(mesh.halfedge(vertex)))
            if (enters(next)) reach(next);
    });
}

/// Connected pieces of a set of faces, numbered in the order of their smallest face indices.
struct FacePieces {
    std::vector<Index> of_face;  ///< for each face of the mesh: index of its piece; no_index: in no piece
    Index count = 0;             ///< number of pieces
};
/// Finds the connected pieces of the faces for which `counts(face)` is true. Two adjacent faces are connected if `joins(h)` is
/// true for the halfedge h of the first face on their common edge.
template <class Counts, class Joins>
FacePieces face_pieces(const Mesh& mesh, Counts&& counts, Joins&& joins) {
    FacePieces pieces{std::vector<Index>(mesh.number_of_faces(), no_index)};
    std::vector<bool> visited(mesh.number_of_faces());
    for (const Face face : mesh.faces()) visited[face] = !counts(face);
    for (const Face first : mesh.faces()) {
        if (visited[first]) continue;
        const auto crosses = [&](Halfedge h) {
            const Halfedge other = mesh.opposite(h);
            return !mesh.is_border(other) && !visited[mesh.face(other)] && joins(h);
        };
        for (const Face face : flood_faces(mesh, first, visited, crosses)) pieces.of_face[face] = pieces.count;
        ++pieces.count;
    }
    return pieces;
}
/// Finds the pieces, connected across any edge, of the faces for which `counts(face)` is true.
template <class Counts>
FacePieces face_pieces(const Mesh& mesh, Counts&& counts) {
    return face_pieces(mesh, counts, [](Halfedge) { return true; });
}
/// The connected components of the mesh.
inline FacePieces face_pieces(const Mesh& mesh) {
    return face_pieces(mesh, [](Face) { return true; });
}

}  // namespace ostraka
