// Triangulation of polygons: the triangles cover the polygon once, name no vertex twice and keep its orientation.
#include "io_examples.h"
#include "polygon_cutter_examples.h"

#include <gtest/gtest.h>
#include <random>

using namespace ostraka;
using namespace ostraka::test;

namespace {

using Point3 = std::array<double, 3>;

PolygonSoup polygon(std::vector<Point3> points) {
    PolygonSoup soup;
    soup.points = std::move(points);
    for (Index i = 0; i < soup.points.size(); ++i) soup.corners.push_back(i);
    soup.polygon_begin.push_back(static_cast<Index>(soup.points.size()));
    return soup;
}

Point3 area_of(const std::vector<Point3>& points, const std::vector<Index>& corners) {
    Point3 sum{0, 0, 0};
    const Point3& o = points[corners[0]];
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
        const Point3 &a = points[corners[i]], &b = points[corners[i + 1]];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
            sum[k] += ((a[u] - o[u]) * (b[v] - o[v]) - (a[v] - o[v]) * (b[u] - o[u])) / 2;
        }
    }
    return sum;
}

double length(const Point3& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

/// A simple polygon in a plane: count, orientation and the sum of areas show that it is covered exactly once.
void expect_exact_cover(const std::vector<Point3>& points, const std::string& name) {
    SCOPED_TRACE(name);
    const PolygonSoup soup = polygon(points);
    const Point3 total_area = area_of(points, soup.corners);
    const auto result = triangulate(PolygonSoup(soup));
    EXPECT_TRUE(result.notes.empty());
    EXPECT_EQ(result.soup.triangles.size(), points.size() - 2);
    double sum = 0;
    for (const auto& t : result.soup.triangles) {
        const Point3 area = area_of(points, {t[0], t[1], t[2]});
        EXPECT_NE(t[0], t[1]);
        EXPECT_NE(t[1], t[2]);
        EXPECT_NE(t[2], t[0]);
        const double along = (area[0] * total_area[0] + area[1] * total_area[1] + area[2] * total_area[2]) / length(total_area);
        EXPECT_GE(along, -1e-12 * length(total_area));
        sum += length(area);
    }
    EXPECT_NEAR(sum, length(total_area), 1e-9 * length(total_area));
}

std::vector<Point3> placed(const std::vector<std::array<double, 2>>& flat, bool mirrored, double scale, const Point3& shift) {
    // Two orthonormal directions of an oblique plane.
    const Point3 u{2.0 / 3, -1.0 / 3, 2.0 / 3}, v{2.0 / 3, 2.0 / 3, -1.0 / 3};
    std::vector<Point3> points;
    for (const auto& p : flat) {
        Point3 q{};
        for (std::size_t k = 0; k < 3; ++k) q[k] = scale * ((mirrored ? -p[0] : p[0]) * u[k] + p[1] * v[k]) + shift[k];
        points.push_back(q);
    }
    return points;
}

}  // namespace

TEST(Triangulate, SimplePolygonsAreCoveredOnce) {
    for (const auto& [name, flat] : flat_polygons())
        for (const bool mirrored : {false, true}) {
            expect_exact_cover(placed(flat, mirrored, 1, {0, 0, 0}), name);
            expect_exact_cover(placed(flat, mirrored, 1e-30, {0, 0, 0}), name + ", tiny");
            expect_exact_cover(placed(flat, mirrored, 1e30, {0, 0, 0}), name + ", huge");
            expect_exact_cover(placed(flat, mirrored, 1, {100, -200, 300}), name + ", far away");
        }
}

TEST(Triangulate, TrianglesKeepTheirCornerOrder) {
    PolygonSoup soup = polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    soup.corners = {2, 0, 1, 1, 3, 2};
    soup.polygon_begin = {0, 3, 6};
    const auto result = triangulate(std::move(soup));
    EXPECT_EQ(result.soup.triangles, (std::vector<std::array<Index, 3>>{{2, 0, 1}, {1, 3, 2}}));
    EXPECT_TRUE(result.polygon_of_triangle.empty());
}

TEST(Triangulate, QuadrilateralsTakeTheShorterDiagonalThatKeepsThemUpright) {
    const auto diagonal = [](const std::vector<Point3>& points) {
        const auto t = triangulate(polygon(points)).soup.triangles;
        EXPECT_EQ(t.size(), 2U);
        return t.size() == 2 && t[0] == std::array<Index, 3>{0, 1, 2} ? 0 : 1;
    };
    EXPECT_EQ(diagonal({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}), 0);     // a tie
    EXPECT_EQ(diagonal({{0, 0, 0}, {2, -1, 0}, {4, 0, 0}, {2, 1, 0}}), 1);    // a rhomb
    EXPECT_EQ(diagonal({{0, 0, 0}, {2, -3, 0}, {1, 0, 0}, {2, 3, 0}}), 0);    // concave at corner 2
    EXPECT_EQ(diagonal({{2, -30, 0}, {1, 0, 0}, {2, 30, 0}, {0, 0, 0}}), 1);  // concave at corner 1
}

