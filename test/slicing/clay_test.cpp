#include "ostraka/slicing/clay.h"

#include "meshes.h"
#include "scratch.h"

#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"

#include <numbers>

namespace ostraka {
namespace {

constexpr double pi = std::numbers::pi;

/// A cup of revolution about z that stands on its rim: outer radius 10, height 40; the cavity, of radius 7, is seen from below up
/// to `seen` and closed there by a disc, or left open.
TriangleSoup cup(double seen, bool closed, Index around = 360) {
    std::vector<std::array<double, 2>> profile;  // radius, height: from the axis on top, down outside, up inside
    profile = {{0, 40}, {10, 40}, {10, 0}, {7, 0}, {7, seen}};
    if (closed) profile.push_back({0, seen});
    TriangleSoup soup;
    std::vector<std::vector<Index>> rings;
    for (const auto& [r, z] : profile) {
        rings.emplace_back();
        for (Index i = 0; i < (r > 0 ? around : 1); ++i) {
            rings.back().push_back(static_cast<Index>(soup.points.size()));
            const double angle = 2 * pi * i / around;
            soup.points.push_back({r * std::cos(angle), r * std::sin(angle), z});
        }
    }
    for (std::size_t k = 0; k + 1 < rings.size(); ++k)
        for (Index i = 0; i < around; ++i) {
            const Index j = (i + 1) % around;
            const auto& a = rings[k];
            const auto& b = rings[k + 1];
            const auto point_of = [](const std::vector<Index>& ring, Index n) { return ring.size() == 1 ? ring[0] : ring[n]; };
            if (b.size() > 1) soup.triangles.push_back({point_of(a, i), b[i], b[j]});
            if (a.size() > 1) soup.triangles.push_back({a[i], point_of(b, j), a[j]});
        }
    return soup;
}

/// Areas of the polygons that approximate circles.
double disc(double radius, Index around = 360) { return around * radius * radius * std::sin(2 * pi / around) / 2; }

SliceFrame upright() { return slice_frame(Point(0, 0, 0), Vector(0, 0, 1)); }

TEST(Clay, BoundsIncludeUnseenRegions) {
    for (const bool closed : {true, false}) {
        const ClayVolume clay = clay_volume(build_mesh(cup(10, closed)), upright());
        EXPECT_NEAR(clay.envelope, 40 * disc(10), 1e-6 * clay.envelope);
        EXPECT_NEAR(clay.maximum, 40 * disc(10) - 10 * disc(7), 1e-6 * clay.envelope) << closed;
        EXPECT_NEAR(clay.wall_mean, 3, 1e-3);
        // Where nothing is visible: a wall of 3 around a disc of 10, and on top of it.
        EXPECT_NEAR(clay.minimum, 37 * (disc(10) - disc(7)) + 3 * disc(10), 1e-3 * clay.envelope);
        EXPECT_EQ(clay.slices, 400);
        EXPECT_EQ(clay.with_cavity, 100);
        EXPECT_EQ(clay.without_outline, 0);
    }
}

TEST(Clay, ASolidObjectHasNoMinimumUnlessAWallIsGiven) {
    const Mesh ball = build_mesh(test::octahedron_sphere(6));
    const ClayVolume unknown = clay_volume(ball, upright());
    EXPECT_NEAR(unknown.maximum, 4 * pi / 3, 2e-3);
    EXPECT_EQ(unknown.maximum, unknown.envelope);
    EXPECT_TRUE(std::isnan(unknown.minimum));
    ClayOptions options;
    options.wall = 0.1;
    const ClayVolume clay = clay_volume(ball, upright(), options);
    // In slices the wall is measured within the plane; at the poles there is nothing but wall.
    double expected = 0;
    const int n = 100000;
    for (int i = 0; i < n; ++i) {
        const double z = -1 + 2 * (i + 0.5) / n, r = std::sqrt(1 - z * z);
        expected += 2.0 / n * pi * (r > 0.1 && std::abs(z) < 0.9 ? r * r - (r - 0.1) * (r - 0.1) : r * r);
    }
    EXPECT_NEAR(clay.minimum, expected, 3e-3);
    options.wall = 5;
    EXPECT_EQ(clay_volume(ball, upright(), options).minimum, unknown.maximum);
}

TEST(Clay, MinimumIsABoundForSquares) {
    // A box of 10 x 10 x 40 whose wall is 1: 36 a slice, and 100 in the first and the last unit of the height.
    const Mesh box =
        build_mesh({{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {0, 0, 40}, {10, 0, 40}, {10, 10, 40}, {0, 10, 40}},
                    {{0, 2, 1},
                     {0, 3, 2},
                     {4, 5, 6},
                     {4, 6, 7},
                     {0, 1, 5},
                     {0, 5, 4},
                     {1, 2, 6},
                     {1, 6, 5},
                     {2, 3, 7},
                     {2, 7, 6},
                     {3, 0, 4},
                     {3, 4, 7}}});
    ClayOptions options;
    options.wall = 1;
    const ClayVolume clay = clay_volume(box, upright(), options);
    EXPECT_NEAR(clay.maximum, 4000, 1e-6);
    EXPECT_LT(clay.minimum, 1568);
    EXPECT_GT(clay.minimum, 0.8 * 1568);
}

TEST(Clay, IsInvariantToScaleAndPosition) {
    const ClayVolume base = clay_volume(build_mesh(cup(10, true)), upright());
    for (const double scale : {1e-5, 1e5}) {
        TriangleSoup soup = cup(10, true);
        for (auto& p : soup.points)
            for (auto& x : p) x = scale * (x + 1000);
        const ClayVolume moved = clay_volume(build_mesh(soup), upright());
        EXPECT_NEAR(moved.maximum / (scale * scale * scale), base.maximum, 1e-7 * base.maximum);
        EXPECT_NEAR(moved.minimum / (scale * scale * scale), base.minimum, 1e-7 * base.minimum);
    }
}

TEST(Clay, LayersWithoutOutlineAreInterpolated) {
    // A tube with a slit along a part of its height: there the outer contour is open.
    const Index around = 120;
    TriangleSoup soup = test::grid(around, 40, true, false, [](double u, double v) {
        return std::array<double, 3>{5 * std::cos(2 * pi * u), 5 * std::sin(2 * pi * u), 40 * v};
    });
    std::vector<std::array<Index, 3>> triangles;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        const std::size_t quad = t / 2, column = quad % around, row = quad / around;
        if (column != 0 || row < 10 || row >= 20) triangles.push_back(soup.triangles[t]);
    }
    soup.triangles = triangles;
    const ClayVolume clay = clay_volume(build_mesh(soup), upright());
    EXPECT_EQ(clay.without_outline, 100);
    EXPECT_NEAR(clay.maximum, 40 * disc(5, around), 1e-6 * clay.maximum);
}

TEST(Clay, RejectsInvalidInput) {
    EXPECT_THROW(clay_volume(Mesh(), upright()), Error);
    ClayOptions options;
    options.wall = -1;
    EXPECT_THROW(clay_volume(build_mesh(cup(10, true)), upright(), options), Error);
    const ClayVolume flat = clay_volume(build_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}), upright());
    EXPECT_TRUE(std::isnan(flat.maximum));
}

