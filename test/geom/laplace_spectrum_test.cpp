#include "ostraka/geom/laplace_spectrum.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/synthetic/make_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

/// A rectangle of 2 x 1, flat or rolled about its shorter side onto a cylinder of this radius.
Mesh sheet(double radius) {
    constexpr Index across = 60, up = 30;
    TriangleSoup soup;
    for (Index i = 0; i <= across; ++i)
        for (Index j = 0; j <= up; ++j) {
            const double x = 2.0 * i / across, y = 1.0 * j / up;
            if (radius > 0) soup.points.push_back({radius * std::cos(x / radius), radius * std::sin(x / radius), y});
            else soup.points.push_back({x, y, 0});
        }
    for (Index i = 0; i < across; ++i)
        for (Index j = 0; j < up; ++j) {
            const Index a = i * (up + 1) + j, b = a + up + 1;
            soup.triangles.push_back({a, b, b + 1});
            soup.triangles.push_back({a, b + 1, a + 1});
        }
    return build_mesh(soup);
}

TEST(LaplaceSpectrum, OfABall) {
    MakeOptions how;
    how.vertices = 3000;
    const auto values = laplace_spectrum(make_mesh(synthetic_object("sphere"), how).mesh, 15);
    ASSERT_EQ(values.size(), 15U);
    for (std::size_t k = 0; k < values.size(); ++k)
        EXPECT_NEAR(values[k] / (4 * pi), k < 3 ? 2 : k < 8 ? 6 : 12, k < 3 ? 0.02 : k < 8 ? 0.1 : 0.3) << k;
}

TEST(LaplaceSpectrum, OfARectangleFlatAndBent) {
    // pi^2 (i^2 / 4 + j^2) times the area, 2.
    const std::vector<double> expected{0.5, 2, 2, 2.5, 4, 4.5};
    const auto flat = laplace_spectrum(sheet(0), 6), bent = laplace_spectrum(sheet(0.5), 6);
    ASSERT_EQ(flat.size(), 6U);
    ASSERT_EQ(bent.size(), 6U);
    for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_NEAR(flat[k] / (pi * pi * expected[k]), 1, 0.005) << k;
        EXPECT_NEAR(bent[k] / flat[k], 1, 0.002) << k;
    }
}

TEST(LaplaceSpectrum, IsComputedOnTheLargestComponent) {
    Mesh two = sheet(0);
    const auto alone = laplace_spectrum(two, 4);
    const Vertex a = two.add_vertex(Point(9, 9, 9)), b = two.add_vertex(Point(9.1, 9, 9)), c = two.add_vertex(Point(9, 9.1, 9));
    two.add_face(a, b, c);
    const auto with = laplace_spectrum(two, 4);
    ASSERT_EQ(with.size(), alone.size());
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(with[k], alone[k], 1e-6 * alone[k]);
    EXPECT_TRUE(laplace_spectrum(Mesh(), 4).empty());
    EXPECT_TRUE(laplace_spectrum(sheet(0), 1000).empty()) << "too few vertices for so many";
    EXPECT_THROW(static_cast<void>(laplace_spectrum(sheet(0), 0)), Error);
}

}  // namespace
}  // namespace ostraka
