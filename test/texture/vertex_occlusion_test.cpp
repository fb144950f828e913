#include "ostraka/texture/vertex_occlusion.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

/// A square whose middle strip lies at the bottom of a groove with upright walls: 0.2 wide and `depth` deep.
Mesh grooved(double depth) {
    const std::array<double, 6> x{-1, -0.1, -0.1, 0.1, 0.1, 1}, z{0, 0, -depth, -depth, 0, 0};
    TriangleSoup soup;
    const Index rows = 41;
    for (Index j = 0; j < rows; ++j)
        for (std::size_t i = 0; i < 6; ++i) {
            soup.points.push_back({x[i], 4.0 * j / (rows - 1) - 2, z[i]});
            if (i == 2) soup.points.push_back({0, 4.0 * j / (rows - 1) - 2, -depth});
        }
    for (Index j = 0; j + 1 < rows; ++j)
        for (Index i = 0; i < 6; ++i) {
            const Index a = 7 * j + i, b = a + 1, c = b + 7, d = a + 7;
            soup.triangles.push_back({a, b, c});
            soup.triangles.push_back({a, c, d});
        }
    return build_mesh(soup);
}

TEST(VertexOcclusion, OfAConvexSurfaceIsOpen) {
    for (const double share : vertex_occlusion(build_mesh(test::octahedron_sphere(3)))) EXPECT_EQ(share, 1);
    const Mesh sheet = build_mesh(test::grid(4, 4, false, false, [](double u, double v) { return std::array{u, v, 0.0}; }));
    for (const double share : vertex_sky_view(sheet, Vector(0, 0, 1))) EXPECT_EQ(share, 1);
}

TEST(VertexOcclusion, AtTheBottomOfALongGrooveIsThatOfItsAngle) {
    // Seen from the middle, the opening spans an angle of 2 t with tan t = 0.1 / depth.
    for (const double depth : {0.05, 0.1, 0.3}) {
        const Mesh mesh = grooved(depth);
        const std::size_t middle = 20 * 7 + 3;
        const double t = std::atan2(0.1, depth);
        VertexOcclusionOptions options;
        options.rays = 4096;
        options.distance = 1;
        EXPECT_NEAR(vertex_occlusion(mesh, options)[middle], std::sin(t), 0.02) << depth;  // form factor of a long slit
        EXPECT_NEAR(vertex_sky_view(mesh, Vector(0, 0, 3), options)[middle], 2 * t / M_PI, 0.02) << depth;  // share of a lune
    }
}

TEST(VertexOcclusion, IsTheSameForAnyThreadsAndChecksItsInput) {
    const Mesh mesh = grooved(0.2);
    set_threads(1);
    const auto alone = vertex_occlusion(mesh);
    set_threads(3);
    EXPECT_EQ(vertex_occlusion(mesh), alone);
    set_threads(0);
    TriangleSoup soup = to_soup(mesh);
    soup.points.push_back({9, 9, 9});
    EXPECT_TRUE(std::isnan(vertex_occlusion(build_mesh(soup)).back()));
    EXPECT_THROW(static_cast<void>(vertex_sky_view(mesh, Vector(0, 0, 0))), Error);
    EXPECT_THROW(static_cast<void>(vertex_occlusion(mesh, {0, 0.5})), Error);
}

}  // namespace
}  // namespace ostraka
