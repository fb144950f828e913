#include "ostraka/io/diagnose.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "soups.h"

#include <gtest/gtest.h>

#include <random>

using namespace ostraka;
using namespace ostraka::soups;

namespace {
bool sound(const MeshDiagnosis& d) { return d.defects().empty(); }
}  // namespace

TEST(Diagnose, CubeHasNoDefectAndKnownMeasures) {
    const auto d = diagnose(cube());
    EXPECT_TRUE(sound(d)) << d.defects().front();
    EXPECT_EQ(d.vertices, 8u);
    EXPECT_EQ(d.triangles, 12u);
    EXPECT_EQ(d.edges, 18u);
    EXPECT_EQ(d.euler(), 2);
    ASSERT_EQ(d.components.size(), 1u);
    EXPECT_EQ(d.components[0].genus(), 0);
    EXPECT_TRUE(d.closed() && d.manifold() && d.oriented());
    EXPECT_DOUBLE_EQ(d.area, 6);
    EXPECT_DOUBLE_EQ(d.volume, 1);
    EXPECT_DOUBLE_EQ(d.diagonal, std::sqrt(3.0));
    EXPECT_DOUBLE_EQ(d.shortest_edge, 1);
    EXPECT_DOUBLE_EQ(d.longest_edge, std::sqrt(2.0));
    for (const double side : d.oriented_box.sides) EXPECT_NEAR(side, 1, 1e-9);
}

TEST(Diagnose, MeasuresFollowScaleAndPlace) {
    for (const double scale : {1e-9, 1e-3, 1.0, 1e6})
        for (const double far : {0.0, 1e4}) {
            const auto d = diagnose(moved(cube(), scale, {far * scale, -far * scale, far * scale}));
            EXPECT_TRUE(sound(d)) << scale << " " << far << " " << d.defects().front();
            EXPECT_NEAR(d.area / (scale * scale), 6, 1e-6);
            EXPECT_NEAR(d.volume / (scale * scale * scale), 1, 1e-6);
        }
}

TEST(Diagnose, TorusHasOneHandle) {
    const auto d = diagnose(torus());
    EXPECT_TRUE(sound(d));
    EXPECT_EQ(d.euler(), 0);
    EXPECT_EQ(d.components.at(0).genus(), 1);
}

TEST(Diagnose, OpenCubeHasOneBorderLoopOfKnownLength) {
    auto s = cube();
    s.triangles.erase(s.triangles.begin(), s.triangles.begin() + 2);  // the bottom
    const auto d = diagnose(s);
    EXPECT_FALSE(sound(d));
    EXPECT_FALSE(d.closed());
    EXPECT_EQ(d.border_edges, 4u);
    ASSERT_EQ(d.border_loops.size(), 1u);
    EXPECT_EQ(d.border_loops[0].edges, 4u);
    EXPECT_DOUBLE_EQ(d.border_loops[0].length, 4);
    EXPECT_EQ(d.components[0].genus(), -1);
}

TEST(Diagnose, BorderLoopsAreSeparateWhereTheyTouch) {
    auto s = sphere();
    // Two triangles that share one vertex only: two loops of three edges, one vertex with two fans.
    const auto first = s.triangles[24], apex = s.triangles[24];
    std::size_t second = 0;
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
        int shared = 0, at = 0;
        for (const Index v : s.triangles[t])
            for (const Index w : first) shared += v == w, at += v == apex[1] && w == apex[1];
        if (shared == 1 && at == 1) second = t;
    }
    ASSERT_GT(second, 24u);
    s.triangles.erase(s.triangles.begin() + static_cast<std::ptrdiff_t>(second));
    s.triangles.erase(s.triangles.begin() + 24);
    const auto d = diagnose(s);
    EXPECT_EQ(d.border_edges, 6u);
    EXPECT_EQ(d.border_loops.size(), 2u);
    EXPECT_EQ(d.nonmanifold_vertices, 1u);
}

TEST(Diagnose, FlippedTriangleIsFound) {
    auto s = cube();
    flip(s, 5);
    const auto d = diagnose(s);
    EXPECT_EQ(d.misoriented_edges, 3u);
    EXPECT_FALSE(d.oriented());
    EXPECT_EQ(d.nonorientable_components, 0u);
    EXPECT_FALSE(sound(d));
}

