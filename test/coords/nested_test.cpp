// Cages within a cage: detection of their nesting, and their combined deformation.
#include "ostraka/coords/nested.h"
#include "meshes.h"
#include "ostraka/cage/cage.h"
#include "ostraka/coords/certificate.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

using test::joined;
using test::moved;

double norm(const Vector& v) { return std::sqrt(v.squared_length()); }

TriangleSoup reversed(TriangleSoup soup) {
    for (auto& triangle : soup.triangles) std::swap(triangle[1], triangle[2]);
    return soup;
}

/// Around a tall tube of unit radius: the whole, and its upper end from z = 2 on.
struct Post {
    Mesh mesh = build_mesh(test::octahedron_sphere(5)), cage;
    std::vector<CageLevel> levels;
    Post() {
        for (const Vertex v : mesh.vertices()) {
            const Point p = mesh.point(v);
            mesh.point(v) = Point(p.x(), p.y(), 4 * p.z());
        }
        TriangleSoup outer = test::box(2), top = test::box(2);
        const auto fit = [](TriangleSoup& soup, const std::array<double, 3>& low, const std::array<double, 3>& high) {
            std::array<double, 3> box_low = soup.points[0], box_high = soup.points[0];
            for (const auto& p : soup.points)
                for (std::size_t k = 0; k < 3; ++k)
                    box_low[k] = std::min(box_low[k], p[k]), box_high[k] = std::max(box_high[k], p[k]);
            for (auto& p : soup.points)
                for (std::size_t k = 0; k < 3; ++k)
                    p[k] = low[k] + (p[k] - box_low[k]) / (box_high[k] - box_low[k]) * (high[k] - low[k]);
        };
        fit(outer, {-2, -2, -5}, {2, 2, 5});
        fit(top, {-1.5, -1.5, 2}, {1.5, 1.5, 4.5});
        cage = build_mesh(joined(outer, top));
        levels = cage_levels(cage);
    }
};

TEST(NestedCages, LevelsFollowFromContainment) {
    const TriangleSoup big = test::octahedron_sphere(2), small = moved(big, 0.4, {0.1, 0, 0}),
                       tiny = moved(big, 0.1, {0.1, 0, 0}), beside = moved(big, 0.3, {0, -0.5, 0}),
                       away = moved(big, 1, {5, 0, 0});
    EXPECT_EQ(cage_levels(build_mesh(big)).size(), 1U);
    EXPECT_EQ(cage_levels(build_mesh(joined(big, away))).size(), 1U);
    EXPECT_EQ(cage_levels(build_mesh(joined(big, reversed(small)))).size(), 1U) << "a cavity is no cage";
    EXPECT_EQ(cage_levels(Mesh()).size(), 1U);
    // In any order in the file.
    const std::vector<CageLevel> levels = cage_levels(build_mesh(joined(joined(tiny, beside), joined(small, joined(big, away)))));
    ASSERT_EQ(levels.size(), 4U);
    const std::size_t n = big.points.size();
    EXPECT_EQ(levels[0].cage.vertices.size(), 2 * n) << "the two outermost together";
    EXPECT_EQ(levels[0].cage.vertices.front(), 3 * n);
    EXPECT_EQ(levels[1].cage.vertices.front(), n) << "in the order of the file";
    EXPECT_EQ(levels[1].parent, 0U);
    EXPECT_EQ(levels[2].cage.vertices.front(), 2 * n);
    EXPECT_EQ(levels[2].parent, 0U);
    EXPECT_EQ(levels[3].cage.vertices.front(), 0U);
    EXPECT_EQ(levels[3].parent, 2U) << "within the small one";
}

TEST(NestedCages, CoordinatesSatisfyTheirPropertiesAndAreLocal) {
    const Post post;
    ASSERT_EQ(post.levels.size(), 2U);
    for (const char* kind : {"mean-value", "harmonic"}) {
        CoordinateOptions options;
        options.nodes = 1500;
        const Coordinates c = compute_coordinates(kind, post.cage, post.mesh, options);
        const CoordinateCertificate certificate = certify(c, post.cage, points_of(post.mesh), options);
        EXPECT_LT(certificate.partition, 1e-12) << kind;
        EXPECT_LT(certificate.linear, 1e-12) << kind;
        EXPECT_TRUE(certificate.holds()) << kind;
        const Coordinates outer = compute_coordinates(kind, post.levels[0].cage.mesh, points_of(post.mesh), options);
        std::size_t outside = 0;
        for (const Vertex v : post.mesh.vertices()) {
            if (post.mesh.point(v).z() > 2) continue;
            ++outside;
            const auto row = static_cast<Eigen::Index>(v.idx());
            for (const Index j : post.levels[1].cage.vertices) ASSERT_EQ(c.vertex(row, j), 0) << kind;
            for (std::size_t j = 0; j < post.levels[0].cage.vertices.size(); ++j)
                ASSERT_EQ(c.vertex(row, post.levels[0].cage.vertices[j]), outer.vertex(row, static_cast<Eigen::Index>(j)));
        }
        EXPECT_GT(outside, 100U);
        // The weights of each level can be recovered.
        const auto carrying = carrying_weights(post.levels);
        const WeightMatrix recovered = weights_of_level(c.vertex, post.levels, carrying, 0);
        EXPECT_LT((recovered - outer.vertex).cwiseAbs().maxCoeff(), 1e-12) << kind;
    }
}

