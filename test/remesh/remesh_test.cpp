#include "ostraka/remesh/remesh.h"

#include "meshes.h"
#include "ostraka/core/error.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

TEST(Remesh, KeepsSurfaceAndTopologyAtAnyResolution) {
    for (const auto& [name, soup] : group()) {
        for (const double factor : {0.5, 3.0}) {
            SCOPED_TRACE(name + " x " + std::to_string(factor));
            const Mesh mesh = build_mesh(soup);
            RemeshOptions options;
            options.vertices = static_cast<std::uint64_t>(factor * static_cast<double>(soup.points.size()));
            options.feature_angle = 60;  // the box's edges
            const RemeshResult result = remesh(mesh, options);
            EXPECT_TRUE(result.reached);
            EXPECT_EQ(result.mesh.number_of_vertices(), options.vertices);
            EXPECT_TRUE(is_sound(result.mesh));
            EXPECT_EQ(euler_number(result.mesh), euler_number(mesh));
            EXPECT_EQ(border_loops(result.mesh), border_loops(mesh));
            EXPECT_EQ(components(result.mesh), components(mesh));
            EXPECT_NEAR(surface_area(result.mesh) / surface_area(mesh), 1, 0.03);
            // Edges have nearly equal lengths.
            const double mean = mean_edge_length(result.mesh);
            std::size_t outliers = 0;
            for (const Edge e : result.mesh.edges()) {
                const double length = std::sqrt(CGAL::squared_distance(result.mesh.point(result.mesh.vertex(e, 0)),
                                                                       result.mesh.point(result.mesh.vertex(e, 1))));
                outliers += length < 0.5 * mean || length > 2 * mean;
            }
            EXPECT_LT(outliers, result.mesh.number_of_edges() / 20);
        }
    }
}

TEST(Remesh, FeaturesStay) {
    const Mesh mesh = build_mesh(box(12));
    RemeshOptions options;
    options.vertices = 1500;
    options.feature_angle = 45;
    const RemeshResult result = remesh(mesh, options);
    EXPECT_NEAR(volume(result.mesh), 1, 0.002);
    EXPECT_NEAR(surface_area(result.mesh), 6, 0.01);
}

TEST(Remesh, IsDeterministic) {
    const Mesh mesh = build_mesh(torus(48, 24));
    RemeshOptions options;
    options.vertices = 2000;
    EXPECT_EQ(mesh_checksum(remesh(mesh, options).mesh), mesh_checksum(remesh(mesh, options).mesh));
}

TEST(Remesh, APointFarAwayIsAnErrorNotAHang) {
    for (const double distance : {1e9, 1e18}) {
        TriangleSoup soup = torus(48, 24);
        soup.points[5][1] = distance;
        RemeshOptions options;
        options.vertices = 150;
        EXPECT_THROW(remesh(build_mesh(soup), options), Error);
    }
}

TEST(Remesh, APieceWithoutAreaBesideTheObject) {
    // None of its vertices has a face with a normal.
    TriangleSoup soup = octahedron_sphere(3);
    const auto first = static_cast<Index>(soup.points.size());
    for (const double x : {2.0, 2.01, 2.03, 2.04}) soup.points.push_back({x, 0, 0});
    for (const auto& [a, b, c] : {std::array<Index, 3>{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}})
        soup.triangles.push_back({first + a, first + b, first + c});
    RemeshOptions options;
    options.vertices = 500;
    const RemeshResult result = remesh(build_mesh(soup), options);
    EXPECT_NEAR(surface_area(result.mesh) / surface_area(build_mesh(octahedron_sphere(3))), 1, 0.03);
    for (const Vertex v : result.mesh.vertices()) {
        const Point& p = result.mesh.point(v);
        ASSERT_TRUE(std::isfinite(p.x()) && std::isfinite(p.y()) && std::isfinite(p.z()));
    }
}

TEST(Remesh, RejectsMeshesWithoutArea) {
    RemeshOptions options;
    options.vertices = 100;
    EXPECT_THROW(remesh(Mesh(), options), Error);
    EXPECT_THROW(remesh(build_mesh({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}}}), options), Error);
    options.vertices = 0;
    EXPECT_THROW(remesh(build_mesh(box(2)), options), Error);
}
