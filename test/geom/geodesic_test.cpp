#include "ostraka/geom/geodesic.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/core/memory.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace ostraka {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

Mesh flat(Index n, double scale = 1, double shift = 0) {
    return build_mesh(test::grid(n, n, false, false, [&](double u, double v) {
        return std::array<double, 3>{shift + scale * u, shift + scale * v, shift};
    }));
}

/// A cube of side 1, with one vertex per corner.
Mesh unit_cube() {
    TriangleSoup soup;
    for (int i = 0; i < 8; ++i) soup.points.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2)});
    soup.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return build_mesh(soup);
}

TEST(Geodesic, StraightOnAPlaneAtAnyPositionAndSize) {
    for (const auto& [scale, shift] : {std::pair{1.0, 0.0}, {1e-9, 0.0}, {1e9, 0.0}, {1.0, 1e6}}) {
        const Mesh mesh = flat(9, scale, shift);
        const std::vector<double> distances = geodesic_distances(mesh, {37});
        for (const Vertex v : mesh.vertices())
            EXPECT_NEAR(distances[v], std::sqrt(CGAL::squared_distance(mesh.point(v), mesh.point(Vertex(37)))),
                        1e-12 * (scale + shift));
    }
}

TEST(Geodesic, AroundTheCornersOfACube) {
    const Mesh mesh = unit_cube();
    const std::vector<double> distances = geodesic_distances(mesh, {0});
    EXPECT_NEAR(distances[1], 1, 1e-12);
    EXPECT_NEAR(distances[3], std::sqrt(2), 1e-12);
    EXPECT_NEAR(distances[7], std::sqrt(5), 1e-12);  // two faces unfolded
    EXPECT_NEAR(geodesic_distance(mesh, vertex_point(0), vertex_point(7)), std::sqrt(5), 1e-12);
    // Between the middles of opposite faces: down one side, over 1/2 + 1 + 1/2.
    const SurfacePoint bottom = surface_point(mesh, 0, {0, 0.5, 0.5}), top = surface_point(mesh, 2, {0, 0.5, 0.5});
    EXPECT_EQ(bottom.kind, SurfacePoint::Kind::edge);
    EXPECT_NEAR(geodesic_distance(mesh, bottom, top), 2, 1e-12);
    const SurfacePoint inside = surface_point(mesh, 0, {0.5, 0.25, 0.25});  // at (1/4, 1/4, 0)
    EXPECT_NEAR(geodesic_distance(mesh, inside, vertex_point(4)), std::hypot(0.25, 1.25), 1e-12);
    EXPECT_NEAR(geodesic_distance(mesh, inside, inside), 0, 0);
}

TEST(Geodesic, FarthestPointOfTheSphereIsPi) {
    std::vector<double> errors;
    for (const int levels : {2, 3, 4}) {
        const Mesh mesh = build_mesh(test::octahedron_sphere(levels));
        const std::vector<double> distances = geodesic_distances(mesh, {4});
        errors.push_back(std::numbers::pi - *std::max_element(distances.begin(), distances.end()));
        EXPECT_EQ(std::max_element(distances.begin(), distances.end()) - distances.begin(), 5);
        RecordProperty("error_" + std::to_string(levels), std::to_string(errors.back()));
    }
    for (std::size_t i = 0; i + 1 < errors.size(); ++i) {  // order two
        EXPECT_GT(errors[i + 1], 0);
        EXPECT_NEAR(std::log2(errors[i] / errors[i + 1]), 2, 0.2) << errors[i] << ' ' << errors[i + 1];
    }
    EXPECT_LT(errors.back(), 0.01);
}

TEST(Geodesic, AroundANotch) {
    // An L: the square without its upper right quarter; the path between the tips of the L bends at the inner corner.
    const Mesh square = flat(10);
    TriangleSoup soup = to_soup(square);
    std::erase_if(soup.triangles, [&](const auto& t) {
        double x = 0, y = 0;
        for (const Index v : t) x += soup.points[v][0] / 3, y += soup.points[v][1] / 3;
        return x > 0.5 && y > 0.5;
    });
    const Mesh mesh = build_mesh(soup);
    const Vertex right(5 * 11 + 10), upper(10 * 11 + 5);  // (1, 1/2) and (1/2, 1)
    EXPECT_NEAR(geodesic_distances(mesh, {static_cast<Index>(right)})[upper], 1, 1e-12);
    const Vertex low(4 * 11 + 10);  // (1, 0.4)
    EXPECT_NEAR(geodesic_distance(mesh, vertex_point(low), vertex_point(upper)), std::hypot(0.5, 0.1) + 0.5, 1e-12);
}