TEST(NestedCages, TheInnerCageMovesOnlyItsPart) {
    const Post post;
    CoordinateOptions options;
    options.fade = 0.2;
    const Coordinates c = compute_coordinates("mean-value", post.cage, post.mesh, options);
    std::vector<Point> handles = points_of(post.cage);
    for (const Index j : post.levels[1].cage.vertices) handles[j] = handles[j] + Vector(0.5, 0, 0.25);
    const std::vector<Point> moved_points = deformed(c, post.cage, handles);
    const double length = 0.2 * box_diagonal(post.levels[1].cage.mesh);
    double largest = 0;
    for (const Vertex v : post.mesh.vertices()) {
        const Point& p = post.mesh.point(v);
        const Vector displacement = moved_points[v] - p;
        if (p.z() <= 2) {
            ASSERT_LT(norm(displacement), 1e-12);
        } else if (p.z() > 2 + length + 0.2) {
            ASSERT_LT(norm(displacement - Vector(0.5, 0, 0.25)), 1e-12);
        }
        largest = std::max(largest, norm(displacement));
    }
    EXPECT_NEAR(largest, std::sqrt(0.25 + 0.0625), 1e-12);
    // Without a fade the influence begins at the border.
    options.fade = 0;
    const std::vector<Point> unfaded =
        deformed(compute_coordinates("mean-value", post.cage, post.mesh, options), post.cage, handles);
    for (const Vertex v : post.mesh.vertices())
        if (post.mesh.point(v).z() > 2) {
            ASSERT_LT(norm(unfaded[v] - post.mesh.point(v) - Vector(0.5, 0, 0.25)), 1e-12);
        }
}

TEST(NestedCages, OtherPartsThatReachInAreNotInfluenced) {
    // Two posts side by side, and a cage around one that also contains a corner of the other.
    const Post post;
    TriangleSoup both = joined(to_soup(post.mesh), moved(to_soup(post.mesh), 1, {2.2, 0, 0}));
    TriangleSoup outer_cage = moved(to_soup(post.levels[0].cage.mesh), 3, {0, 0, 0});
    const Mesh mesh = build_mesh(both), cage = build_mesh(joined(outer_cage, to_soup(post.levels[1].cage.mesh)));
    const std::vector<CageLevel> levels = cage_levels(cage);
    ASSERT_EQ(levels.size(), 2U);
    const Coordinates c = compute_coordinates("mean-value", cage, mesh);
    const std::size_t first = post.mesh.number_of_vertices();
    std::size_t reached = 0;
    for (const Vertex v : mesh.vertices()) {
        const Point& p = mesh.point(v);
        if (v.idx() < first) continue;
        if (p.x() < 1.5 && std::abs(p.y()) < 1.5 && p.z() > 2 && p.z() < 4.5) ++reached;
        for (const Index j : levels[1].cage.vertices) ASSERT_EQ(c.vertex(static_cast<Eigen::Index>(v.idx()), j), 0);
    }
    EXPECT_GT(reached, 0U);
}

TEST(NestedCages, AnyNumberOfThreadsAndFarAway) {
    const Post post;
    set_threads(1);
    const Coordinates sequential = compute_coordinates("mean-value", post.cage, post.mesh);
    set_threads(3);
    EXPECT_EQ(sequential.vertex, compute_coordinates("mean-value", post.cage, post.mesh).vertex);
    set_threads(0);
    for (const double scale : {1e-6, 1e6}) {
        const Mesh mesh = build_mesh(moved(to_soup(post.mesh), scale, {scale * 1e3, 0, 0})),
                   cage = build_mesh(moved(to_soup(post.cage), scale, {scale * 1e3, 0, 0}));
        EXPECT_LT((compute_coordinates("mean-value", cage, mesh).vertex - sequential.vertex).cwiseAbs().maxCoeff(), 1e-6)
            << scale;
    }
}

TEST(NestedCages, RejectsKindsWithNormalTerms) {
    const Post post;
    EXPECT_THROW((void)compute_coordinates("green", post.cage, post.mesh), Error);
}

TEST(NestedCages, EachCageIsCheckedSeparately) {
    const Post post;
    const CageCheck check = check_cage(post.cage, post.mesh);
    EXPECT_TRUE(check.valid());
    EXPECT_EQ(check.nested, 1U);
    EXPECT_EQ(check.components, 2U);
    // An intersection with the outer cage is not a defect of the inner one; being inside out is.
    TriangleSoup crossing = joined(to_soup(post.levels[0].cage.mesh), moved(to_soup(post.levels[1].cage.mesh), 1, {0, 0, 0.8}));
    EXPECT_TRUE(check_cage(build_mesh(crossing), post.mesh).valid());
    // A corner of the inner one pushed out through the opposite corner: its own faces intersect, and are reported by their
    // numbers.
    Mesh folded = post.cage;
    for (const Index v : post.levels[1].cage.vertices)
        if (const Point& p = folded.point(Vertex(v)); p.x() < -1.4 && p.y() < -1.4 && p.z() < 2.1)
            folded.point(Vertex(v)) = Point(1.7, 1.7, 4.7);
    const CageCheck invalid = check_cage(folded, post.mesh);
    EXPECT_EQ(invalid.nested, 1U);
    EXPECT_FALSE(invalid.intersections.empty());
    for (const auto& [f, g] : invalid.intersections) EXPECT_GE(std::min(f, g), post.levels[1].cage.faces.front());
}

}  // namespace
}  // namespace ostraka
