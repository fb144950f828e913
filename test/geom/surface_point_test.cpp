#include "ostraka/geom/surface_point.h"
#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/distance.h"
#include "ostraka/geom/surface_search.h"

#include <gtest/gtest.h>

#include <random>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// Two points on each vertex, edge and face of a mesh, specified from both ends of edges.
std::vector<SurfacePoint> points_everywhere(const Mesh& mesh) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> fraction(0.01, 0.99);
    std::vector<SurfacePoint> points;
    for (const Vertex v : mesh.vertices()) points.push_back(vertex_point(v));
    for (const Halfedge h : mesh.halfedges()) points.push_back(edge_point(mesh.source(h), mesh.target(h), fraction(random)));
    for (const Face f : mesh.faces()) {
        const double u = 0.5 * fraction(random), v = 0.5 * fraction(random);
        points.push_back(face_point(f, {1 - u - v, u, v}));
    }
    return points;
}

}  // namespace

TEST(SurfacePoint, IsTheSameInEachOfItsFaces) {
    const Mesh mesh = build_mesh(torus(12, 8));
    for (const SurfacePoint& p : points_everywhere(mesh)) {
        const auto faces = faces_of(mesh, p);
        ASSERT_EQ(faces.size(), p.is_vertex() ? 6U : p.is_on_edge() ? 2U : 1U);
        const double height = interpolate(mesh, p, [&](Vertex v) { return mesh.point(v).z(); });
        EXPECT_NEAR(height, position(mesh, p).z(), 1e-15);
        for (const Face f : faces) {
            EXPECT_LT(distance(point_at(mesh, f, in_face(mesh, p, f)), position(mesh, p)), 1e-15);
            EXPECT_LT(distance(position(mesh, surface_point(mesh, f, in_face(mesh, p, f))), position(mesh, p)), 1e-15);
        }
    }
}

TEST(SurfacePoint, IsStoredWithTheLowerEndFirst) {
    const Mesh mesh = build_mesh(torus(12, 8));
    for (const SurfacePoint& p : points_everywhere(mesh)) {
        const SurfacePoint stored = stored_point(mesh, p);
        EXPECT_EQ(stored, stored_point(mesh, stored));
        EXPECT_LT(distance(position(mesh, stored), position(mesh, p)), 1e-15);
        if (!p.is_on_edge()) continue;
        EXPECT_LT(stored.element[0], stored.element[1]);
        EXPECT_EQ(ordered_edge_point(p.element[0], p.element[1], p.weights[1]).element, stored.element);
    }
    const Halfedge h = mesh.halfedge(Edge(3), 1);
    EXPECT_EQ(stored_point(mesh, edge_point(mesh.source(h), mesh.target(h), 0.25)),
              stored_point(mesh, edge_point(mesh.target(h), mesh.source(h), 0.75)));
}

TEST(SurfacePoint, SharesFacesAndEdgesWithItsNeighbours) {
    const Mesh mesh = build_mesh(torus(12, 8));
    for (const Face f : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, f);
        const SurfacePoint inside = face_point(f, {0.2, 0.3, 0.5}), on_edge = edge_point(b, a, 0.4);
        EXPECT_EQ(shared_face(mesh, inside, on_edge), static_cast<Index>(f));
        EXPECT_EQ(shared_face(mesh, on_edge, edge_point(c, a, 0.5)), static_cast<Index>(f));
        EXPECT_EQ(shared_edge(mesh, inside, on_edge), no_index);
        const auto edge = static_cast<Index>(mesh.edge(find_halfedge(mesh, a, b)));
        EXPECT_EQ(shared_edge(mesh, edge_point(a, b, 0.1), on_edge), edge);
        EXPECT_EQ(shared_edge(mesh, vertex_point(a), on_edge), edge);
        EXPECT_EQ(shared_edge(mesh, on_edge, vertex_point(c)), no_index);
        EXPECT_EQ(shared_edge(mesh, vertex_point(a), vertex_point(b)), edge);
        EXPECT_EQ(nearest_vertex(mesh, inside), static_cast<Index>(c));
        EXPECT_EQ(nearest_vertex(mesh, on_edge), static_cast<Index>(b));
    }
    EXPECT_EQ(shared_face(mesh, face_point(0, {0.2, 0.3, 0.5}), face_point(1, {0.2, 0.3, 0.5})), no_index);
}

TEST(SurfacePoint, NamesMissingElements) {
    const Mesh mesh = build_mesh(torus(12, 8));
    const auto refused = [&](const SurfacePoint& p, const std::string& why) {
        try {
            check_surface_point(mesh, p);
            ADD_FAILURE() << "accepted; expected: " << why;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
            EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
        }
    };
    refused(vertex_point(5000), "vertex 5000, which the mesh does not have");
    refused(edge_point(0, 50, 0.5), "the edge from vertex 0 to vertex 50, which");
    refused(face_point(5000, {1, 0, 0}), "face 5000, which");
    const Halfedge h = mesh.halfedge(Edge(0), 0);
    refused(edge_point(mesh.source(h), mesh.target(h), 1.5), "not within the edge");
    refused(face_point(0, {-0.5, 0.75, 0.75}), "not within the face");
    EXPECT_NO_THROW(check_surface_point(mesh, edge_point(mesh.source(h), mesh.target(h), 0.5)));
}
