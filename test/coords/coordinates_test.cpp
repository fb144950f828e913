// Properties common to all kinds: bad input, degenerate input, threads, the list of kinds, deformation.
#include "cages.h"
#include "ostraka/coords/certificate.h"
#include "ostraka/coords/influence.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <cstring>

namespace ostraka {
namespace {

template <class Work>
std::string problem(Work&& work) {
    try {
        (void)work();
    } catch (const Error& error) {
        return error.where() + ": " + error.problem();
    }
    return "accepted";
}
bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Coordinates, InvalidInputIsRejectedWithMessages) {
    const Mesh cage = build_mesh(test::box(1));
    const std::vector<Point> points{{0.5, 0.5, 0.5}};
    for (const char* kind : {"mean-value", "green"}) {
        const auto outcome = [&](const Mesh& mesh, const std::vector<Point>& p) {
            return problem([&] { return compute_coordinates(kind, mesh, p); });
        };
        EXPECT_EQ(outcome(cage, points), "accepted");
        EXPECT_TRUE(contains(outcome(Mesh(), points), "no faces"));
        EXPECT_TRUE(contains(outcome(build_mesh(test::patch(3, 3)), points), "open"));
        EXPECT_TRUE(contains(outcome(cage, {{0.5, 0.5, 0.5}, {NAN, 0, 0}}), "point 1: is not finite"));
        EXPECT_TRUE(contains(outcome(cage, {{0.5, INFINITY, 0.5}}), "point 0"));
        Mesh broken = cage;
        broken.point(Vertex(3)) = Point(0, NAN, 0);
        EXPECT_TRUE(contains(outcome(broken, points), "vertex 3 is not finite"));
        Mesh flat = cage;
        for (const Vertex v : flat.vertices()) flat.point(v) = Point(1, 2, 3);
        EXPECT_TRUE(contains(outcome(flat, points), "has no extent"));
        Mesh garbage = cage;
        garbage.remove_vertex(garbage.add_vertex(Point(0, 0, 0)));
        EXPECT_TRUE(contains(outcome(garbage, points), "removed"));
        EXPECT_EQ(compute_coordinates(kind, cage, std::vector<Point>()).vertex.rows(), 0);
    }
    EXPECT_TRUE(contains(problem([&] { return compute_coordinates("no-such-kind", cage, points); }), "'no-such-kind'"));
    CoordinateOptions options;
    options.snap = 1;
    EXPECT_TRUE(contains(problem([&] { return compute_coordinates("mean-value", cage, points, options); }), "snap"));
}

/// A box with a further vertex on one of its edges, at `share` of its length (0: at the place of the edge's first vertex), that
/// only one side uses: the triangle between it and the edge has no area.
Mesh with_flat_triangle(double fraction) {
    TriangleSoup soup = test::box(1);
    const auto [u, v, w] = soup.triangles[0];
    const auto &a = soup.points[u], &b = soup.points[v];
    const auto m = static_cast<Index>(soup.points.size());
    soup.points.push_back({a[0] + fraction * (b[0] - a[0]), a[1] + fraction * (b[1] - a[1]), a[2] + fraction * (b[2] - a[2])});
    soup.triangles[0] = {u, m, w};
    soup.triangles.push_back({m, v, w});
    soup.triangles.push_back({u, v, m});
    return build_mesh(test::moved(soup, 0.7, {0.1, 0.2, 0.3}));
}

TEST(Coordinates, AreValidWithFlatTrianglesAndDuplicatePoints) {
    for (const double fraction : {0.3, 0.0}) {
        const Mesh cage = with_flat_triangle(fraction);
        const auto points = test::places(cage);
        const Coordinates c = compute_coordinates("mean-value", cage, points);
        EXPECT_TRUE(c.vertex.allFinite());
        const CoordinateCertificate certificate = certify(c, cage, points);
        EXPECT_LT(certificate.partition, 1e-12);
        EXPECT_LT(certificate.linear, 1e-11);
        EXPECT_LT(*certificate.lagrange, 1e-14);
        std::vector<Point> inside;
        for (const Point& p : points)
            if (p.x() > 0.1 && p.x() < 0.8 && p.y() > 0.2 && p.y() < 0.9 && p.z() > 0.3 && p.z() < 1 &&
                test::distance(cage, p) > 1e-12)
                inside.push_back(p);
        ASSERT_GT(inside.size(), 100U);
        const CoordinateCertificate green = certify(compute_coordinates("green", cage, inside), cage, inside);
        EXPECT_LT(green.partition, 1e-10);
        EXPECT_LT(green.linear, 1e-10);
    }
}

TEST(Coordinates, FarFromTheOrigin) {
    const Mesh cage = build_mesh(test::moved(test::torus(16, 8), 1, {1e9, -2e9, 3e9}));
    std::vector<Point> points;
    for (const Vertex v : cage.vertices()) points.push_back(cage.point(v) + 0.3 * (Point(1e9, -2e9, 3e9) - cage.point(v)));
    const CoordinateCertificate c = certify(compute_coordinates("mean-value", cage, points), cage, points);
    EXPECT_LT(c.partition, 1e-12);
    EXPECT_LT(c.linear, 1e-11);
}

TEST(Coordinates, PointsFarOutsideGiveFiniteWeightsOrAnError) {
    const Mesh cage = build_mesh(test::octahedron_sphere(1));
    for (const double distance : {3.0, 10.0, 100.0, 1e4, 1e8, 1e16, 1e150, 1e300}) {
        try {
            const std::vector<Point> points{{distance, 0.2 * distance, -0.1 * distance}};
            const Coordinates c = compute_coordinates("mean-value", cage, points);
            EXPECT_TRUE(c.vertex.allFinite()) << distance;
            EXPECT_NEAR(c.vertex.sum(), 1, 1e-12 * std::max(1.0, c.vertex.cwiseAbs().sum())) << distance;
            if (distance <= 100) {
                EXPECT_LT(certify(c, cage, points).linear, 1e-6) << distance;
            }
        } catch (const Error& error) {
            EXPECT_TRUE(contains(error.problem(), "no mean value coordinates")) << distance;
            EXPECT_GT(distance, 1e4);
        }
    }
}

TEST(Coordinates, TheSameToTheBitForAnyNumberOfThreads) {
    const Mesh cage = build_mesh(test::torus(24, 10));
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0, 2 * M_PI);
    std::vector<Point> points;
    for (int i = 0; i < 1003; ++i) {
        const double a = unit(random), b = unit(random), r = 2 + 0.6 * std::cos(b);
        points.emplace_back(r * std::cos(a), r * std::sin(a), 0.6 * std::sin(b));
    }
    std::vector<Point> cage_points = points_of(cage);
    for (Point& p : cage_points) p = Point(p.x() + 0.1 * p.y() * p.y(), p.y(), 1.5 * p.z());
    for (const char* kind : {"mean-value", "green"}) {
        std::vector<WeightMatrix> vertex, normal;
        std::vector<std::vector<Point>> moved;
        for (const int count : {1, 2, 3, 7}) {
            set_threads(count);
            const Coordinates c = compute_coordinates(kind, cage, points);
            vertex.push_back(c.vertex);
            normal.push_back(c.normal);
            moved.push_back(deformed(c, cage, cage_points));
        }
        set_threads(0);
        for (std::size_t i = 1; i < vertex.size(); ++i) {
            EXPECT_EQ(std::memcmp(vertex[0].data(), vertex[i].data(), sizeof(double) * std::size_t(vertex[0].size())), 0);
            EXPECT_EQ(normal[0].size(), normal[i].size());
            if (normal[0].size() > 0) {
                EXPECT_EQ(std::memcmp(normal[0].data(), normal[i].data(), sizeof(double) * std::size_t(normal[0].size())), 0);
            }
            EXPECT_EQ(moved[0], moved[i]);
        }
    }
    // A point's coordinates do not depend on its neighbours in the list either.
    const std::vector<Point> reversed(points.rbegin(), points.rend());
    const Coordinates a = compute_coordinates("mean-value", cage, points), b = compute_coordinates("mean-value", cage, reversed);
    EXPECT_EQ(a.vertex, WeightMatrix(b.vertex.colwise().reverse()));
}