TEST(Geodesic, ALimitChangesNothingBelowIt) {
    TriangleSoup soup = test::octahedron_sphere(4);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> noise(0.97, 1.03);
    for (auto& p : soup.points) {
        const double factor = noise(random);
        for (double& c : p) c *= factor;
    }
    const Mesh mesh = build_mesh(soup);
    const std::vector<Index> sources{0, 17, 400};
    const std::vector<double> all = geodesic_distances(mesh, sources), near = geodesic_distances(mesh, sources, 0.5);
    std::size_t reached = 0;
    for (std::size_t v = 0; v < all.size(); ++v) {
        if (all[v] < 0.5 * (1 - 1e-12)) {
            ++reached;
            EXPECT_NEAR(near[v], all[v], 1e-12);
        } else if (all[v] > 0.5 * (1 + 1e-12)) {
            EXPECT_EQ(near[v], infinite);
        }
    }
    EXPECT_GT(reached, 20U);
    EXPECT_LT(reached, all.size() / 2);
    // With several sources the nearest counts; the distance is symmetric; edge paths are never shorter.
    const std::vector<double> a = geodesic_distances(mesh, {0}), b = geodesic_distances(mesh, {17}),
                              c = geodesic_distances(mesh, {400});
    PathSearch paths(mesh);
    for (const Index v : {3U, 99U, 250U, 700U}) {
        EXPECT_NEAR(all[v], std::min({a[v], b[v], c[v]}), 1e-12);
        EXPECT_NEAR(geodesic_distance(mesh, vertex_point(v), vertex_point(0)), a[v], 1e-12);
        double length = 0;
        const std::vector<Index> path = paths.find(Vertex(0), Vertex(v), {});
        for (std::size_t i = 0; i + 1 < path.size(); ++i)
            length += std::sqrt(CGAL::squared_distance(mesh.point(Vertex(path[i])), mesh.point(Vertex(path[i + 1]))));
        EXPECT_LE(a[v], length + 1e-12);
        EXPECT_GT(a[v], 0.7 * length);
    }
}

TEST(Geodesic, SeparatePartsIsolatedVerticesAndFacesWithoutArea) {
    TriangleSoup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {9, 9, 9}};
    soup.triangles = {{0, 1, 2}, {3, 4, 5}};
    Mesh mesh = build_mesh(soup);
    EXPECT_EQ(geodesic_distances(mesh, {0}), (std::vector<double>{0, 1, 1, infinite, infinite, infinite, infinite}));
    EXPECT_EQ(geodesic_distances(mesh, {6})[0], infinite);
    EXPECT_EQ(geodesic_distances(mesh, {6})[6], 0);
    EXPECT_EQ(geodesic_distance(mesh, vertex_point(0), vertex_point(4)), infinite);
    EXPECT_EQ(geodesic_distance(mesh, vertex_point(6), vertex_point(4)), infinite);
    // A sliver of three collinear points between two triangles.
    soup.points = {{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, -1, 0}};
    soup.triangles = {{0, 2, 3}, {2, 1, 3}, {0, 1, 2}, {1, 0, 4}};
    mesh = build_mesh(soup);
    const std::vector<double> distances = geodesic_distances(mesh, {3});
    EXPECT_NEAR(distances[0], std::sqrt(2), 1e-12);
    EXPECT_NEAR(distances[2], 1, 1e-12);
    EXPECT_GE(distances[4], 2 - 1e-12);
    EXPECT_LE(distances[4], 2 * std::sqrt(2) + 1e-12);
}

TEST(Geodesic, ErrorsNameTheProblem) {
    const Mesh mesh = flat(2);
    EXPECT_THROW((void)geodesic_distances(mesh, {}), Error);
    EXPECT_THROW((void)geodesic_distances(mesh, {9}), Error);
    EXPECT_THROW((void)geodesic_distances(mesh, {0}, -1), Error);
    EXPECT_THROW((void)geodesic_distances(mesh, {0}, std::nan("")), Error);
    SurfacePoint nowhere;
    nowhere.kind = SurfacePoint::Kind::face;
    nowhere.element[0] = 99;
    EXPECT_THROW((void)geodesic_distance(mesh, nowhere, vertex_point(0)), Error);
}

TEST(Geodesic, IsRefusedWithoutEnoughMemory) {
    Watch watch;
    watch.memory_limit = resident_memory() + 50e6;
    const WatchScope scope(&watch);
    const Mesh mesh = flat(200);
    try {
        geodesic_distances(mesh, {0});
        ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("of memory"), std::string::npos) << error.what();
        EXPECT_NE(error.remedy().find("along edges"), std::string::npos) << error.remedy();
    }
}

}  // namespace
}  // namespace ostraka
