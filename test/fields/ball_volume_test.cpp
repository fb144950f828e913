#include "ostraka/fields/ball_volume.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

TEST(BallVolume, OfASphereIsAnalytic) {
    for (const double scale : {1e-3, 1.0, 1e4}) {
        TriangleSoup soup = test::octahedron_sphere(6);
        for (auto& p : soup.points) p = {scale * p[0] + 100 * scale, scale * p[1], scale * p[2]};
        const Mesh mesh = build_mesh(soup);
        const BallVolumes volumes = ball_volumes(mesh, {0.1 * scale, 0.2 * scale, 0.4 * scale, scale});
        for (std::size_t i = 0; i < mesh.number_of_vertices(); i += 7)
            for (std::size_t k = 0; k < 4; ++k) {
                const double r = std::array{0.1, 0.2, 0.4, 1.0}[k];
                ASSERT_NEAR(volumes.shares[4 * i + k], 0.5 - 3 * r / 16, r < 0.2 ? 3e-3 : r < 1 ? 1e-3 : 2e-3) << r;
            }
    }
}

TEST(BallVolume, OfABoxIsAHalfOnSidesAQuarterAtEdgesAnEighthAtCorners) {
    const Mesh mesh = build_mesh(test::box(24));
    const double r = 0.2;
    const std::vector<double> shares = ball_volumes(mesh, {0.05, r}).at_scale(1);
    ASSERT_EQ(shares.size(), mesh.number_of_vertices());
    for (const Vertex v : mesh.vertices()) {
        int edges = 0, far = 0;  // sides through the vertex; coordinates farther than r from all other sides
        for (int k = 0; k < 3; ++k) {
            const double c = mesh.point(v)[k];
            if (c == 0 || c == 1) ++edges;
            else if (c > r && c < 1 - r) ++far;
        }
        if (edges + far < 3) continue;
        EXPECT_NEAR(shares[v], 1.0 / (1 << edges), 1e-3);
    }
    // The whole box lies in the ball.
    const std::vector<double> whole = ball_volumes(mesh, {3}).shares;
    for (const double share : whole) EXPECT_NEAR(share, 1 / (4 * M_PI / 3 * 27), 3e-3);
}

TEST(BallVolume, AGrooveIsFullerThanARidgeIsEmpty) {
    const auto wave = [](double sign) {
        return build_mesh(test::grid(80, 80, false, false, [&](double u, double v) {
            return std::array{u, v, sign * 0.03 * std::exp(-(u - 0.5) * (u - 0.5) / 0.002)};
        }));
    };
    const double ridge = ball_volumes(wave(1), {0.1}).shares[40 * 81 + 40],
                 groove = ball_volumes(wave(-1), {0.1}).shares[40 * 81 + 40];
    EXPECT_LT(ridge, 0.45);
    EXPECT_NEAR(ridge + groove, 1, 1e-6);
}

TEST(BallVolume, IsUnknownNearTheBorderAndTheSameForAnyThreads) {
    const Mesh sheet = build_mesh(test::grid(20, 20, false, false, [](double u, double v) { return std::array{u, v, 0.0}; }));
    set_threads(1);
    const BallVolumes alone = ball_volumes(sheet, {0.12, 0.32});
    set_threads(3);
    const BallVolumes together = ball_volumes(sheet, {0.12, 0.32});
    set_threads(0);
    for (std::size_t i = 0; i < alone.shares.size(); ++i)
        if (!std::isnan(alone.shares[i])) {
            ASSERT_EQ(alone.shares[i], together.shares[i]);
            EXPECT_NEAR(alone.shares[i], 0.5, 1e-12);
        }
    EXPECT_TRUE(std::isnan(alone.shares[0]));
    EXPECT_FALSE(std::isnan(alone.shares[2 * (5 * 21 + 5)]));
    EXPECT_TRUE(std::isnan(alone.shares[2 * (5 * 21 + 5) + 1]));
}

TEST(BallVolume, RefusesInvalidRadii) {
    const Mesh mesh = build_mesh(test::box(1));
    for (const std::vector<double>& radii : {std::vector<double>{}, {0}, {0.2, 0.1}, {0.1, 0.1}, {-1}})
        EXPECT_THROW(static_cast<void>(ball_volumes(mesh, radii)), Error);
}

}  // namespace
}  // namespace ostraka