TEST(Triangulate, RepeatedCornersGiveNoRepeatedVertices) {
    PolygonSoup soup = polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    soup.corners = {0, 1, 1, 2, /**/ 0, 0, 1, /**/ 0, 1, 2, 1, /**/ 3, 3, 3, 3, 3, /**/ 0, 1, 2, 3, 0};
    soup.polygon_begin = {0, 4, 7, 11, 16, 21};
    soup.extras.face_labels = {10, 11, 12, 13, 14};
    const auto result = triangulate(std::move(soup));
    EXPECT_EQ(result.soup.triangles.front(), (std::array<Index, 3>{0, 1, 2}));
    for (const auto& [a, b, c] : result.soup.triangles) EXPECT_TRUE(a != b && b != c && c != a);
    ASSERT_EQ(result.extras.face_labels.size(), result.soup.triangles.size());
    for (std::size_t t = 0; t < result.soup.triangles.size(); ++t)
        EXPECT_EQ(result.extras.face_labels[t], 10 + static_cast<int>(result.polygon_of_triangle[t]));
    EXPECT_FALSE(result.notes.empty());
}

TEST(Triangulate, APolygonWithABridgeToItsHoleIsCoveredOnce) {
    // A square ring whose outer and inner outline are joined by an edge that is traversed twice.
    PolygonSoup soup = polygon({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}});
    soup.corners = {0, 1, 2, 3, 0, 4, 5, 6, 7, 4};
    soup.polygon_begin = {0, 10};
    const auto result = triangulate(std::move(soup));
    double sum = 0;
    for (const auto& t : result.soup.triangles) sum += area_of(result.soup.points, {t[0], t[1], t[2]})[2];
    EXPECT_EQ(sum, 12);
    EXPECT_EQ(result.soup.triangles.size(), 8U);
    EXPECT_TRUE(result.notes.empty());
}

TEST(Triangulate, CornersFollowTheirTexture) {
    PolygonSoup soup = polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.4, 0}});
    for (Index i = 0; i < 5; ++i) soup.extras.corner_texture.push_back({static_cast<float>(i), 0});
    const auto result = triangulate(std::move(soup));
    ASSERT_EQ(result.extras.corner_texture.size(), 3 * result.soup.triangles.size());
    for (std::size_t t = 0; t < result.soup.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_EQ(result.extras.corner_texture[3 * t + k][0], static_cast<float>(result.soup.triangles[t][k]));
}

TEST(Triangulate, CrossingAndFlatPolygonsTerminateAndAreReported) {
    const auto star = triangulate(polygon(regular_star(7, 3)));
    EXPECT_EQ(star.soup.triangles.size(), 5U);
    EXPECT_FALSE(star.notes.empty());
    std::vector<Point3> line;
    for (int i = 0; i < 9; ++i) line.push_back({1.0 * i, 2.0 * i, -1.0 * i});
    EXPECT_EQ(triangulate(polygon(line)).soup.triangles.size(), 7U);
    EXPECT_EQ(triangulate(polygon(std::vector<Point3>(6, {1, 2, 3}))).soup.triangles.size(), 4U);
    EXPECT_EQ(triangulate(polygon({{1e308, 0, 0}, {-1e308, 0, 0}, {0, 1e308, 0}, {1e307, -1e308, 1e308}, {0, 0, 5e-324}}))
                  .soup.triangles.size(),
              3U);
    EXPECT_TRUE(triangulate(PolygonSoup()).soup.triangles.empty());
}

TEST(Triangulate, LargePolygonsTerminate) {
    // A jagged ring, a spiral and points at random: 120 thousand corners each.
    std::mt19937_64 random(5);
    std::vector<Point3> ring, scatter;
    constexpr int count = 120000;
    for (int i = 0; i < count; ++i) {
        const double a = 2 * M_PI * i / count, r = i % 2 == 0 ? 1 : 0.9;
        ring.push_back({r * std::cos(a), r * std::sin(a), 0});
        scatter.push_back({static_cast<double>(random() % 1000003), static_cast<double>(random() % 1000003), 0});
    }
    expect_exact_cover(ring, "ring");
    expect_exact_cover(placed(spiral(count / 2, 40), false, 1, {0, 0, 0}), "spiral");
    const auto result = triangulate(polygon(scatter));
    EXPECT_EQ(result.soup.triangles.size(), scatter.size() - 2);
    EXPECT_FALSE(result.notes.empty());
}