TEST(Coordinates, FollowAffineMapsOfTheCage) {
    const Mesh cage = build_mesh(test::torus(16, 8));
    const auto points = test::places(cage);
    const auto map = [](const Point& p) { return Point(2 * p.x() - p.y() + 5, p.y() + 0.5 * p.z(), -p.z() + 0.1 * p.x() - 7); };
    std::vector<Point> moved;
    for (const Vertex v : cage.vertices()) moved.push_back(map(cage.point(v)));
    const Coordinates c = compute_coordinates("mean-value", cage, points);
    const auto result = deformed(c, cage, moved), rest = deformed(c, cage, points_of(cage));
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_LT(std::sqrt((result[i] - map(points[i])).squared_length()), 1e-12);
        EXPECT_LT(std::sqrt((rest[i] - points[i]).squared_length()), 1e-13);
    }
    EXPECT_TRUE(contains(problem([&] { return deformed(c, cage, points); }), "moved points"));
    EXPECT_TRUE(
        contains(problem([&] { return deformed(c, build_mesh(test::box(1)), moved); }), "coordinates of 128 cage vertices"));
}

TEST(Coordinates, AdditionalKindsCanBeRegistered) {
    add_coordinate_kind({"nearest", "all weight on the nearest vertex", true, false,
                         [](const Mesh& cage, const std::vector<Point>& points, const CoordinateOptions&) {
                             Coordinates c;
                             c.vertex.setZero(Eigen::Index(points.size()), Eigen::Index(cage.number_of_vertices()));
                             for (std::size_t i = 0; i < points.size(); ++i) {
                                 Vertex nearest(0);
                                 for (const Vertex v : cage.vertices())
                                     if (CGAL::compare_distance_to_point(points[i], cage.point(v), cage.point(nearest)) ==
                                         CGAL::SMALLER)
                                         nearest = v;
                                 c.vertex(Eigen::Index(i), nearest.idx()) = 1;
                             }
                             return c;
                         }});
    const auto kinds = coordinate_kinds();
    EXPECT_EQ(kinds, (std::vector<std::string>{"mean-value", "green", "harmonic", "local", "positive-mean-value", "nearest"}));
    const Mesh cage = build_mesh(test::box(2));
    const std::vector<Point> points{{0.4, 0.4, 0.4}, {0.9, 0.8, 0.7}};
    const Coordinates c = compute_coordinates("nearest", cage, points);
    EXPECT_EQ(c.kind, "nearest");
    const CoordinateCertificate certificate = certify(c, cage, points);
    EXPECT_EQ(certificate.partition, 0);
    EXPECT_GT(certificate.linear, 0.1);
    EXPECT_EQ(*certificate.lagrange, 0);
    EXPECT_GT(*certificate.edges, 0.1);
    EXPECT_EQ(certificate.dominant_weights_max, 1U);
    EXPECT_FALSE(certificate.holds());
}

