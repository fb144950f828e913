// Small or simple files that would take excessive time or memory if each pair were tested.
#include "ostraka/core/error.h"
#include "ostraka/files/file.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace ostraka;
using namespace ostraka::test;

namespace {

using Place = std::array<double, 3>;

Place on_circle(double turn, double height = 0) {
    // In an oblique plane, so that no coordinate is constant.
    const double x = std::cos(2 * M_PI * turn), y = std::sin(2 * M_PI * turn);
    return {2 * x / 3 - y / 3 + height, 2 * x / 3 + 2 * y / 3, -x / 3 + 2 * y / 3};
}

PolygonSoup polygon(std::vector<Place> points) {
    PolygonSoup soup;
    soup.points = std::move(points);
    for (Index i = 0; i < soup.points.size(); ++i) soup.corners.push_back(i);
    soup.polygon_begin.push_back(static_cast<Index>(soup.points.size()));
    return soup;
}

TriangleSoup fan(Index count, double apex) {
    TriangleSoup soup;
    soup.points.push_back(on_circle(0, 0));
    soup.points[0] = {apex, 0, 0};
    for (Index i = 0; i < count; ++i) soup.points.push_back(on_circle(static_cast<double>(i) / count));
    for (Index i = 0; i < count; ++i) soup.triangles.push_back({0, i + 1, (i + 1) % count + 1});
    return soup;
}

}  // namespace

TEST(BoundedWork, ALargeConvexPolygonHasNoVertexOfHighValence) {
    std::vector<Place> points;
    constexpr Index count = 20000;
    for (Index i = 0; i < count; ++i) points.push_back(on_circle(static_cast<double>(i) / count));
    const TriangulatedSoup result = triangulate(polygon(points));
    EXPECT_EQ(result.soup.triangles.size(), count - 2);
    EXPECT_TRUE(result.notes.empty());
    std::vector<int> valence(count, 0);
    for (const auto& t : result.soup.triangles)
        for (const Index v : t) ++valence[v];
    EXPECT_LT(*std::max_element(valence.begin(), valence.end()), 40);
    const SelfIntersections intersections = self_intersections(result.soup);
    EXPECT_TRUE(intersections.complete);
    EXPECT_TRUE(intersections.pairs.empty());
}

TEST(BoundedWork, PolygonsThatCannotBeTriangulatedTerminate) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> anywhere(0, 1);
    std::vector<Place> line, crossing, one_place(20000, {1, 2, 3});
    for (int i = 0; i < 20000; ++i) {
        const double x = anywhere(random);
        line.push_back({x, 0.3 * x, 0.7 * x});
        crossing.push_back({anywhere(random), anywhere(random), 0.1});
    }
    for (auto* points : {&line, &crossing, &one_place}) {
        const TriangulatedSoup result = triangulate(polygon(*points));
        EXPECT_EQ(result.notes.size(), 1U);
        EXPECT_EQ(diagnose(result.soup).triangles, result.soup.triangles.size());
    }
}

TEST(BoundedWork, AFanAroundOneVertexIsSearchedInFull) {
    for (const double apex : {0.0, 0.4}) {  // flat, and a cone
        const SelfIntersections intersections = self_intersections(fan(20000, apex));
        EXPECT_TRUE(intersections.complete);
        EXPECT_TRUE(intersections.pairs.empty());
    }
    // A triangle folded into the fan intersects those whose directions it covers.
    TriangleSoup folded = fan(1000, 0.4);
    folded.points.push_back(on_circle(0.1001, 0.001));
    folded.points.push_back(on_circle(0.1039, -0.001));
    folded.triangles.push_back({0, 1001, 1002});
    const SelfIntersections intersections = self_intersections(folded);
    EXPECT_TRUE(intersections.complete);
    EXPECT_FALSE(intersections.pairs.empty());
    for (const auto& [a, b] : intersections.pairs) EXPECT_EQ(b, 1000U);
}

