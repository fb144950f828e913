#include "ostraka/mesh/flood.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

/// A strip of four triangles, and a triangle apart whose number lies between theirs.
Mesh strip_and_triangle() {
    TriangleSoup soup;
    for (const double x : {0, 1, 2})
        for (const double y : {0, 1}) soup.points.push_back({x, y, 0});
    for (const double x : {5, 6, 7}) soup.points.push_back({x, x * x, 0});
    soup.triangles = {{0, 2, 1}, {2, 3, 1}, {6, 7, 8}, {2, 4, 3}, {4, 5, 3}};
    return build_mesh(soup);
}

TEST(Flood, PiecesAreNumberedByTheirLowestFaces) {
    const Mesh mesh = strip_and_triangle();
    const FacePieces components = face_pieces(mesh);
    EXPECT_EQ(components.count, 2U);
    EXPECT_EQ(components.of_face, (std::vector<Index>{0, 0, 1, 0, 0}));
    const FacePieces without_middle = face_pieces(mesh, [](Face f) { return f != Face(1); });
    EXPECT_EQ(without_middle.count, 3U);
    EXPECT_EQ(without_middle.of_face, (std::vector<Index>{0, no_index, 1, 2, 2}));
    const FacePieces apart = face_pieces(
        mesh, [](Face) { return true; }, [](Halfedge) { return false; });
    EXPECT_EQ(apart.of_face, (std::vector<Index>{0, 1, 2, 3, 4}));
}

TEST(Flood, FacesAreReachedBreadthFirstAndOnce) {
    const Mesh mesh = strip_and_triangle();
    std::vector<bool> visited(mesh.number_of_faces(), false);
    visited[4] = true;
    EXPECT_EQ(flood_faces(mesh, Face(3), visited), (std::vector<Face>{Face(3), Face(1), Face(0)}));
    EXPECT_EQ(visited, (std::vector<bool>{true, true, false, true, true}));
}

TEST(Flood, VerticesAreEnteredOnlyIfAllowed) {
    const Mesh mesh = strip_and_triangle();
    std::vector<bool> visited(mesh.number_of_vertices(), false);
    std::vector<Vertex> reached = flood_vertices(mesh, Vertex(0), visited, [](Vertex v) { return v.idx() % 2 == 0; });
    std::sort(reached.begin(), reached.end());
    EXPECT_EQ(reached, (std::vector<Vertex>{Vertex(0), Vertex(2), Vertex(4)}));
}

TEST(Flood, AnyGraphFromSeveralStarts) {
    const std::vector<std::vector<std::size_t>> edges{{1}, {2}, {0}, {4}, {}, {3}};
    std::vector<bool> visited(edges.size(), false);
    visited[0] = visited[5] = true;
    const auto reached = flood(std::vector<std::size_t>{0, 5}, visited, [&](std::size_t node, auto&& reach) {
        for (const std::size_t next : edges[node]) reach(next);
    });
    EXPECT_EQ(reached, (std::vector<std::size_t>{0, 5, 1, 3, 2, 4}));
}

}  // namespace
}  // namespace ostraka