TEST(Certificate, MeasuresTheProperties) {
    const Mesh cage = build_mesh(test::box(1));
    const std::vector<Point> points{{0.5, 0.5, 0.5}, {0.2, 0.3, 0.4}, {1.5, 0.5, 0.5}};
    Coordinates c = compute_coordinates("mean-value", cage, points);
    const CoordinateCertificate valid = certify(c, cage, points);
    EXPECT_TRUE(valid.holds());
    EXPECT_LT(*valid.lagrange, 1e-15);
    EXPECT_LT(*valid.edges, 1e-14);
    EXPECT_LT(*valid.on_faces, 1e-14);
    // Only the point outside has negative weights: by hand.
    double negative = 0, sum = 0;
    for (Eigen::Index j = 0; j < 8; ++j)
        if (c.vertex(2, j) < 0) ++negative, sum -= c.vertex(2, j);
    EXPECT_GT(negative, 0);
    EXPECT_DOUBLE_EQ(valid.negative, negative / 24);
    EXPECT_DOUBLE_EQ(valid.negative_rows, 1.0 / 3);
    EXPECT_DOUBLE_EQ(valid.negative_sum, sum);
    EXPECT_EQ(valid.minimum, c.vertex.minCoeff());
    c.vertex(1, 4) += 0.25;
    const CoordinateCertificate invalid = certify(c, cage, points);
    EXPECT_NEAR(invalid.partition, 0.25, 1e-15);
    EXPECT_NEAR(invalid.linear, 0.25 * std::sqrt((cage.point(Vertex(4)) - points[1]).squared_length()) / std::sqrt(3), 1e-15);
    EXPECT_EQ(invalid.worst_linear, 1U);
    EXPECT_FALSE(invalid.holds());
    c.vertex(0, 0) = NAN;
    EXPECT_TRUE(contains(problem([&] { return certify(c, cage, points); }), "point 0 are not finite"));
    EXPECT_TRUE(contains(problem([&] { return certify(c, cage, {{0, 0, 0}}); }), "3 rows"));
}

TEST(Influence, OfAndOn) {
    Coordinates c;
    c.kind = "mean-value";
    c.vertex.resize(3, 3);
    c.vertex << 0.5, 0.75, -0.25, 0.1, 0.2, 0.7, 1, 0, 0;
    EXPECT_EQ(influence_of(c, 2), (std::vector<double>{-0.25, 0.7, 0}));
    EXPECT_EQ(influence_on(c, {0, 2}), (std::vector<double>{1, 0.75, 0}));
    EXPECT_EQ(influence_on(c, {0, 2}, InfluenceMeasure::sum), (std::vector<double>{1.5, 0.75, -0.25}));
    EXPECT_EQ(dominant_weight_counts(c.vertex), (std::vector<Index>{3, 3, 1}));
    EXPECT_EQ(dominant_weight_counts(c.vertex, 0.8), (std::vector<Index>{2, 2, 1}));
    EXPECT_TRUE(contains(problem([&] { return influence_of(c, 3); }), "no cage vertex 3"));
    EXPECT_TRUE(contains(problem([&] { return influence_on(c, {7}); }), "point 7"));
    EXPECT_TRUE(contains(problem([&] { return influence_on(c, {}); }), "none"));
}

}  // namespace
}  // namespace ostraka