TEST(Diagnose, InsideOutAndCavity) {
    auto inner = cube({0.25, 0.25, 0.25}, 0.5);
    for (std::size_t t = 0; t < 12; ++t) flip(inner, t);
    const auto separate_inner = diagnose(inner);
    EXPECT_EQ(separate_inner.inside_out_components, 1u);
    EXPECT_FALSE(sound(separate_inner));
    const auto hollow = diagnose(both(cube(), inner));
    EXPECT_EQ(hollow.cavities, 1u);
    EXPECT_TRUE(sound(hollow)) << hollow.defects().front();
    EXPECT_DOUBLE_EQ(hollow.volume, 1 - 0.125);
    const auto disjoint = diagnose(both(cube({5, 5, 5}), inner));
    EXPECT_EQ(disjoint.inside_out_components, 1u);
}

TEST(Diagnose, MoebiusStripCannotBeOriented) {
    const auto d = diagnose(moebius());
    EXPECT_EQ(d.nonorientable_components, 1u);
    EXPECT_EQ(d.border_loops.size(), 1u);
    EXPECT_EQ(d.nonmanifold_edges + d.nonmanifold_vertices, 0u);
    EXPECT_EQ(d.euler(), 0);
}

TEST(Diagnose, CubesThatShareAnEdgeOrAVertex) {
    const auto edge = diagnose(welded(both(cube(), cube({1, 1, 0}))));
    EXPECT_EQ(edge.nonmanifold_edges, 1u);
    EXPECT_EQ(edge.self_intersections, 0u);
    EXPECT_FALSE(sound(edge));
    const auto vertex = diagnose(welded(both(cube(), cube({1, 1, 1}))));
    EXPECT_EQ(vertex.nonmanifold_edges, 0u);
    EXPECT_EQ(vertex.nonmanifold_vertices, 1u);
    EXPECT_FALSE(sound(vertex));
    // Touching without being joined is not a defect: coincident vertices count as joined.
    const auto touching = diagnose(both(cube(), cube({1, 1, 1})));
    EXPECT_TRUE(sound(touching));
    EXPECT_EQ(touching.duplicate_vertices, 1u);
}

TEST(Diagnose, DuplicatesDegeneratesAndIsolatedVerticesAreCounted) {
    auto s = cube();
    s.triangles.push_back(s.triangles[3]);
    s.triangles.push_back({s.triangles[4][0], s.triangles[4][2], s.triangles[4][1]});
    s.triangles.push_back({0, 0, 1});
    s.points.push_back({9, 9, 9});
    s.points.push_back({0, 0, 0});
    s.points.push_back({0.5, 0, 0});
    s.triangles.push_back({0, 10, 1});
    const auto d = diagnose(s);
    EXPECT_EQ(d.duplicate_triangles, 2u);
    EXPECT_EQ(d.repeated_corners, 1u);
    EXPECT_EQ(d.degenerate_triangles, 1u);
    EXPECT_EQ(d.isolated_vertices, 2u);
    EXPECT_EQ(d.duplicate_vertices, 1u);
    EXPECT_DOUBLE_EQ(d.diagonal, std::sqrt(3.0));  // without the isolated point
}

