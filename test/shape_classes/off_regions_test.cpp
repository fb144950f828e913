#include "ostraka/shape_classes/off_regions.h"

#include "meshes.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

/// The unit square's part below `to` along x, cells of 1/20; `height` above `from`.
Mesh sheet(double to, double from = 2, double height = 0) {
    const auto columns = static_cast<Index>(std::lround(20 * to));
    return build_mesh(test::grid(columns, 20, false, false, [&](double u, double v) {
        const double x = to * u;
        return std::array<double, 3>{x, v, x > from ? height : 0};
    }));
}

TEST(OffRegions, AreWhatTheOtherSurfaceDoesNotReach) {
    const Mesh whole = sheet(1), part = sheet(0.75);
    const SurfaceOff off = surface_off(whole, SurfaceSearch(part), 0.01);
    EXPECT_NEAR(off.share, 0.25, 0.01) << "of 5000 points";
    ASSERT_EQ(off.regions.size(), 1U);
    const OffRegion& region = off.regions.front();
    EXPECT_NEAR(region.share, 0.25, 1e-9);
    EXPECT_NEAR(region.middle.x(), 0.875, 1e-9);
    EXPECT_NEAR(region.middle.y(), 0.5, 1e-9);
    EXPECT_NEAR(region.at.x(), 1 - 0.05 / 3, 1e-9) << "the middle of the last triangles";
    EXPECT_NEAR(region.farthest, 0.25 - 0.05 / 3, 1e-9);
    EXPECT_GT(centroid(part, Face(region.nearest_face)).x(), 0.7);
    EXPECT_GT(centroid(whole, Face(region.face)).x(), 0.95);
    // The other way all of it lies on the other.
    const SurfaceOff back = surface_off(part, SurfaceSearch(whole), 0.01);
    EXPECT_EQ(back.share, 0) << "a sum of nothing";
    EXPECT_NEAR(back.distance, 0, 1e-12);
    EXPECT_TRUE(back.regions.empty());
}

TEST(OffRegions, AreConnectedAndTheLargestComesFirst) {
    const Mesh whole = sheet(1);
    Mesh part = sheet(0.75);
    for (const Vertex v : part.vertices()) {  // now from 0.1 to 0.85
        const Point p = part.point(v);
        part.point(v) = Point(p.x() + 0.1, p.y(), p.z());
    }
    const SurfaceOff off = surface_off(whole, SurfaceSearch(part), 0.001);
    ASSERT_EQ(off.regions.size(), 2U);
    EXPECT_NEAR(off.regions[0].share, 0.15, 1e-9);
    EXPECT_NEAR(off.regions[1].share, 0.1, 1e-9);
    EXPECT_LT(off.regions[1].middle.x(), 0.1);
}

TEST(OffRegions, ASurfaceThatLooksTheOtherWayIsOff) {
    const Mesh whole = sheet(1);
    Mesh turned = whole;
    for (const Vertex v : turned.vertices()) {  // mirrored in place: normals look down
        const Point p = turned.point(v);
        turned.point(v) = Point(1 - p.x(), p.y(), p.z());
    }
    const SurfaceOff off = surface_off(whole, SurfaceSearch(turned), 0.01);
    EXPECT_NEAR(off.share, 1, 1e-9);
    EXPECT_NEAR(off.distance, 0, 1e-12);
    ASSERT_EQ(off.regions.size(), 1U);
    EXPECT_NEAR(off.regions.front().share, 1, 1e-12);
}

}  // namespace
}  // namespace ostraka