TEST(BoundedWork, PairsAroundAVertexIntersectOnlyElsewhere) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    TriangleSoup soup{{{0, 0, 0}}, {}};
    for (Index t = 0; t < 270; ++t) {  // more than are searched pair by pair
        const Place middle{normal(random), normal(random), normal(random)};
        for (int k = 0; k < 2; ++k)
            soup.points.push_back(
                {middle[0] + 0.3 * normal(random), middle[1] + 0.3 * normal(random), middle[2] + 0.3 * normal(random)});
        soup.triangles.push_back({0, 2 * t + 1, 2 * t + 2});
    }
    std::vector<std::pair<Index, Index>> expected;
    for (Index a = 0; a < 270; ++a)
        for (Index b = a + 1; b < 270; ++b)
            if (!self_intersections({soup.points, {soup.triangles[a], soup.triangles[b]}}).pairs.empty())
                expected.emplace_back(a, b);
    EXPECT_GT(expected.size(), 20U);
    EXPECT_EQ(self_intersections(soup).pairs, expected);
}

TEST(BoundedWork, CoincidentPointsAndFacesTerminate) {
    constexpr Index count = 8000;
    TriangleSoup one_place, book{{{0, 0, 0}, {0, 0, 1}}, {}}, apart;
    for (Index i = 0; i < count; ++i) {
        one_place.points.push_back({1, 1, 1});
        one_place.triangles.push_back({i, (i + 1) % count, (i + 2) % count});
        book.points.push_back(on_circle(static_cast<double>(i) / count, 0.3));
        book.triangles.push_back({0, 1, i + 2});
        for (const Place& p : {Place{0, 0, 0}, on_circle(static_cast<double>(i) / count, 0.3),
                               on_circle((static_cast<double>(i) + 0.9) / count, 0.3)})
            apart.points.push_back(p);
        apart.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    EXPECT_EQ(diagnose(one_place).degenerate_triangles, count);
    EXPECT_EQ(diagnose(book).border_edges, 2 * count);
    EXPECT_EQ(diagnose(apart).components.size(), count);
    EXPECT_GE(crack_width(apart), 0);
}

TEST(BoundedWork, NestedShellsTerminate) {
    TriangleSoup soup;
    for (Index i = 0; i < 3000; ++i) {
        const double r = 1 + 0.01 * i;
        for (const Place& p : {Place{r, r, r}, Place{r, -r, -r}, Place{-r, r, -r}, Place{-r, -r, r}}) soup.points.push_back(p);
        const Index b = 4 * i;
        for (const auto& t : {std::array<Index, 3>{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
            soup.triangles.push_back({b + t[0], b + t[1], b + t[2]});
    }
    EXPECT_EQ(diagnose(soup, {.skip_self_intersections = true}).components.size(), 3000U);
}

TEST(BoundedWork, DeclaredCountsWithoutDataAreRefused) {
    const Scratch scratch;
    const auto refused = [&](const std::string& name, const std::string& text) {
        const Path file = scratch / name;
        write_file(file, text);
        try {
            read_polygons(file);
            ADD_FAILURE() << name;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
            EXPECT_FALSE(error.remedy().empty()) << error.what();
        }
    };
    const std::string vertices = "property float x\nproperty float y\nproperty float z\n";
    refused("strips.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" + vertices +
                              "element tristrips 9000000000000000000\nend_header\n0 0 0\n");
    refused("faces.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\n" + vertices +
                             "element face 4294967295\nproperty list uchar uint vertex_indices\nend_header\n");
    refused("counts.off", "OFF\n4294967295 4294967295 0\n0 0 0\n");
    refused("counts.mesh", "MeshVersionFormatted 2\nDimension 3\nVertices\n4294967295\n0 0 0 0\n");
    std::string stl(84, '\0');
    stl.replace(80, 4, "\xFF\xFF\xFF\xFF");
    refused("counts.stl", stl);
}
