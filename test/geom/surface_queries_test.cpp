#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/distance.h"
#include "ostraka/geom/polyline_distance.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/geom/surface_trace.h"

#include <gtest/gtest.h>

#include <random>

using namespace ostraka;
using namespace ostraka::test;

TEST(SurfaceSearch, ClosestPointOfEveryCentroidIsItself) {
    for (const auto& [name, soup] : group()) {
        const Mesh mesh = build_mesh(soup);
        const SurfaceSearch search(mesh);
        const double diagonal = box_diagonal(mesh);
        for (const Face f : mesh.faces()) {
            const SurfaceHit hit = search.closest(centroid(mesh, f));
            EXPECT_LE(hit.distance, 1e-9 * diagonal) << name;
            EXPECT_NEAR(distance(point_at(mesh, hit.face, hit.barycentric), hit.point), 0, 1e-12 * diagonal) << name;
        }
    }
}

TEST(SurfaceSearch, LineThroughASphereIntersectsItTwice) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    const SurfaceSearch search(mesh);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> uniform(-0.5, 0.5);
    for (int i = 0; i < 200; ++i) {
        const Point origin(uniform(random), uniform(random), uniform(random));
        Vector direction(uniform(random), uniform(random), uniform(random));
        direction = direction / std::sqrt(direction.squared_length());
        const auto hits = search.line_hits(origin, direction, 3);
        ASSERT_EQ(hits.size(), 2U);
        EXPECT_LT(hits[0].distance * hits[1].distance, 0);  // one in each direction
        EXPECT_LE(std::abs(hits[0].distance), std::abs(hits[1].distance));
        for (const SurfaceHit& hit : hits) {
            EXPECT_NEAR(distance(hit.point, origin + hit.distance * direction), 0, 1e-9);
            EXPECT_NEAR(std::sqrt((hit.point - CGAL::ORIGIN).squared_length()), 1, 0.01);
        }
    }
}

TEST(SurfaceSearch, InsideIsDeterminedByRays) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> uniform(-1.2, 1.2);
    for (const auto& [scale, shift] : {std::pair(1.0, 0.0), std::pair(1e-6, 0.0), std::pair(1e6, 3e6)}) {
        // A bowl: two shells, the space between them is inside; with one face missing.
        TriangleSoup soup = octahedron_sphere(5);
        const std::size_t n = soup.points.size(), m = soup.triangles.size();
        for (std::size_t k = 0; k < n; ++k)
            soup.points.push_back({0.7 * soup.points[k][0], 0.7 * soup.points[k][1], 0.7 * soup.points[k][2]});
        for (std::size_t k = 0; k < m; ++k) {
            const auto t = soup.triangles[k];
            soup.triangles.push_back({static_cast<Index>(t[0] + n), static_cast<Index>(t[2] + n), static_cast<Index>(t[1] + n)});
        }
        soup.triangles.erase(soup.triangles.begin() + 3);
        for (auto& p : soup.points)
            for (double& x : p) x = scale * x + shift;
        const Mesh mesh = build_mesh(soup);
        const SurfaceSearch search(mesh);
        for (int k = 0; k < 300; ++k) {
            const Vector p(uniform(random), uniform(random), uniform(random));
            const double r = std::sqrt(p.squared_length());
            if (std::abs(r - 1) < 0.01 || std::abs(r - 0.7) < 0.01) continue;
            EXPECT_EQ(search.inside(Point(shift, shift, shift) + scale * p), r > 0.7 && r < 1) << r;
        }
    }
}

TEST(SurfaceSearch, CompatibleNormalChoosesTheSheet) {
    // A flat box: from just above the lower sheet, an upward normal finds the upper one.
    TriangleSoup soup = box(8);
    for (auto& p : soup.points) p[2] *= 0.02;
    const Mesh mesh = build_mesh(soup);
    const SurfaceSearch search(mesh);
    const Point query(0.4, 0.6, 0.001);
    EXPECT_NEAR(search.closest(query).point.z(), 0, 1e-12);
    const auto up = search.closest_compatible(query, Vector(0, 0, 1), 0, 1);
    ASSERT_TRUE(up);
    EXPECT_NEAR(up->point.z(), 0.02, 1e-12);
    EXPECT_FALSE(search.closest_compatible(query, Vector(0, 0, 1), 0, 0.01));
}

