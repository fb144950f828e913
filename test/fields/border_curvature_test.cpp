// Curvature near the border of open surfaces.
#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/fields/curvature.h"
#include "ostraka/fields/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace ostraka {
namespace {

constexpr double pi = std::numbers::pi;

/// The triangles of a sphere of radius 5 whose centres lie above z = 0.
Mesh half_sphere(int level) {
    const TriangleSoup sphere = test::octahedron_sphere(level);
    TriangleSoup half;
    std::vector<Index> number(sphere.points.size(), no_index);
    for (const auto& t : sphere.triangles) {
        if (sphere.points[t[0]][2] + sphere.points[t[1]][2] + sphere.points[t[2]][2] <= 1e-9) continue;
        auto& triangle = half.triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            if (number[t[k]] == no_index) {
                number[t[k]] = static_cast<Index>(half.points.size());
                const auto& p = sphere.points[t[k]];
                half.points.push_back({5 * p[0], 5 * p[1], 5 * p[2]});
            }
            triangle[k] = number[t[k]];
        }
    }
    return build_mesh(half);
}

/// Half a sphere of parallels and meridians.
Mesh half_globe(Index columns, Index rows) {
    TriangleSoup soup = test::grid(columns, rows, true, false, [&](double u, double v) {
        const double t = pi / 2 * (1 - v * rows / (rows + 1.0));
        return std::array<double, 3>{5 * std::sin(t) * std::cos(2 * pi * u), 5 * std::sin(t) * std::sin(2 * pi * u),
                                     5 * std::cos(t)};
    });
    const auto pole = static_cast<Index>(soup.points.size());
    soup.points.push_back({0, 0, 5});
    for (Index i = 0; i < columns; ++i) soup.triangles.push_back({rows * columns + i, rows * columns + (i + 1) % columns, pole});
    return build_mesh(soup);
}

TEST(BorderCurvature, HalfASphereIsASphereOneRingInside) {
    const Mesh half_balls[]{half_sphere(5), half_globe(126, 30)};
    for (const Mesh& mesh : half_balls)
        for (const double scale : {0.0, 0.03, 0.1}) {
            CurvatureOptions options;
            options.scale = scale;
            const Curvature values = curvature(mesh, options);
            double worst = 0;
            // Values of single vertices depend on the shapes of their triangles, also on a closed sphere.
            const double mean_tolerance = scale == 0 ? 0.1 : 0.05, gaussian_tolerance = scale == 0 ? 0.15 : 0.1;
            for (const Vertex v : mesh.vertices()) {
                if (mesh.point(v).z() > 4.5) continue;  // far from the border; thin triangles at the pole of the globe
                if (mesh.is_border(v)) {
                    EXPECT_TRUE(std::isnan(values.mean[v]) && std::isnan(values.gaussian[v]));
                    continue;
                }
                ASSERT_NEAR(values.mean[v], 0.2, 0.2 * mean_tolerance) << "scale " << scale << ", z " << mesh.point(v).z();
                ASSERT_NEAR(values.gaussian[v], 0.04, 0.04 * gaussian_tolerance)
                    << "scale " << scale << ", z " << mesh.point(v).z();
                worst = std::max(worst, std::abs(values.mean[v] / 0.2 - 1));
            }
            std::cout << "scale " << scale << ": mean curvature off by at most " << 100 * worst << " %\n";
        }
}

TEST(BorderCurvature, AnOpenCylinderHasItsCurvatureUpToTheBorder) {
    const Mesh tube = build_mesh(test::grid(90, 40, true, false, [](double u, double v) {
        return std::array<double, 3>{2 * std::cos(2 * pi * u), 2 * std::sin(2 * pi * u), 5 * v};
    }));
    for (const double scale : {0.0, 0.05}) {
        CurvatureOptions options;
        options.scale = scale;
        const Curvature values = curvature(tube, options);
        for (const Vertex v : tube.vertices()) {
            if (tube.is_border(v)) continue;
            ASSERT_NEAR(values.mean[v], 0.25, 0.005);
            ASSERT_NEAR(values.gaussian[v], 0, 1e-6);
        }
    }
}

TEST(BorderCurvature, VerticesWithoutCompleteFacesAndStatistics) {
    // A pyramid of four triangles without its base: every face has a border edge.
    const Mesh pyramid =
        build_mesh({{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}});
    const Curvature values = curvature(pyramid);
    EXPECT_GT(values.mean[4], 0);
    EXPECT_GT(values.gaussian[4], 0);
    EXPECT_TRUE(std::isnan(values.mean[0]));
    std::vector<Index> faces(4);
    std::iota(faces.begin(), faces.end(), Index{0});
    EXPECT_THROW((void)vertex_statistics(pyramid, values.mean, faces), Error);
    EXPECT_DOUBLE_EQ(vertex_statistics(pyramid, values.mean, faces, "map", UndefinedValues::skipped).mean, values.mean[4]);
    const std::vector<double> nowhere(5, std::numeric_limits<double>::quiet_NaN());
    EXPECT_THROW((void)vertex_statistics(pyramid, nowhere, faces, "map", UndefinedValues::skipped), Error);
    const Mesh triangle = build_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
    for (const double x : curvature(triangle).mean) EXPECT_TRUE(std::isnan(x));
}

}  // namespace
}  // namespace ostraka
