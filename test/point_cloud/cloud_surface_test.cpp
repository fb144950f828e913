// Surfaces of clouds with attributes: Poisson, trimming, outliers, carried colours.
#include "ostraka/point_cloud/cloud_surface.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace ostraka {
namespace {

/// Random points of the unit sphere above `lowest`, moved by `shift`, with their normals; red where x is positive, else blue.
PointCloud coloured_cap(std::size_t count, double lowest, const Vector& shift) {
    Random random(7);
    PointCloud cloud;
    while (cloud.points.size() < count) {
        Vector p(random.normal(), random.normal(), random.normal());
        p = p / std::sqrt(p.squared_length());
        if (p.z() < lowest) continue;
        cloud.points.push_back(CGAL::ORIGIN + p + shift);
        cloud.normals.push_back(p);
        cloud.colours.push_back(p.x() > 0 ? Colour{200, 0, 0, 255} : Colour{0, 0, 100, 255});
        cloud.intensities.push_back(p.z());
    }
    return cloud;
}

TEST(CloudSurface, PoissonOfABallFarFromTheOrigin) {
    const Vector shift(650000, 5600000, 200);
    const PointCloud cloud = coloured_cap(3000, -1, shift);
    const CloudSurface surface = poisson_surface(cloud);
    EXPECT_EQ(surface.border_loops, 0U);
    EXPECT_EQ(test::euler_number(surface.mesh), 2);
    EXPECT_NEAR(surface_area(surface.mesh), 4 * M_PI, 0.03 * 4 * M_PI);
    for (const Vertex v : surface.mesh.vertices())
        EXPECT_NEAR(std::sqrt((surface.mesh.point(v) - CGAL::ORIGIN - shift).squared_length()), 1, 0.03);
    const Face first(0);
    EXPECT_GT(area_vector(surface.mesh, first) * (centroid(surface.mesh, first) - CGAL::ORIGIN - shift), 0) << "looks out";
}

TEST(CloudSurface, PoissonDoesNotDependOnAddresses) {
    const PointCloud cloud = coloured_cap(1500, -1, {0, 0, 0});
    const std::string expected = mesh_checksum(poisson_surface(cloud).mesh);
    std::vector<std::unique_ptr<char[]>> kept;
    for (const std::uint64_t seed : {1, 2, 3}) {
        Random random(seed);
        std::vector<std::unique_ptr<char[]>> blocks;
        for (int i = 0; i < 60'000; ++i) blocks.push_back(std::make_unique<char[]>(16 + 8 * random.below(24)));
        random.shuffle(blocks);
        kept.insert(kept.end(), std::make_move_iterator(blocks.begin()), std::make_move_iterator(blocks.begin() + 20'000));
        blocks.clear();
        EXPECT_EQ(mesh_checksum(poisson_surface(cloud).mesh), expected) << seed;
    }
}

TEST(CloudSurface, TrimmingOpensWhatThePointsLeaveOpen) {
    const PointCloud cloud = coloured_cap(3000, 0, {0, 0, 0});
    CloudSurface surface = poisson_surface(cloud);
    const double before = surface_area(surface.mesh), spacing = point_spacing(cloud.points);
    const double trimmed = trim_surface(surface, cloud.points, 3 * spacing);
    EXPECT_GT(trimmed, 0.5) << "the bottom that Poisson closes";
    EXPECT_NEAR(surface_area(surface.mesh), before - trimmed, 1e-9);
    EXPECT_NEAR(surface_area(surface.mesh), 2 * M_PI, 0.2 * 2 * M_PI);
    EXPECT_EQ(surface.border_loops, 1U);
    EXPECT_EQ(trim_surface(surface, cloud.points, 1e9), 0);
    EXPECT_THROW(trim_surface(surface, {Point(100, 0, 0)}, 1), Error);
}

TEST(CloudSurface, ColoursAndIntensitiesOfTheNearestPoints) {
    PointCloud cloud;
    cloud.points = {Point(0, 0, 0), Point(4, 0, 0), Point(0, 0, 100)};
    cloud.colours = {{100, 0, 0, 255}, {200, 0, 60, 255}, {0, 0, 0, 0}};
    cloud.intensities = {1, 5, std::nan("")};
    TriangleSoup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 0, 99}};
    soup.triangles = {{0, 1, 2}};
    const MeshExtras extras = carried_to_vertices(cloud, build_mesh(soup), 2);
    ASSERT_EQ(extras.vertex_colours.size(), 3U);
    EXPECT_EQ(extras.vertex_colours[0], (Colour{100, 0, 0, 255})) << "at a point";
    EXPECT_EQ(extras.vertex_colours[1], (Colour{125, 0, 15, 255})) << "weights 3/4 and 1/4";
    EXPECT_GT(extras.vertex_colours[2][0], 100) << "the nearest point has no colour";
    ASSERT_EQ(extras.vertex_values.size(), 1U);
    EXPECT_EQ(extras.vertex_values[0].name, "intensity");
    EXPECT_DOUBLE_EQ(extras.vertex_values[0].values[0], 1);
    EXPECT_DOUBLE_EQ(extras.vertex_values[0].values[1], 2);
    cloud.colours.clear();
    cloud.intensities.clear();
    EXPECT_TRUE(carried_to_vertices(cloud, build_mesh(soup)).vertex_colours.empty());
}

TEST(CloudSurface, OutliersAreRemovedWithTheirAttributes) {
    PointCloud cloud = coloured_cap(500, -1, {0, 0, 0});
    cloud.points.insert(cloud.points.begin() + 100, Point(5, 5, 5));
    cloud.normals.insert(cloud.normals.begin() + 100, Vector(1, 0, 0));
    cloud.colours.insert(cloud.colours.begin() + 100, Colour{9, 9, 9, 255});
    cloud.intensities.insert(cloud.intensities.begin() + 100, 9);
    const PointCloud before = coloured_cap(500, -1, {0, 0, 0});
    EXPECT_EQ(remove_outliers(cloud, 5), 1U);
    EXPECT_EQ(cloud.points, before.points);
    EXPECT_EQ(cloud.colours, before.colours);
    EXPECT_EQ(cloud.intensities, before.intensities);
    EXPECT_THROW(remove_outliers(cloud, 0.5), Error);
    PointCloud few;
    few.points.assign(5, Point(0, 0, 0));
    EXPECT_THROW(remove_outliers(few, 3), Error);
}

TEST(CloudSurface, PointsWithoutASurfaceAreRefused) {
    PointCloud cloud;
    cloud.points.assign(100, Point(1, 2, 3));
    cloud.normals.assign(100, Vector(0, 0, 1));
    EXPECT_THROW(poisson_surface(cloud), Error);
    EXPECT_THROW(poisson_surface(PointCloud()), Error);
    PoissonOptions options;
    options.edge = 0;
    EXPECT_THROW(poisson_surface(coloured_cap(100, -1, {0, 0, 0}), options), Error);
}

}  // namespace
}  // namespace ostraka
