#include "ostraka/fields/detection_level.h"

#include "meshes.h"
#include "ostraka/core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ostraka {
namespace {

/// A sphere whose vertices are displaced along the normals by independent noise.
Mesh noisy_sphere(int level, double deviation, unsigned seed,
                  const std::function<double(const std::array<double, 3>&)>& change = {}) {
    TriangleSoup soup = test::octahedron_sphere(level);
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, deviation);
    for (auto& p : soup.points) {
        const double factor = 1 + (deviation > 0 ? noise(random) : 0) + (change ? change(p) : 0);
        for (double& c : p) c *= factor;
    }
    return build_mesh(soup);
}

TEST(ScanNoise, IsTheDeviationOfTheVertices) {
    const double edge = 0.025;
    for (const double deviation : {1e-4, 1e-3, 5e-3}) {
        const Mesh mesh = noisy_sphere(6, deviation, 1);
        const ScanNoise noise = scan_noise(mesh);
        EXPECT_EQ(noise.without, 0U);
        EXPECT_NEAR(noise.median, deviation, 0.15 * deviation + 1e-5);
        EXPECT_LT(noise.correlation, 0.2);
        EXPECT_NEAR(noise.radius, 3 * edge, edge);
    }
}

TEST(ScanNoise, AQuadricHasNoneAndItsCurvature) {
    const Mesh mesh = build_mesh(test::grid(20, 20, false, false, [](double u, double v) {
        return std::array{u - 0.5, v - 0.5, 0.5 * (u - 0.5) * (u - 0.5) + 0.2 * (v - 0.5)};
    }));
    const ScanNoise noise = scan_noise(mesh, 0.2);
    EXPECT_LT(noise.median, 1e-4);
    EXPECT_NEAR(noise.curvature[10 * 21 + 10], 1 / (1 + 0.04), 0.1);
}

TEST(ScanNoise, CorrelatedNoiseIsNamed) {
    // Ripples eight edges long.
    const Mesh mesh = build_mesh(test::grid(100, 100, false, false, [](double u, double v) {
        return std::array{u, v, 0.002 * std::sin(80 * u) * std::sin(75 * v)};
    }));
    const ScanNoise noise = scan_noise(mesh, 0.06);
    EXPECT_GT(noise.correlation, 0.3);
    const auto places = distances_of(evenly_spread_places(mesh, {}, 1000), SignedDistance(mesh));
    const NoisySurface surface(mesh, noise);
    const auto doubts =
        doubts_about(significant_shares(places, detection_levels(places, surface, surface, 0)), surface, surface, 0);
    ASSERT_GE(doubts.size(), 3U);
    EXPECT_NE(doubts[0].find("deviate alike"), std::string::npos);
    EXPECT_NE(doubts.back().find("--registration-error"), std::string::npos);
}

TEST(ScanNoise, TooFewVerticesHaveNone) {
    const Mesh box = build_mesh(test::box(1));
    const ScanNoise noise = scan_noise(box);
    EXPECT_EQ(noise.without, box.number_of_vertices());
    EXPECT_TRUE(std::isnan(noise.median));
    const NoisySurface surface(box, noise);
    const auto places = distances_of(evenly_spread_places(box, {}, 100), SignedDistance(box));
    const SignificantShares shares = significant_shares(places, detection_levels(places, surface, surface, 0));
    EXPECT_EQ(shares.assessed, 0);
    EXPECT_NE(doubts_about(shares, surface, surface, 0).front().find("cannot be assessed"), std::string::npos);
    EXPECT_THROW(static_cast<void>(scan_noise(box, -1)), Error);
    EXPECT_THROW(static_cast<void>(detection_levels(places, surface, surface, -1)), Error);
}

/// Share of the places with significant change between two noisy scans of one sphere.
SignificantShares shares_between(const Mesh& a, const Mesh& b, double registration_error = 0) {
    const ScanNoise noise_a = scan_noise(a), noise_b = scan_noise(b);
    const auto places = distances_of(evenly_spread_places(a, {}, 20000), SignedDistance(b));
    return significant_shares(places, detection_levels(places, {a, noise_a}, {b, noise_b}, registration_error));
}

TEST(DetectionLevel, WithoutChangeAboutFivePercentExceedIt) {
    for (const double deviation : {5e-4, 2e-3}) {
        const SignificantShares none = shares_between(noisy_sphere(6, deviation, 1), noisy_sphere(6, deviation, 2));
        EXPECT_EQ(none.assessed, 1);
        EXPECT_LT(none.above + none.below, 0.07);
        EXPECT_GT(none.above + none.below, 0.002);
    }
    // A coarse mesh of the same sphere differs by its facets only.
    const SignificantShares coarse = shares_between(noisy_sphere(6, 0, 1), noisy_sphere(4, 0, 1));
    EXPECT_LT(coarse.above + coarse.below, 0.05);
}

TEST(DetectionLevel, ChangeAboveTheNoiseIsFoundWithItsSign) {
    const auto cap = [](const std::array<double, 3>& p) { return p[2] > 0.8 ? -0.02 : 0.0; };  // a tenth of the area
    const SignificantShares worn = shares_between(noisy_sphere(6, 1e-3, 1, cap), noisy_sphere(6, 1e-3, 2));
    EXPECT_NEAR(worn.below, 0.1 + 0.9 * 0.025, 0.025);
    EXPECT_LT(worn.above, 0.04);
    const SignificantShares hidden = shares_between(noisy_sphere(6, 1e-3, 1, cap), noisy_sphere(6, 1e-3, 2), 0.02);
    EXPECT_LT(hidden.below, 0.01);
}

}  // namespace
}  // namespace ostraka