TEST(SurfaceSearch, NearestFacesEqualBruteForce) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const auto& [name, soup] : group()) {
        const Mesh mesh = build_mesh(soup);
        const SurfaceSearch search(mesh);
        const CGAL::Bbox_3 box = bounding_box(mesh);
        const double diagonal = box_diagonal(mesh);
        const Point middle((box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2, (box.zmin() + box.zmax()) / 2);
        for (int i = 0; i < 60; ++i) {
            const Point query = middle + 0.7 * diagonal * Vector(uniform(random), uniform(random), uniform(random));
            Vector normal(uniform(random), uniform(random), uniform(random));
            normal = normal / std::sqrt(normal.squared_length());
            const double min_cosine = i % 5 == 0 ? -1 : uniform(random),
                         search_radius = i % 3 == 0 ? 0.2 * diagonal : 2 * diagonal;
            double nearest = std::numeric_limits<double>::infinity();
            for (const Face f : mesh.faces()) {
                if (!(area_vector(mesh, f).squared_length() > 0) || search.normal(f) * normal < min_cosine) continue;
                const auto [a, b, c] = corners(mesh, f);
                const auto place = nearest_barycentric(mesh.point(a), mesh.point(b), mesh.point(c), query);
                nearest = std::min(nearest, distance(point_at(mesh, f, place), query));
            }
            const auto hit = search.closest_compatible(query, normal, min_cosine, search_radius);
            ASSERT_EQ(hit.has_value(), nearest <= search_radius) << name;
            if (!hit) continue;
            EXPECT_NEAR(hit->distance, nearest, 1e-12 * diagonal) << name;
            EXPECT_GE(search.normal(hit->face) * normal, min_cosine - 1e-12) << name;
        }
    }
}

TEST(SurfaceSearch, RefusesAMeshWithoutArea) {
    TriangleSoup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    soup.triangles = {{0, 1, 2}};
    const Mesh mesh = build_mesh(soup);
    EXPECT_THROW(SurfaceSearch{mesh}, Error);
}

TEST(NearestBarycentric, IsNearestAmongManyPointsOfTheTriangle) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int i = 0; i < 200; ++i) {
        const auto point = [&] { return Point(uniform(random), uniform(random), uniform(random)); };
        const Point a = point(), b = point(), c = point(), p = point();
        const auto w = nearest_barycentric(a, b, c, p);
        EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-12);
        const auto at = [&](double u, double v) { return a + u * (b - a) + v * (c - a); };
        const double best = distance(p, at(w[1], w[2]));
        for (int u = 0; u <= 20; ++u)
            for (int v = 0; u + v <= 20; ++v) EXPECT_GE(distance(p, at(u / 20.0, v / 20.0)), best - 1e-12);
    }
}

TEST(PathSearch, EuclideanPathsAreNoShorterThanStraightAndObeyTheTriangleInequality) {
    const Mesh mesh = build_mesh(torus(40, 20));
    PathSearch search(mesh);
    const auto length = [&](const std::vector<Index>& path) {
        double sum = 0;
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            EXPECT_NE(find_halfedge(mesh, Vertex(path[i]), Vertex(path[i + 1])), Mesh::null_halfedge());
            sum += distance(mesh.point(Vertex(path[i])), mesh.point(Vertex(path[i + 1])));
        }
        return sum;
    };
    std::mt19937_64 random(5);
    for (int i = 0; i < 50; ++i) {
        const auto pick = [&] { return Vertex(static_cast<Index>(random() % mesh.number_of_vertices())); };
        const Vertex a = pick(), b = pick(), c = pick();
        const double ab = length(search.find(a, b, {})), bc = length(search.find(b, c, {})), ac = length(search.find(a, c, {}));
        EXPECT_GE(ab, distance(mesh.point(a), mesh.point(b)) - 1e-12);
        EXPECT_LE(ac, ab + bc + 1e-9);
        EXPECT_NEAR(ab, length(search.find(b, a, {})), 1e-9);
    }
}

