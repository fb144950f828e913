#include "ostraka/fields/curvature.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace ostraka {
namespace {

constexpr double pi = std::numbers::pi;

std::vector<Index> every_face(const Mesh& mesh) {
    std::vector<Index> faces(mesh.number_of_faces());
    std::iota(faces.begin(), faces.end(), Index{0});
    return faces;
}

double mean_integral(const Mesh& mesh) {
    return region_curvature(mesh, curvature_integrals(mesh), every_face(mesh)).mean_integral;
}
double gaussian_integral(const Mesh& mesh) {
    return region_curvature(mesh, curvature_integrals(mesh), every_face(mesh)).gaussian_integral;
}

Mesh sphere(int level, double r = 1) {
    TriangleSoup soup = test::octahedron_sphere(level);
    for (auto& p : soup.points)
        for (double& c : p) c *= r;
    return build_mesh(soup);
}

/// A sphere cut at its equator and pulled apart to a capsule of cylinder length `length`.
Mesh capsule(int level, double r, double length) {
    const Index around = Index{8} << level, along = Index{4} << level;
    TriangleSoup soup;
    soup.points.push_back({0, 0, -r - length / 2});
    std::vector<std::pair<double, double>> profile;  // radius, height
    for (Index k = 1; k <= along; ++k) {
        const double t = pi / 2 * k / along;
        profile.emplace_back(r * std::sin(t), -length / 2 - r * std::cos(t));
    }
    for (Index k = 1; k <= along; ++k) profile.emplace_back(r, -length / 2 + length * k / along);
    for (Index k = 1; k < along; ++k) {
        const double t = pi / 2 * k / along;
        profile.emplace_back(r * std::cos(t), length / 2 + r * std::sin(t));
    }
    for (const auto& [radius, height] : profile)
        for (Index i = 0; i < around; ++i)
            soup.points.push_back({radius * std::cos(2 * pi * i / around), radius * std::sin(2 * pi * i / around), height});
    const Index top = static_cast<Index>(soup.points.size());
    soup.points.push_back({0, 0, r + length / 2});
    const auto index_of = [&](Index ring, Index i) { return 1 + ring * around + i % around; };
    const Index rings = static_cast<Index>(profile.size());
    for (Index i = 0; i < around; ++i) {
        soup.triangles.push_back({0, index_of(0, i + 1), index_of(0, i)});
        soup.triangles.push_back({top, index_of(rings - 1, i), index_of(rings - 1, i + 1)});
        for (Index k = 0; k + 1 < rings; ++k) {
            soup.triangles.push_back({index_of(k, i), index_of(k, i + 1), index_of(k + 1, i + 1)});
            soup.triangles.push_back({index_of(k, i), index_of(k + 1, i + 1), index_of(k + 1, i)});
        }
    }
    return build_mesh(soup);
}

Mesh torus(int level, double R, double r) {
    const Index n = Index{8} << level;
    return build_mesh(test::grid(2 * n, n, true, true, [&](double u, double v) {
        const double c = R + r * std::cos(2 * pi * v);
        return std::array<double, 3>{c * std::cos(2 * pi * u), c * std::sin(2 * pi * u), r * std::sin(2 * pi * v)};
    }));
}

Mesh box(int n, double a, double b, double c) {
    TriangleSoup soup = test::box(n);
    for (auto& p : soup.points) p = {a * p[0], b * p[1], c * p[2]};
    return build_mesh(soup);
}

/// The order at which the integrals approach `exact` while the edges halve.
void expect_order_two(const std::function<Mesh(int)>& make, double exact, const std::string& name) {
    std::vector<double> errors;
    for (const int level : {1, 2, 3}) errors.push_back(std::abs(mean_integral(make(level)) - exact) / exact);
    for (std::size_t i = 0; i + 1 < errors.size(); ++i) {
        const double order = std::log2(errors[i] / errors[i + 1]);
        EXPECT_NEAR(order, 2, 0.25) << name << ": " << errors[i] << " then " << errors[i + 1];
        std::cout << name << ": relative error " << errors[i] << " then " << errors[i + 1] << ", order " << order << '\n';
    }
    EXPECT_LT(errors.back(), 0.01) << name;
}

TEST(Curvature, IntegralsOfMeanCurvatureMatchTheClosedForms) {
    const double r = 1.3, R = 3, length = 2.5;
    expect_order_two([&](int level) { return sphere(level + 1, r); }, 4 * pi * r, "sphere");
    expect_order_two([&](int level) { return capsule(level, r, length); }, pi * (length + 4 * r), "capsule");
    expect_order_two([&](int level) { return torus(level, R, r); }, 2 * pi * pi * R, "torus");
    for (const int n : {1, 3, 8}) EXPECT_NEAR(mean_integral(box(n, 1, 2, 5)), pi * 8, 1e-12 * pi * 8);
}

TEST(Curvature, IntegralsOfGaussianCurvatureAreGaussBonnet) {
    EXPECT_NEAR(gaussian_integral(sphere(3)), 4 * pi, 1e-10);
    EXPECT_NEAR(gaussian_integral(box(4, 1, 2, 3)), 4 * pi, 1e-10);
    EXPECT_NEAR(gaussian_integral(torus(1, 3, 1)), 0, 1e-10);
    // Translated far away and scaled, the same up to rounding.
    TriangleSoup soup = to_soup(torus(1, 3, 1));
    for (auto& p : soup.points)
        for (double& c : p) c = 1e-3 * c + 1e3;
    EXPECT_NEAR(mean_integral(build_mesh(soup)), 1e-3 * mean_integral(torus(1, 3, 1)), 1e-9);
}

TEST(Curvature, IntegralsAreAdditiveOverRegions) {
    const Mesh mesh = torus(2, 3, 1);
    const CurvatureIntegrals integrals = curvature_integrals(mesh);
    std::vector<Index> selected, remaining;
    for (const Index f : every_face(mesh)) (f % 3 == 0 ? selected : remaining).push_back(f);
    const RegionCurvature a = region_curvature(mesh, integrals, selected), b = region_curvature(mesh, integrals, remaining),
                          complete = region_curvature(mesh, integrals, every_face(mesh));
    EXPECT_NEAR(a.mean_integral + b.mean_integral, complete.mean_integral, 1e-10);
    EXPECT_NEAR(a.gaussian_integral + b.gaussian_integral, complete.gaussian_integral, 1e-10);
    EXPECT_NEAR(a.area + b.area, complete.area, 1e-10);
    EXPECT_THROW((void)region_curvature(mesh, integrals, {99999999}), Error);
    EXPECT_THROW((void)region_curvature(sphere(1), integrals, {0}), Error);
}

TEST(Curvature, PointValuesOfSphereAndTorus) {
    const Mesh ball = sphere(4, 2);
    for (const double scale : {0.0, 0.05, 0.2}) {
        CurvatureOptions options;
        options.scale = scale;
        const Curvature values = curvature(ball, options);
        for (const Vertex v : ball.vertices()) {
            ASSERT_NEAR(values.mean[v], 0.5, 0.5 * (scale == 0 ? 0.1 : 0.04)) << "scale " << scale;
            ASSERT_NEAR(values.gaussian[v], 0.25, 0.25 * (scale == 0 ? 0.15 : 0.1)) << "scale " << scale;
        }
    }
    const double R = 3, r = 1;
    const Mesh ring = torus(3, R, r);
    CurvatureOptions options;
    options.scale = 0.03;
    const Curvature values = curvature(ring, options);
    for (const Vertex v : ring.vertices()) {
        const Point& p = ring.point(v);
        const double c = (std::hypot(p.x(), p.y()) - R) / r, k = c / (R + r * c);
        ASSERT_NEAR(values.mean[v], (1 / r + k) / 2, 0.03);
        ASSERT_NEAR(values.gaussian[v], k / r, 0.05);
    }
    // With reversed orientation the mean curvature changes its sign, the Gaussian does not.
    TriangleSoup soup = to_soup(ring);
    for (auto& t : soup.triangles) std::swap(t[0], t[1]);
    const Curvature reversed = curvature(build_mesh(soup), options);
    for (const Vertex v : ring.vertices()) {
        EXPECT_NEAR(reversed.mean[v], -values.mean[v], 1e-9);
        EXPECT_NEAR(reversed.gaussian[v], values.gaussian[v], 1e-9);
    }
}

TEST(Curvature, FlatOpenIsolatedAndDegenerate) {
    TriangleSoup soup = test::grid(6, 6, false, false, [](double u, double v) { return std::array<double, 3>{u, v, 0}; });
    soup.points.push_back({7, 7, 7});
    for (const double scale : {0.0, 0.2}) {
        CurvatureOptions options;
        options.scale = scale;
        const Mesh flat = build_mesh(soup);
        const Curvature values = curvature(flat, options);
        for (const Vertex v : flat.vertices()) {
            if (flat.is_isolated(v) || flat.is_border(v)) {
                EXPECT_TRUE(std::isnan(values.mean[v]) && std::isnan(values.gaussian[v]));
                continue;
            }
            EXPECT_NEAR(values.mean[v], 0, 1e-12);
            EXPECT_NEAR(values.gaussian[v], 0, 1e-10);
        }
    }
    EXPECT_TRUE(curvature(Mesh()).mean.empty());
    soup.points = {{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, -1, 0}};
    soup.triangles = {{0, 2, 3}, {2, 1, 3}, {0, 1, 2}, {1, 0, 4}};
    for (const double x : curvature(build_mesh(soup)).mean) EXPECT_TRUE(std::isnan(x) || std::abs(x) < 1e-12);
    CurvatureOptions invalid;
    invalid.scale = -1;
    EXPECT_THROW((void)curvature(sphere(1), invalid), Error);
}

TEST(Curvature, SameBitsForAnyNumberOfThreads) {
    const Mesh mesh = torus(3, 3, 1);
    CurvatureOptions options;
    options.scale = 0.05;
    set_threads(1);
    const Curvature sequential = curvature(mesh, options);
    set_threads(3);
    const Curvature parallel = curvature(mesh, options);
    set_threads(0);
    EXPECT_EQ(sequential.mean, parallel.mean);
    EXPECT_EQ(sequential.gaussian, parallel.gaussian);
}

}  // namespace
}  // namespace ostraka