TEST(ClayCommand, ReportsBoundsAndTheirAssumptions) {
    const test::Scratch scratch;
    write_mesh(scratch / "cup.ply", build_mesh(cup(10, true)));
    const auto result = test::run_command("measure clay --unit cm " + (scratch / "cup.ply").string());
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("cm^3"), std::string::npos);
    EXPECT_NE(result.out.find("litres"), std::string::npos) << result.out;  // some 6300 cm^3
    EXPECT_NE(result.out.find("its own volume is"), std::string::npos);
    write_mesh(scratch / "open.ply", build_mesh(cup(10, false)));
    const auto open = test::run_command("measure clay " + (scratch / "open.ply").string());
    EXPECT_NE(open.out.find("the mesh is open"), std::string::npos) << open.out;
    // Unit and upward direction of the annotations.
    const std::string data = OSTRAKA_SOURCE_DIR "/data/";
    const auto specified = test::run_command("measure clay " + data + "vase.ply " + data + "vase.ant.json");
    EXPECT_EQ(specified.code, 0) << specified.err;
    EXPECT_EQ(specified.out, test::run_command("measure clay --unit mm --up z " + data + "vase.ply").out);
    EXPECT_NE(specified.out.find("mm^3"), std::string::npos);
    EXPECT_EQ(test::run_command("measure clay --up 0,0,0 " + (scratch / "cup.ply").string()).code, 2);
    write_mesh(scratch / "ball.ply", build_mesh(test::octahedron_sphere(3)));
    const auto ball = test::run_command("measure clay " + (scratch / "ball.ply").string());
    EXPECT_EQ(ball.code, 0);
    EXPECT_NE((ball.out + ball.err).find("--wall"), std::string::npos);
}

}  // namespace
}  // namespace ostraka