TEST(PathSearch, BlockedAndUnreachableGiveNoPath) {
    const Mesh mesh = build_mesh(joined(octahedron_sphere(2), moved(octahedron_sphere(2), 1, {5, 0, 0})));
    PathSearch search(mesh);
    const auto far = static_cast<Index>(mesh.number_of_vertices() - 1);
    EXPECT_TRUE(search.find(Vertex(0), Vertex(far), {}).empty());
    PathSearch::Query walled;
    walled.blocked = [](Vertex) { return true; };
    EXPECT_TRUE(search.find(Vertex(0), Vertex(1), walled).empty());
    PathSearch::Query short_one;
    short_one.limit = 0.1;
    EXPECT_TRUE(search.find(Vertex(0), Vertex(1), short_one).empty());
    EXPECT_EQ(search.find(Vertex(3), Vertex(3), {}), std::vector<Index>{3});
    EXPECT_THROW(path_metric("manhattan"), Error);
}

TEST(PathSearch, SegmentMetricStaysCloserToTheSegment) {
    const Mesh mesh = build_mesh(patch(40, 40));
    PathSearch search(mesh);
    const Vertex a(0), b(static_cast<Index>(15 * 41 + 40));
    const auto stray = [&](PathMetric metric) {
        PathSearch::Query query;
        query.metric = metric;
        double worst = 0;
        for (const Index v : search.find(a, b, query))
            worst = std::max(worst, distance_to_segment(mesh.point(Vertex(v)), mesh.point(a), mesh.point(b)));
        return worst;
    };
    EXPECT_LE(stray(PathMetric::segment), stray(PathMetric::euclidean) + 1e-12);
}

TEST(TraceLine, IsStraightOnAPlaneAndStaysInTheNamedFaces) {
    TriangleSoup soup = patch(13, 11);
    for (auto& p : soup.points) p[2] = 0;
    const Mesh mesh = build_mesh(soup);
    const SurfaceSearch search(mesh);
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> uniform(0.01, 0.99);
    for (int i = 0; i < 200; ++i) {
        const auto node = [&](bool at_vertex) {
            if (at_vertex) return vertex_point(static_cast<Index>(random() % mesh.number_of_vertices()));
            const SurfaceHit hit = search.closest(Point(uniform(random), uniform(random), 0));
            return surface_point(mesh, hit.face, hit.barycentric);
        };
        const SurfacePoint from = node(i % 2 == 0), to = node(i % 3 == 0);
        const double straight = distance(position(mesh, from), position(mesh, to));
        const auto curve = trace_line(mesh, from, to, Vector(0, 0, 1), 2 * straight + 1);
        ASSERT_TRUE(curve) << i;
        EXPECT_NEAR(curve->length(mesh), straight, 1e-4) << i;
        ASSERT_EQ(curve->faces.size() + 1, curve->points.size());
        for (std::size_t k = 0; k < curve->faces.size(); ++k)
            for (const std::size_t end : {k, k + 1}) {
                const Point p = position(mesh, curve->points[end]);
                const auto [a, b, c] = corners(mesh, Face(curve->faces[k]));
                const auto w = nearest_barycentric(mesh.point(a), mesh.point(b), mesh.point(c), p);
                EXPECT_NEAR(distance(point_at(mesh, curve->faces[k], w), p), 0, 1e-6);
            }
    }
}

TEST(TraceLine, GivesUpAtTheBorderAndAtTheLimit) {
    const Mesh mesh = build_mesh(joined(patch(5, 5), moved(patch(5, 5), 1, {3, 0, 0})));
    const SurfacePoint from = vertex_point(7), to = vertex_point(36 + 7);
    EXPECT_FALSE(trace_line(mesh, from, to, Vector(0, 0, 1), 100));
    EXPECT_FALSE(trace_line(mesh, vertex_point(0), vertex_point(35), Vector(0, 0, 1), 0.01));
}

TEST(HausdorffDistance, KnownAnswers) {
    const Segments a{{Point(0, 0, 0), Point(1, 0, 0)}}, b{{Point(0, 2, 0), Point(1, 2, 0)}}, c{{Point(0, 0, 0), Point(5, 0, 0)}};
    EXPECT_DOUBLE_EQ(hausdorff_distance(a, b), 2);
    EXPECT_DOUBLE_EQ(hausdorff_distance(a, c), 4);
    EXPECT_DOUBLE_EQ(hausdorff_distance(a, a), 0);
    EXPECT_DOUBLE_EQ(hausdorff_distance({}, {}), 0);
    EXPECT_TRUE(std::isinf(hausdorff_distance(a, {})));
    const Segments point{{Point(3, 4, 0), Point(3, 4, 0)}}, origin{{Point(0, 0, 0), Point(0, 0, 0)}};
    EXPECT_DOUBLE_EQ(hausdorff_distance(point, origin), 5);
}