TEST(Diagnose, EmptySingleTriangleAndPoints) {
    EXPECT_FALSE(sound(diagnose({})));
    EXPECT_FALSE(sound(diagnose({{{0, 0, 0}, {1, 1, 1}}, {}})));
    const auto d = diagnose({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
    EXPECT_EQ(d.border_edges, 3u);
    EXPECT_EQ(d.border_loops.size(), 1u);
    EXPECT_EQ(d.euler(), 1);
    EXPECT_DOUBLE_EQ(d.area, 0.5);
    EXPECT_NEAR(d.oriented_box.sides[2], 0, 1e-12);
}

TEST(Diagnose, BadIndicesAndCoordinatesAreRefused) {
    EXPECT_THROW(diagnose({{{0, 0, 0}}, {{0, 0, 7}}}), Error);
    EXPECT_THROW(diagnose({{{0, 0, NAN}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}), Error);
    EXPECT_THROW(diagnose({{{0, 0, 1e200}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}), Error);
}

// The pairs found with the tree equal those of an exact test of all pairs, away from shared elements.
TEST(SelfIntersections, AgreeWithAllPairsOnRandomTriangles) {
    std::mt19937 random(7);
    for (int trial = 0; trial < 20; ++trial) {
        TriangleSoup s;
        std::uniform_int_distribution<int> coarse(0, 3);  // on a small grid: coplanar, touching and collinear cases abound
        std::uniform_real_distribution<double> fine(0, 3);
        for (int i = 0; i < 40; ++i) {
            for (int k = 0; k < 3; ++k) {
                Place p;
                for (auto& x : p) x = trial % 2 == 0 ? coarse(random) : fine(random);
                s.points.push_back(p);
            }
            const auto v = static_cast<Index>(3 * i);
            s.triangles.push_back({v, v + 1, v + 2});
        }
        std::vector<std::pair<Index, Index>> expected;
        const auto intersections = self_intersections(s).pairs;
        for (Index a = 0; a < 40; ++a)
            for (Index b = a + 1; b < 40; ++b) {
                const auto triangle = [&](Index t) {
                    std::array<Point, 3> p;
                    for (std::size_t k = 0; k < 3; ++k) {
                        const auto& q = s.points[s.triangles[t][k]];
                        p[k] = Point(q[0], q[1], q[2]);
                    }
                    return p;
                };
                const auto p = triangle(a), q = triangle(b);
                if (CGAL::collinear(p[0], p[1], p[2]) || CGAL::collinear(q[0], q[1], q[2])) continue;
                int shared = 0;
                for (const auto& x : p)
                    for (const auto& y : q) shared += x == y;
                const bool listed = std::find(intersections.begin(), intersections.end(), std::pair{a, b}) != intersections.end();
                if (shared == 0) {
                    EXPECT_EQ(listed,
                              CGAL::do_intersect(Kernel::Triangle_3(p[0], p[1], p[2]), Kernel::Triangle_3(q[0], q[1], q[2])))
                        << trial << " " << a << " " << b;
                } else if (shared == 3) {
                    EXPECT_TRUE(listed);
                } else {
                    // The intersection exceeds the shared elements if it contains another point: a proper crossing exists between
                    // one triangle and the other, shrunk slightly away from the shared corners.
                    if (listed) {
                        EXPECT_TRUE(
                            CGAL::do_intersect(Kernel::Triangle_3(p[0], p[1], p[2]), Kernel::Triangle_3(q[0], q[1], q[2])));
                    }
                }
            }
    }
}

TEST(SelfIntersections, SharedVertexAndEdge) {
    const std::vector<Place> p{{0, 0, 0},   {2, 0, 0},  {0, 2, 0},   {1, 1, -1}, {1, 1, 1},
                               {-1, -1, 0}, {-1, 0, 1}, {1, 0.5, 0}, {0, 0, 3}};
    EXPECT_EQ(self_intersections({p, {{0, 1, 2}, {0, 3, 4}}}).pairs.size(), 1u);  // pierces through the far side
    EXPECT_EQ(self_intersections({p, {{0, 1, 2}, {0, 5, 6}}}).pairs.size(), 0u);
    EXPECT_EQ(self_intersections({p, {{0, 1, 2}, {0, 1, 7}}}).pairs.size(), 1u);  // folded onto its neighbour
    EXPECT_EQ(self_intersections({p, {{0, 1, 2}, {1, 0, 8}}}).pairs.size(), 0u);
    EXPECT_EQ(self_intersections({p, {{0, 1, 2}, {1, 0, 2}}}).pairs.size(), 1u);
}

TEST(SelfIntersections, DoNotDependOnThreads) {
    const auto s = both(sphere(20, 40), sphere(20, 40, 1, {0.3, 0.2, 0.1}));
    set_threads(1);
    const auto single_thread = self_intersections(s).pairs;
    set_threads(4);
    const auto four = self_intersections(s).pairs;
    set_threads(0);
    EXPECT_GT(single_thread.size(), 0u);
    EXPECT_EQ(single_thread, four);
}

TEST(SelfIntersections, CountIsBoundedOnStackedTriangles) {
    TriangleSoup s{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}};
    s.triangles.assign(20000, {0, 1, 2});
    const auto intersections = self_intersections(s, 1000);
    EXPECT_FALSE(intersections.complete);
    EXPECT_EQ(intersections.pairs.size(), 1000u);
}

TEST(OrientedBox, IsFoundForATurnedBox) {
    TriangleSoup s = cube();
    const double c = std::cos(0.4), sn = std::sin(0.4);
    for (auto& p : s.points) {
        p[0] *= 5, p[1] *= 2;
        p = {c * p[0] - sn * p[1] + 100, sn * p[0] + c * p[1], p[2]};
        p = {p[0], c * p[1] - sn * p[2], sn * p[1] + c * p[2]};
    }
    const auto box = oriented_box(s.points);
    EXPECT_NEAR(box.sides[0], 5, 0.01);
    EXPECT_NEAR(box.sides[1], 2, 0.01);
    EXPECT_NEAR(box.sides[2], 1, 0.01);
    for (const auto& p : s.points)  // holds every point
        for (std::size_t k = 0; k < 3; ++k) {
            double along = 0;
            for (std::size_t i = 0; i < 3; ++i) along += box.axes[k][i] * (p[i] - box.centre[i]);
            EXPECT_LE(std::abs(along), box.sides[k] / 2 + 1e-9);
        }
}
