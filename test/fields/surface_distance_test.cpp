#include "ostraka/fields/surface_distance.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <CGAL/squared_distance_3.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ostraka {
namespace {

Mesh moved(TriangleSoup soup, double scale, const std::array<double, 3>& by = {0, 0, 0}) {
    for (auto& p : soup.points)
        for (std::size_t k = 0; k < 3; ++k) p[k] = scale * p[k] + by[k];
    return build_mesh(soup);
}

/// Distances to all triangles, by independent case distinctions: the plane, or the nearest of the three segments.
double brute_distance(const Mesh& mesh, const Point& p) {
    double best = 1e300;
    for (const Face f : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, f);
        best = std::min(
            best, CGAL::to_double(CGAL::squared_distance(p, Kernel::Triangle_3(mesh.point(a), mesh.point(b), mesh.point(c)))));
    }
    return std::sqrt(best);
}

TEST(SurfaceDistance, IsThatOfTheNearestTriangleInsideAndOutside) {
    const Mesh mesh = build_mesh(test::torus(40, 20));
    const SignedDistance torus(mesh);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> in_box(-4, 4);
    for (int i = 0; i < 500; ++i) {
        const Point p(in_box(random), in_box(random), in_box(random) / 3);
        const PlaceDistance d = torus.at(p);
        EXPECT_NEAR(std::abs(d.distance), brute_distance(mesh, p), 1e-13);
        EXPECT_FALSE(d.beyond);
        // Between the faceted and the smooth torus, either sign may be right.
        const double smooth = std::hypot(std::hypot(p.x(), p.y()) - 2, p.z()) - 1;
        if (std::abs(smooth) > 0.03) {
            EXPECT_EQ(d.distance > 0, smooth > 0) << p;
        }
    }
}

TEST(SurfaceDistance, TheSignIsRightAtSharpEdgesAndVertices) {
    // Nearest places are corners and edges of the box, where single face normals would give either sign.
    const Mesh mesh = build_mesh(test::box(1));
    const SignedDistance box(mesh);
    for (const auto& [x, y, z] : {std::array{1.5, 1.5, 1.5}, {-0.2, -0.01, 0.5}, {1.001, 1.5, 0.3}, {-1.0, 0.5, 2.0}})
        EXPECT_GT(box.at(Point(x, y, z)).distance, 0);
    EXPECT_DOUBLE_EQ(box.at(Point(2, 2, 2)).distance, std::sqrt(3.0));
    EXPECT_DOUBLE_EQ(box.at(Point(0.5, 0.5, 0.4)).distance, -0.4);
    EXPECT_EQ(box.at(Point(1, 1, 1)).distance, 0);
}

TEST(SurfaceDistance, PlacesBeyondTheBorderAreMarkedAndHaveNoSide) {
    const Mesh mesh = build_mesh(test::grid(4, 4, false, false, [](double u, double v) { return std::array{u, v, 0.0}; }));
    const SignedDistance sheet(mesh);
    EXPECT_FALSE(sheet.at(Point(0.5, 0.5, -0.2)).beyond);
    EXPECT_DOUBLE_EQ(sheet.at(Point(0.5, 0.5, -0.2)).distance, -0.2);
    EXPECT_TRUE(sheet.at(Point(1.5, 0.5, -0.1)).beyond);
    EXPECT_DOUBLE_EQ(sheet.at(Point(1.3, 0.5, -0.4)).distance, 0.5);
    EXPECT_TRUE(sheet.at(Point(1.5, 0.5, 0)).beyond);
    // On and above the border, the surface has not ended yet.
    EXPECT_FALSE(sheet.at(Point(1, 0.5, 0)).beyond);
    EXPECT_FALSE(sheet.at(Point(1, 0.5, -0.3)).beyond);
    EXPECT_DOUBLE_EQ(sheet.at(Point(1, 0.5, -0.3)).distance, -0.3);
}

TEST(SurfaceDistance, ShiftScaleAndThreadsDoNotMatter) {
    const SurfacePlace one{Point(0.3, 1.9, 0.7), 0, {1, 0, 0}};
    const Mesh mesh = build_mesh(test::torus(40, 20));
    const double plain = SignedDistance(mesh).at(one.place).distance;
    for (const double scale : {1e-6, 1.0, 1e6}) {
        const Mesh other = moved(test::torus(40, 20), scale, {1e3 * scale, -2e3 * scale, 0});
        const Point place(scale * 1000.3, scale * -1998.1, scale * 0.7);
        EXPECT_NEAR(SignedDistance(other).at(place).distance / scale, plain, 1e-12 * 2000);
    }
    const auto places = evenly_spread_places(mesh, {}, 5000);
    const Mesh ball = build_mesh(test::octahedron_sphere(3));
    set_threads(1);
    const auto alone = distances_of(places, SignedDistance(ball));
    set_threads(4);
    const auto together = distances_of(places, SignedDistance(ball));
    set_threads(0);
    for (std::size_t i = 0; i < alone.size(); ++i) ASSERT_EQ(alone[i].distance, together[i].distance);
}

