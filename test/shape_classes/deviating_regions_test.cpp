#include "ostraka/shape_classes/deviating_regions.h"

#include "meshes.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

/// The unit square's part below `max_x` along x, cells of 1/20; `height` above `step_x`.
Mesh sheet(double max_x, double step_x = 2, double height = 0) {
    const auto columns = static_cast<Index>(std::lround(20 * max_x));
    return build_mesh(test::grid(columns, 20, false, false, [&](double u, double v) {
        const double x = max_x * u;
        return std::array<double, 3>{x, v, x > step_x ? height : 0};
    }));
}

TEST(OffRegions, CoverTheAreaOffTheOtherSurface) {
    const Mesh full_sheet = sheet(1), part = sheet(0.75);
    const SurfaceDeviation full_deviation = surface_deviation(full_sheet, SurfaceSearch(part), 0.01);
    EXPECT_NEAR(full_deviation.share, 0.25, 0.01) << "of 5000 points";
    ASSERT_EQ(full_deviation.regions.size(), 1U);
    const DeviatingRegion& region = full_deviation.regions.front();
    EXPECT_NEAR(region.share, 0.25, 1e-9);
    EXPECT_NEAR(region.middle.x(), 0.875, 1e-9);
    EXPECT_NEAR(region.middle.y(), 0.5, 1e-9);
    EXPECT_NEAR(region.at.x(), 1 - 0.05 / 3, 1e-9) << "the middle of the last triangles";
    EXPECT_NEAR(region.farthest, 0.25 - 0.05 / 3, 1e-9);
    EXPECT_GT(centroid(part, Face(region.nearest_face)).x(), 0.7);
    EXPECT_GT(centroid(full_sheet, Face(region.face)).x(), 0.95);
    // In the other direction the whole surface is explained.
    const SurfaceDeviation back_deviation = surface_deviation(part, SurfaceSearch(full_sheet), 0.01);
    EXPECT_EQ(back_deviation.share, 0) << "a sum of nothing";
    EXPECT_NEAR(back_deviation.distance, 0, 1e-12);
    EXPECT_TRUE(back_deviation.regions.empty());
}

TEST(OffRegions, AreConnectedAndTheLargestComesFirst) {
    const Mesh full_sheet = sheet(1);
    Mesh part = sheet(0.75);
    for (const Vertex v : part.vertices()) {  // now from 0.1 to 0.85
        const Point p = part.point(v);
        part.point(v) = Point(p.x() + 0.1, p.y(), p.z());
    }
    const SurfaceDeviation deviation = surface_deviation(full_sheet, SurfaceSearch(part), 0.001);
    ASSERT_EQ(deviation.regions.size(), 2U);
    EXPECT_NEAR(deviation.regions[0].share, 0.15, 1e-9);
    EXPECT_NEAR(deviation.regions[1].share, 0.1, 1e-9);
    EXPECT_LT(deviation.regions[1].middle.x(), 0.1);
}

/// A ball with a smaller one inside, whose surface is oriented inwards if `hollow`.
Mesh ball_with(double radius, bool hollow) {
    TriangleSoup soup = test::octahedron_sphere(4), inner = soup;
    const auto first = static_cast<Index>(soup.points.size());
    for (const auto& p : inner.points) soup.points.push_back({radius * p[0], radius * p[1], radius * p[2]});
    for (const auto& [a, b, c] : inner.triangles)
        soup.triangles.push_back(hollow ? std::array<Index, 3>{first + a, first + c, first + b}
                                        : std::array<Index, 3>{first + a, first + b, first + c});
    return build_mesh(soup);
}

TEST(InsidesOfWalls, AreInwardFacesBehindTheExplainedSurface) {
    const Mesh ball = build_mesh(test::octahedron_sphere(4));
    const SurfaceSearch ball_search(ball);
    for (const double radius : {0.3, 0.6, 0.98}) {
        const Mesh hollow = ball_with(radius, true);
        const std::vector<bool> flags = inner_wall_faces(hollow, ball_search, 0.04);
        for (const Face f : hollow.faces())
            ASSERT_EQ(flags[f], f.idx() >= ball.number_of_faces()) << radius << ", face " << f.idx();
    }
    // An inner ball oriented outwards is not an inner wall; nor is one oriented inwards where the outer surface is missing.
    for (const bool flag : inner_wall_faces(ball_with(0.6, false), ball_search, 0.04)) EXPECT_FALSE(flag);
    Mesh alone = ball_with(0.6, true);
    for (const Vertex v : alone.vertices())
        if (v.idx() < ball.number_of_vertices()) alone.point(v) = alone.point(v) + Vector(5, 0, 0);
    for (const bool flag : inner_wall_faces(alone, ball_search, 0.04)) EXPECT_FALSE(flag);
    // Without deviating faces there is no inner wall.
    for (const bool flag : inner_wall_faces(ball, ball_search, 0.04)) EXPECT_FALSE(flag);
}

TEST(OffRegions, ASurfaceWithOppositeNormalsIsOff) {
    const Mesh upward_sheet = sheet(1);
    Mesh flipped_sheet = upward_sheet;
    for (const Vertex v : flipped_sheet.vertices()) {  // mirrored in place: normals point down
        const Point p = flipped_sheet.point(v);
        flipped_sheet.point(v) = Point(1 - p.x(), p.y(), p.z());
    }
    const SurfaceDeviation deviation = surface_deviation(upward_sheet, SurfaceSearch(flipped_sheet), 0.01);
    EXPECT_NEAR(deviation.share, 1, 1e-9);
    EXPECT_NEAR(deviation.distance, 0, 1e-12);
    ASSERT_EQ(deviation.regions.size(), 1U);
    EXPECT_NEAR(deviation.regions.front().share, 1, 1e-12);
}

}  // namespace
}  // namespace ostraka
