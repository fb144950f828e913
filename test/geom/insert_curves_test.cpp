#include "ostraka/geom/insert_curves.h"
#include "ostraka/geom/distance.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/surface_search.h"

#include <gtest/gtest.h>

#include <random>

using namespace ostraka;
using namespace ostraka::test;

namespace {

Mesh flat_patch(Index n) {
    TriangleSoup soup = patch(n, n);
    for (auto& p : soup.points) p[2] = 0;
    return build_mesh(soup);
}

SurfaceCurve line(const Mesh& mesh, const SurfaceSearch& search, const Point& from, const Point& to) {
    const SurfaceHit a = search.closest(from), b = search.closest(to);
    const auto curve = trace_line(mesh, surface_point(mesh, a.face, a.barycentric), surface_point(mesh, b.face, b.barycentric),
                                  Vector(0, 0, 1), 10);
    EXPECT_TRUE(curve);
    return curve.value_or(SurfaceCurve{});
}

}  // namespace

TEST(InsertCurves, CurvesBecomeEdgesAndTheSurfaceStays) {
    const Mesh mesh = flat_patch(9);
    const SurfaceSearch search(mesh);
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> uniform(0.02, 0.98);
    for (int round = 0; round < 20; ++round) {
        std::vector<SurfaceCurve> curves;
        for (int i = 0; i < 4; ++i)
            curves.push_back(
                line(mesh, search, Point(uniform(random), uniform(random), 0), Point(uniform(random), uniform(random), 0)));
        const InsertedCurves inserted = insert_curves(mesh, curves);
        EXPECT_TRUE(inserted.mesh.is_valid(false));
        EXPECT_EQ(euler_number(inserted.mesh), euler_number(mesh));
        EXPECT_NEAR(surface_area(inserted.mesh), surface_area(mesh), 1e-9);
        ASSERT_EQ(inserted.face_origin.size(), inserted.mesh.number_of_faces());
        std::vector<double> area(mesh.number_of_faces(), 0);
        for (const Face f : inserted.mesh.faces()) area[inserted.face_origin[f]] += face_area(inserted.mesh, f);
        for (const Face f : mesh.faces()) EXPECT_NEAR(area[f], face_area(mesh, f), 1e-12);
        for (Index v = 0; v < mesh.number_of_vertices(); ++v) EXPECT_EQ(inserted.mesh.point(Vertex(v)), mesh.point(Vertex(v)));
        for (std::size_t c = 0; c < curves.size(); ++c) {
            ASSERT_EQ(inserted.node_vertex[c].size(), curves[c].points.size());
            for (std::size_t i = 0; i < curves[c].points.size(); ++i)
                EXPECT_NEAR(
                    distance(inserted.mesh.point(Vertex(inserted.node_vertex[c][i])), position(mesh, curves[c].points[i])), 0,
                    1e-6);
        }
        // A single curve has no intersections: each piece is an edge.
        const InsertedCurves alone = insert_curves(mesh, {curves.front()});
        for (std::size_t i = 0; i + 1 < alone.node_vertex[0].size(); ++i) {
            const Index a = alone.node_vertex[0][i], b = alone.node_vertex[0][i + 1];
            EXPECT_TRUE(a == b || find_halfedge(alone.mesh, Vertex(a), Vertex(b)) != Mesh::null_halfedge());
        }
    }
}

TEST(InsertCurves, NothingToInsertChangesNothing) {
    const Mesh mesh = build_mesh(torus(12, 8));
    const InsertedCurves same = insert_curves(mesh, {});
    EXPECT_EQ(mesh_checksum(same.mesh), mesh_checksum(mesh));
    SurfaceCurve edge;
    const auto [a, b, c] = corners(mesh, Face(3));
    edge.points = {vertex_point(a), vertex_point(b)};
    edge.faces = {3};
    EXPECT_EQ(mesh_checksum(insert_curves(mesh, {edge}).mesh), mesh_checksum(mesh));
}

TEST(InsertCurves, RefusesMissingPoints) {
    const Mesh mesh = build_mesh(torus(12, 8));
    SurfaceCurve curve;
    curve.points.push_back(vertex_point(0));
    for (const auto kind : {SurfacePoint::Kind::vertex, SurfacePoint::Kind::edge, SurfacePoint::Kind::face}) {
        curve.points[0].kind = kind;
        curve.points[0].element = {1000000, 1000001};
        EXPECT_THROW(insert_curves(mesh, {curve}), Error);
    }
}

TEST(LeftShares, MatchTheAreaOfTheHalfPlane) {
    const Mesh mesh = flat_patch(7);
    const SurfaceSearch search(mesh);
    // Left of a line that runs towards +y, x is smaller.
    const double x = 0.4321;
    const auto shares = left_area_fractions(mesh, {line(mesh, search, Point(x, 0.0001, 0), Point(x, 0.9999, 0))}, 2);
    ASSERT_FALSE(shares.empty());
    for (const auto& [f, share] : shares) {
        // Area of the triangle left of x, by clipping it.
        std::vector<Point> polygon;
        const auto vertices = corners(mesh, Face(f));
        for (int k = 0; k < 3; ++k) {
            const Point p = mesh.point(vertices[k]), q = mesh.point(vertices[(k + 1) % 3]);
            if (p.x() <= x) polygon.push_back(p);
            if ((p.x() < x) != (q.x() < x)) polygon.push_back(p + (x - p.x()) / (q.x() - p.x()) * (q - p));
        }
        double area = 0;
        for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
            area += 0.5 * CGAL::cross_product(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]).z();
        // The line's ends stop a ten-thousandth short of the border.
        EXPECT_NEAR(share, area / face_area(mesh, Face(f)), 2e-3) << f;
    }
}
