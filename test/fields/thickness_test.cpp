#include "ostraka/fields/thickness.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/fields/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace ostraka {
namespace {

Mesh sphere(int level, double r, double shift = 0) {
    TriangleSoup soup = test::octahedron_sphere(level);
    for (auto& p : soup.points)
        for (double& c : p) c = shift + r * c;
    return build_mesh(soup);
}

/// Two spheres, the inner one inside out: a wall.
Mesh shell(int level, double outer, double inner) {
    TriangleSoup soup = test::octahedron_sphere(level);
    const Index count = static_cast<Index>(soup.points.size());
    const std::size_t faces = soup.triangles.size();
    for (Index i = 0; i < count; ++i) {
        auto p = soup.points[i];
        for (double& c : p) c *= inner;
        soup.points.push_back(p);
        for (double& c : soup.points[i]) c *= outer;
    }
    for (std::size_t f = 0; f < faces; ++f) {
        const auto& [a, b, c] = soup.triangles[f];
        soup.triangles.push_back({a + count, c + count, b + count});
    }
    return build_mesh(soup);
}

TEST(Thickness, OfABallIsItsDiameterBySmallCones) {
    for (const auto& [r, shift] : {std::pair{1.0, 0.0}, {1e-6, 0.0}, {1e6, 0.0}, {1.0, 1e5}}) {
        const Mesh mesh = sphere(4, r, shift);
        ThicknessOptions options;
        options.cone = 5;
        for (const double t : thickness(mesh, options)) ASSERT_NEAR(t, 2 * r, 0.01 * 2 * r);
    }
    // Wider cones see shorter chords: 2 r cos of the angle.
    const Mesh mesh = sphere(4, 1);
    const std::vector<double> wide_cone = thickness(mesh);
    for (const double t : wide_cone) {
        ASSERT_GT(t, 2 * 0.9);
        ASSERT_LT(t, 2);
    }
}

TEST(Thickness, OfAWall) {
    const Mesh mesh = shell(4, 1, 0.9);
    ThicknessOptions options;
    options.cone = 20;
    std::vector<double> values = thickness(mesh, options);
    const Statistics summary = statistics(values, std::vector<double>(values.size(), 1));
    EXPECT_NEAR(summary.median, 0.1, 0.004);
    EXPECT_LT(summary.max, 0.115);
    EXPECT_GT(summary.min, 0.09);
}

TEST(Thickness, EndsAtTheFirstOfSeveralWalls) {
    TriangleSoup walls = to_soup(shell(5, 1, 0.99));
    const TriangleSoup inner = to_soup(shell(5, 0.985, 0.975));
    const Index first = static_cast<Index>(walls.points.size());
    walls.points.insert(walls.points.end(), inner.points.begin(), inner.points.end());
    for (const auto& [a, b, c] : inner.triangles) walls.triangles.push_back({a + first, b + first, c + first});
    ThicknessOptions options;
    options.cone = 5;
    for (const double t : thickness(build_mesh(walls), options)) ASSERT_NEAR(t, 0.01, 0.001);
}

TEST(Thickness, OpenFlatEmpty) {
    const Mesh flat = build_mesh(test::grid(4, 4, false, false, [](double u, double v) {
        return std::array<double, 3>{u, v, 0};
    }));
    for (const double t : thickness(flat)) EXPECT_TRUE(std::isnan(t));
    for (const double t : vertices_from_faces(flat, thickness(flat))) EXPECT_TRUE(std::isnan(t));
    EXPECT_TRUE(thickness(Mesh()).empty());
    ThicknessOptions invalid;
    invalid.rays = 0;
    EXPECT_THROW((void)thickness(flat, invalid), Error);
    EXPECT_THROW((void)vertices_from_faces(flat, {1.0}), Error);
    for (const double x : vertices_from_faces(flat, std::vector<double>(32, 7.5))) EXPECT_DOUBLE_EQ(x, 7.5);
}

TEST(Thickness, SameBitsForAnyNumberOfThreads) {
    const Mesh mesh = shell(3, 1, 0.8);
    set_threads(1);
    const std::vector<double> sequential = thickness(mesh);
    set_threads(3);
    EXPECT_EQ(sequential, thickness(mesh));
    set_threads(0);
}

TEST(Statistics, KnownAnswers) {
    const Statistics uniform = statistics({4, 1, 3, 2}, {1, 1, 1, 1});
    EXPECT_EQ(uniform.count, 4U);
    EXPECT_DOUBLE_EQ(uniform.mean, 2.5);
    EXPECT_DOUBLE_EQ(uniform.median, 2.5);
    EXPECT_DOUBLE_EQ(uniform.deviation, std::sqrt(1.25));
    EXPECT_DOUBLE_EQ(uniform.min, 1);
    EXPECT_DOUBLE_EQ(uniform.max, 4);
    EXPECT_DOUBLE_EQ(uniform.integral, 10);
    const Statistics weighted = statistics({1, 100}, {3, 1});
    EXPECT_DOUBLE_EQ(weighted.mean, 25.75);
    EXPECT_DOUBLE_EQ(weighted.median, 1);
    EXPECT_DOUBLE_EQ(weighted.percentile_95, 100);
    // Large similar values keep their spread; zero weights are ignored, unless all are zero.
    EXPECT_NEAR(statistics({1e9, 1e9 + 1}, {1, 1}).deviation, 0.5, 1e-9);
    EXPECT_DOUBLE_EQ(statistics({1, 5, 1000}, {1, 1, 0}).max, 5);
    EXPECT_DOUBLE_EQ(statistics({1, 5}, {0, 0}).mean, 3);
    EXPECT_DOUBLE_EQ(quantile({1, 2, 3}, {1, 1, 1}, 0), 1);
    EXPECT_DOUBLE_EQ(quantile({1, 2, 3}, {1, 1, 1}, 1), 3);
}

TEST(Statistics, OverRegions) {
    const Mesh mesh = build_mesh(test::grid(8, 8, false, false, [](double u, double v) {
        return std::array<double, 3>{u, v, 0};
    }));
    std::vector<double> x, faces(mesh.number_of_faces());
    for (const Vertex v : mesh.vertices()) x.push_back(mesh.point(v).x());
    for (const Face f : mesh.faces()) faces[f] = centroid(mesh, f).x();
    std::vector<Index> all_faces(mesh.number_of_faces());
    std::iota(all_faces.begin(), all_faces.end(), Index{0});
    const Statistics vertex = vertex_statistics(mesh, x, all_faces);
    EXPECT_NEAR(vertex.mean, 0.5, 1e-14);  // linear maps are integrated exactly
    EXPECT_NEAR(vertex.weight, 1, 1e-14);
    EXPECT_EQ(vertex.count, 81U);
    EXPECT_NEAR(vertex.integral, 0.5, 1e-14);
    EXPECT_THROW((void)vertex_statistics(mesh, faces, all_faces), Error);
    EXPECT_THROW((void)vertex_statistics(mesh, x, {}), Error);
    EXPECT_THROW((void)vertex_statistics(mesh, x, {128}), Error);
    x[0] = std::nan("");
    EXPECT_THROW((void)vertex_statistics(mesh, x, all_faces), Error);
    EXPECT_NO_THROW((void)vertex_statistics(mesh, x, {127})) << "the gap lies outside of the region";
    EXPECT_THROW((void)statistics({}, {}), Error);
    EXPECT_THROW((void)statistics({1}, {-1}), Error);
    EXPECT_THROW((void)statistics({1}, {1, 2}), Error);
    EXPECT_THROW((void)quantile({1}, {1}, 2), Error);
}

}  // namespace
}  // namespace ostraka