TEST(SurfaceDistance, PlacesAreSpreadByArea) {
    const Mesh mesh = moved(test::box(3), 2);
    const auto places = evenly_spread_places(mesh, {}, 6000);
    ASSERT_EQ(places.size(), 6000U);
    std::array<double, 3> sum{};
    int top = 0;
    for (const SurfacePlace& at : places) {
        EXPECT_NEAR(std::sqrt(CGAL::squared_distance(point_at(mesh, at.face, at.weights), at.place)), 0, 1e-15);
        for (int k = 0; k < 3; ++k) sum[static_cast<std::size_t>(k)] += at.place[k] / 6000;
        if (at.place.z() > 2 - 1e-12) ++top;
    }
    for (const double mean : sum) EXPECT_NEAR(mean, 1, 0.01);
    EXPECT_NEAR(top, 1000, 2);
    std::vector<Index> face{7};
    for (const SurfacePlace& at : evenly_spread_places(mesh, face, 10)) EXPECT_EQ(at.face, 7U);
    EXPECT_THROW(static_cast<void>(evenly_spread_places(mesh, {999}, 10)), Error);
    TriangleSoup flat;
    flat.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    flat.triangles = {{0, 1, 2}};
    EXPECT_TRUE(evenly_spread_places(build_mesh(flat), {}, 10).empty());
    EXPECT_THROW(static_cast<void>(SignedDistance(build_mesh(flat))), Error);
}

TEST(SurfaceDistance, TheFarthestPlaceIsFoundInsideFaces) {
    // A square over a ridge: all vertices of the square are equally far from the roof, its middle is farther.
    TriangleSoup roof;
    roof.points = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, -1}};
    roof.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    TriangleSoup lid;
    lid.points = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    lid.triangles = {{0, 1, 2}, {0, 2, 3}};
    const Mesh below = build_mesh(roof), above = build_mesh(lid);
    const SignedDistance reference(below);
    const auto vertices = vertex_distances(above, reference);
    for (const PlaceDistance& at : vertices) EXPECT_EQ(at.distance, 0);
    const FarthestPlace far = farthest_place(above, vertices, reference);
    EXPECT_NEAR(far.place.distance, std::sqrt(0.5), 1e-3);
    EXPECT_GE(far.bound, std::sqrt(0.5) - 1e-9);
    EXPECT_LE(far.bound, 1.0011 * std::sqrt(0.5));
    EXPECT_NEAR(far.place.place.x(), 0, 0.01);
    const FarthestPlace none = farthest_place(above, vertices, reference, 0);
    EXPECT_GE(none.bound, std::sqrt(0.5) - 1e-12);
    EXPECT_THROW(static_cast<void>(farthest_place(below, vertices, reference)), Error);
}

TEST(SurfaceDistance, ConcentricSpheresHaveOneDistance) {
    const Mesh inner = moved(test::octahedron_sphere(5), 1), outer = moved(test::octahedron_sphere(5), 1.1);
    const SignedDistance reference(inner);
    const auto places = distances_of(evenly_spread_places(outer, {}, 20000), reference);
    const DistanceSummary s = summary_of(places, true, "outer");
    EXPECT_NEAR(s.mean, 0.1, 5e-4);
    EXPECT_NEAR(s.mean_absolute, s.mean, 1e-15);
    EXPECT_NEAR(s.rms * s.rms, s.mean * s.mean + s.deviation * s.deviation, 1e-12);
    EXPECT_EQ(s.raised, s.mean_absolute);
    EXPECT_EQ(s.lowered, 0);
    const ToleranceShares t = tolerance_shares(places, 0.05, true);
    EXPECT_EQ(t.above, 1);
    EXPECT_EQ(t.within + t.below + t.beyond, 0);
    EXPECT_EQ(tolerance_shares(places, 0.2, true).within, 1);
    const auto quantiles = quantile_places(places, {0.5, 1}, true, "outer");
    std::size_t not_farther = 0;
    for (const PlaceDistance& at : places)
        if (std::abs(at.distance) <= std::abs(quantiles[0].distance)) ++not_farther;
    EXPECT_GE(not_farther, places.size() / 2);
    EXPECT_EQ(quantiles[1].distance, s.highest);
}

TEST(SurfaceDistance, PlacesBeyondTheBorderCanBeLeftOut) {
    const auto sheet = [](double width) {
        return build_mesh(test::grid(20, 4, false, false, [&](double u, double v) { return std::array{width * u, v, 0.0}; }));
    };
    const Mesh small = sheet(1), large = sheet(2);
    const auto places = distances_of(evenly_spread_places(large, {}, 1000), SignedDistance(small));
    const DistanceSummary all = summary_of(places, true, "large"), over = summary_of(places, false, "large");
    EXPECT_NEAR(static_cast<double>(all.beyond), 500, 4);
    EXPECT_NEAR(all.mean_absolute, 0.25, 5e-3);
    EXPECT_NEAR(all.mean, 0, 1e-12);
    EXPECT_EQ(over.places, 1000U - all.beyond);
    EXPECT_NEAR(over.mean_absolute, 0, 1e-12);
    EXPECT_NEAR(tolerance_shares(places, 0.5, true).beyond, 0.25, 0.01);
    std::vector<PlaceDistance> beyond;
    for (const PlaceDistance& at : places)
        if (at.beyond) beyond.push_back(at);
    EXPECT_THROW(static_cast<void>(summary_of(beyond, false, "large")), Error);
}

TEST(SurfaceDistance, VerticesWithoutFacesHaveNoDistance) {
    TriangleSoup soup = test::octahedron_sphere(1);
    soup.points.push_back({5, 5, 5});
    const Mesh mesh = build_mesh(soup);
    const auto distances = vertex_distances(mesh, SignedDistance(mesh));
    EXPECT_TRUE(std::isnan(distances.back().distance));
    for (std::size_t i = 0; i + 1 < distances.size(); ++i) EXPECT_EQ(distances[i].distance, 0);
    EXPECT_NEAR(farthest_place(mesh, distances, SignedDistance(mesh)).place.distance, 0, 1e-12);
}

}  // namespace
}  // namespace ostraka
