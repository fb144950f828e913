#include "ostraka/measure/descriptors.h"

#include "measure/solids.h"
#include "meshes.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/io/repair.h"
#include "ostraka/measure/measure.h"
#include "ostraka/measure/solid.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <limits>
#include <numbers>
#include <numeric>
#include <random>

namespace ostraka {
namespace {

using namespace test;

TEST(OrientedBox, IsExactOnBoxes) {
    for (int seed = 0; seed < 12; ++seed) {
        const double a = 1, b = 1 + seed * 0.3, c = 4 - seed * 0.2;
        const TriangleSoup soup = moved(box(1 + seed % 4, a, b, c), some_rotation(seed), Vector3d(seed, 2 * seed, -seed));
        const OrientedBox computed = oriented_box(soup.points);
        std::array<double, 3> sides{a, b, c};
        std::sort(sides.rbegin(), sides.rend());
        EXPECT_NEAR(computed.volume(), a * b * c, 1e-6 * a * b * c);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(computed.sides[k], sides[k], 1e-6 * sides[0]) << seed;
    }
}

/// The minimum volume over many directions, each with its smallest rectangle by brute force over rotations.
double min_box_by_search(const std::vector<std::array<double, 3>>& points) {
    Eigen::Matrix3Xd p(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
        p.col(static_cast<Eigen::Index>(i)) = Vector3d(points[i][0], points[i][1], points[i][2]);
    const auto volume = [&](const Eigen::Quaterniond& q) {
        const Eigen::Matrix3Xd rotated = q.toRotationMatrix() * p;
        return (rotated.rowwise().maxCoeff() - rotated.rowwise().minCoeff()).prod();
    };
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    double best = std::numeric_limits<double>::infinity();
    for (int start = 0; start < 60; ++start) {  // from random orientations, by random descent
        Eigen::Quaterniond orientation =
            Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized();
        double current = volume(orientation);
        for (double step = 0.3; step > 1e-4;) {
            bool improved = false;
            for (int tries = 0; tries < 12 && !improved; ++tries) {
                const Eigen::Quaterniond next =
                    (Eigen::Quaterniond(1, step * normal(random), step * normal(random), step * normal(random)).normalized() *
                     orientation);
                const double v = volume(next);
                if (v < current) current = v, orientation = next, improved = true;
            }
            if (!improved) step /= 2;
        }
        best = std::min(best, current);
    }
    return best;
}

TEST(OrientedBox, IsWithinOnePercentOfTheMinimum) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (int seed = 0; seed < 8; ++seed) {
        TriangleSoup soup;
        const int kind = seed % 4;
        for (int i = 0; i < 400; ++i) {
            Vector3d p(normal(random), normal(random), normal(random));
            if (kind == 1) p = p.normalized().cwiseProduct(Vector3d(1, 2, 3));           // ellipsoid
            if (kind == 2) p = p.cwiseAbs().cwiseProduct(Vector3d(1, 1.5, 0.7)) / 3;     // a corner
            if (kind == 3) p = Vector3d(std::cos(i), std::sin(i), 0.01 * i) + 0.05 * p;  // a spring
            soup.points.push_back({p[0], p[1], p[2]});
        }
        const auto points = moved(soup, some_rotation(seed + 50), Vector3d::Zero()).points;
        const double minimum = min_box_by_search(points), volume = oriented_box(points).volume();
        EXPECT_LE(volume, 1.01 * minimum) << "kind " << kind;
        RecordProperty("ratio_" + std::to_string(seed), std::to_string(volume / minimum));
    }
}

TEST(Solid, OnlyClosedMeshesHaveAnExactVolume) {
    TriangleSoup soup = box(2, 1, 2, 3);
    EXPECT_NEAR(closed_volume(build_mesh(soup)), 6, 1e-12);
    for (auto& t : soup.triangles) std::swap(t[1], t[2]);
    EXPECT_NEAR(closed_volume(build_mesh(soup)), 6, 1e-12) << "inside out";
    soup.triangles.pop_back();
    EXPECT_TRUE(std::isnan(closed_volume(build_mesh(soup))));
}

TEST(Solid, OpenRegionsAreClosedByTheirOutlines) {
    // A cup: a box without its lid. The outline is planar: the fan closes it exactly and the bound is zero.
    TriangleSoup soup = box(6, 1, 2, 3);
    std::erase_if(soup.triangles, [&](const auto& t) {
        return soup.points[t[0]][2] == 3 && soup.points[t[1]][2] == 3 && soup.points[t[2]][2] == 3;
    });
    RegionSolid solid = region_solid(build_mesh(soup), [&] {
        std::vector<Index> faces(soup.triangles.size());
        std::iota(faces.begin(), faces.end(), Index{0});
        return faces;
    }());
    EXPECT_EQ(solid.outlines, 1U);
    EXPECT_NEAR(solid.volume, 6, 1e-12);
    EXPECT_NEAR(solid.volume_bound, 0, 1e-12);
    EXPECT_NEAR(solid.centroid.z(), 1.5, 1e-12);
    // A cap cut from a sphere by a curved edge: any closing surface inside the hull of its outline stays within the bound.
    const Mesh sphere = build_mesh(test::octahedron_sphere(5));
    std::vector<Index> cap, rest;
    for (const Face f : sphere.faces()) {
        const Point p = centroid(sphere, f);
        (p.z() > 0.3 + 0.2 * p.x() * p.x() - 0.1 * p.y() ? cap : rest).push_back(f);
    }
    const RegionSolid a = region_solid(sphere, cap), b = region_solid(sphere, rest),
                      complete = region_solid(sphere, [&] {
                          std::vector<Index> faces(sphere.number_of_faces());
                          std::iota(faces.begin(), faces.end(), Index{0});
                          return faces;
                      }());
    EXPECT_EQ(a.outlines, 1U);
    EXPECT_NEAR(a.volume + b.volume, complete.volume, 1e-12);  // both are closed by the same fan
    EXPECT_GT(a.volume_bound, 0);
    EXPECT_NEAR(a.volume_bound, b.volume_bound, 1e-12);
    // Another surface over the outline: a fan from one of its vertices.
    const Outline outline = extract_outlines(sphere, cap).front();
    double other_volume = 0;
    for (const Index f : cap) {
        const auto [p, q, r] = corners(sphere, Face(f));
        other_volume += CGAL::cross_product(sphere.point(p) - CGAL::ORIGIN, sphere.point(q) - CGAL::ORIGIN) *
                        (sphere.point(r) - CGAL::ORIGIN) / 6;
    }
    for (std::size_t i = 0; i < outline.size(); ++i)
        other_volume -= CGAL::cross_product(sphere.point(Vertex(outline[i])) - CGAL::ORIGIN,
                                            sphere.point(Vertex(outline[(i + 1) % outline.size()])) - CGAL::ORIGIN) *
                        (sphere.point(Vertex(outline[0])) - CGAL::ORIGIN) / 6;
    EXPECT_GT(std::abs(other_volume - a.volume), 1e-9);
    EXPECT_LE(std::abs(other_volume - a.volume), a.volume_bound);
}

TEST(Solid, HullVolume) {
    EXPECT_EQ(convex_hull_size({}).volume, 0);
    EXPECT_EQ(convex_hull_size({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).volume, 0);
    EXPECT_EQ(convex_hull_size({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.3, 0.2, 0}}).volume, 0);
    EXPECT_EQ(convex_hull_size(std::vector<Point>(5, Point(1, 2, 3))).volume, 0);
    const ConvexHullSize corner = convex_hull_size({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.1, 0.1}});
    EXPECT_NEAR(corner.volume, 1.0 / 6, 1e-15);
    EXPECT_NEAR(corner.area, 1.5 + std::sqrt(3.0) / 2, 1e-15);
}

TEST(Reference, MassPropertiesMeasuredInACadSystem) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "reference-trimesh";
    if (!std::filesystem::exists(folder / "mass_properties.json")) GTEST_SKIP() << folder << " is not here";
    const Json documents = read_json(folder / "mass_properties.json");
    for (const auto& entry : documents.GetArray()) {
        const std::string name = entry["filename"].GetString();
        // The files have seams that must be welded within a tolerance first; volume and centroid do not need that.
        const TriangulatedSoup file = triangulate(read_polygons(folder / name));
        double area = 0, volume = 0;
        Vector3d first = Vector3d::Zero();
        for (const auto& t : file.soup.triangles) {
            std::array<Vector3d, 3> p;
            for (std::size_t k = 0; k < 3; ++k)
                p[k] = Vector3d(file.soup.points[t[k]][0], file.soup.points[t[k]][1], file.soup.points[t[k]][2]);
            area += (p[1] - p[0]).cross(p[2] - p[0]).norm() / 2;
            const double v = p[0].cross(p[1]).dot(p[2]) / 6;
            volume += v;
            first += v * (p[0] + p[1] + p[2]) / 4;
        }
        RepairOptions options;
        options.merge_distance = 1e-4;
        const Mesh mesh = repair(file.soup, file.extras, options).mesh;
        DescriptorSearch search(mesh);
        const Annotation root = whole(mesh);
        const double stated = entry["mass"].GetDouble() / entry["density"].GetDouble();
        EXPECT_NEAR(search.find(root, "area")->values.front(), entry["area"].GetDouble(), 2e-3 * area) << name;
        EXPECT_NEAR(search.find(root, "volume")->values.front(), stated, 2e-3 * stated) << name;
        EXPECT_NEAR(search.find(root, "volume")->values.front(), volume, 1e-3 * volume) << name;
        const auto centre = search.find(root, "solid centroid")->values;
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_NEAR(centre[k], entry["center_mass"][static_cast<unsigned>(k)].GetDouble(), 2e-3) << name;
    }
}

TEST(Reference, VolumesOfBalls) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "reference-trimesh";
    if (!std::filesystem::exists(folder / "boolean.json")) GTEST_SKIP() << folder << " is not here";
    const Json stated = read_json(folder / "boolean.json");
    for (const auto& [file, key] : {std::pair{"ballA.off", "a"}, {"ballB.off", "b"}}) {
        const Mesh mesh = read_mesh(folder / file).mesh;
        EXPECT_NEAR(DescriptorSearch(mesh).find(whole(mesh), "volume")->values.front(), stated[key].GetDouble(),
                    1e-10 * stated[key].GetDouble());
    }
}

TEST(Describe, RegionsLinesPointsAndMaps) {
    const Mesh mesh = build_mesh(test::octahedron_sphere(4));
    DescriptorOptions options;
    options.curvature = options.thickness = true;
    options.thickness_options.cone = 20;
    DescriptorSearch search(mesh, options);
    Annotation region = whole(mesh);
    NamedMap heights{"height", {}, "mm"};
    for (const Vertex v : mesh.vertices()) heights.values.push_back(mesh.point(v).z());
    const auto quantities = search.describe(region, {heights});
    const auto value = [&](const std::string& name) {
        for (const auto& q : quantities)
            if (q.name == name) return q.values.front();
        ADD_FAILURE() << name;
        return std::nan("");
    };
    EXPECT_NEAR(value("mean curvature median"), 1, 0.05);
    EXPECT_NEAR(value("Gaussian curvature median"), 1, 0.1);
    EXPECT_NEAR(value("Gaussian curvature integral"), 4 * std::numbers::pi, 1e-9);
    EXPECT_NEAR(value("thickness median"), 2, 0.05);
    EXPECT_EQ(value("thickness share"), 1);
    EXPECT_NEAR(value("height mean"), 0, 1e-12);
    store(region, quantities, "mm");
    const std::size_t count = region.attributes.size();
    EXPECT_EQ(count, quantities.size());
    store(region, quantities, "mm");
    EXPECT_EQ(region.attributes.size(), count) << "the same names are replaced";
    EXPECT_EQ(region.attributes[0].descriptor()->unit, "mm^2");
    Annotation point;
    point.type = AnnotationType::point;
    point.points = {4};
    EXPECT_EQ(search.describe(point, {heights}).size(), 15U);
    Annotation line;
    line.type = AnnotationType::line;
    line.polylines = {{0, no_index}};
    line.polylines[0][1] = mesh.source(mesh.halfedge(Vertex(0)));
    EXPECT_GT(search.describe(line).front().values.front(), 0);
    // Errors are reported.
    heights.values[3] = std::nan("");
    EXPECT_THROW((void)search.describe(region, {heights}), Error);
    heights.values.pop_back();
    EXPECT_THROW((void)search.describe(region, {heights}), Error);
    EXPECT_THROW((void)search.describe(point, {heights}), Error);
    EXPECT_THROW((void)search.describe(Annotation()), Error);
    EXPECT_FALSE(search.find(region, "roundness"));
    EXPECT_FALSE(search.find(point, "area"));
    EXPECT_EQ(unit_of({"k", {1}, false, -2, ""}, "mm"), "1/mm^2");
    EXPECT_EQ(unit_of({"k", {1}, false, -2, ""}, ""), "");
}

TEST(Describe, UsesFreeIdsBelowTheLargest) {
    Annotation annotation;
    annotation.attributes.emplace_back();
    annotation.attributes[0].id = std::numeric_limits<int>::max();
    store(annotation, {{"a", {1}, false, 0, ""}, {"b", {2}, false, 0, ""}}, "mm");
    ASSERT_EQ(annotation.attributes.size(), 3U);
    EXPECT_EQ(annotation.attributes[1].id, 0);
    EXPECT_EQ(annotation.attributes[2].id, 1);
}

TEST(Uncertainty, OfARulerFollowsFromItsPins) {
    // On a flat grid of unit cells the faces around an inner vertex have three units of area: a third is one.
    const Mesh mesh = build_mesh(test::grid(10, 10, false, false, [](double u, double v) {
        return std::array<double, 3>{10 * u, 10 * v, 0};
    }));
    const Annotation root = whole(mesh);
    const Index a = 5 * 11 + 2, b = 5 * 11 + 8, c = 5 * 11 + 9;
    const double s = 1 / (4 * std::numbers::pi);
    Evaluated measured = evaluate_with_uncertainty(mesh, root, pins("ruler", {a, b}));
    EXPECT_DOUBLE_EQ(measured.value, 6);
    EXPECT_NEAR(measured.uncertainty, std::sqrt(2 * s), 1e-12);
    // A pin in the middle of a straight path does not contribute; at a corner it counts twice.
    EXPECT_NEAR(evaluate_with_uncertainty(mesh, root, pins("ruler", {a, 5 * 11 + 5, b})).uncertainty, std::sqrt(2 * s), 1e-12);
    EXPECT_NEAR(evaluate_with_uncertainty(mesh, root, pins("ruler", {a, b, 2 * 11 + 8})).uncertainty, std::sqrt(4 * s), 1e-12);
    // Repeated picking: the mean, and the variance of the mean added.
    Measure repeated = pins("ruler", {a, b});
    repeated.repeats = {{a, c}};
    measured = evaluate_with_uncertainty(mesh, root, repeated);
    EXPECT_DOUBLE_EQ(measured.value, 6.5);
    EXPECT_EQ(measured.pickings, 2U);
    EXPECT_NEAR(measured.spread, std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(measured.uncertainty, std::sqrt(2 * s + 0.5 / 2), 1e-12);
    EXPECT_DOUBLE_EQ(evaluate(mesh, root, repeated), 6.5);
    Measure bounding = pins("bounding", {a, b, c});
    bounding.direction = {1, 0, 0};
    EXPECT_NEAR(evaluate_with_uncertainty(mesh, root, bounding).uncertainty, std::sqrt(2 * s), 1e-12);
    bounding.direction = {0, 0, 1};
    EXPECT_EQ(evaluate_with_uncertainty(mesh, root, bounding).uncertainty, 0) << "all at one height";
    repeated.repeats = {{a}};
    EXPECT_THROW((void)evaluate(mesh, root, repeated), Error);
}

TEST(Uncertainty, CoversTheErrorOfPickingOnCoarseMeshes) {
    // Two fixed points on a sphere, pinned to the nearest vertices of rotated meshes: the error is nearly always within three
    // times the stated uncertainty, and on average not far below it.
    const Vector3d p(1, 0, 0), q = Vector3d(-0.3, 1, 0.4).normalized();
    const double truth = (p - q).norm();
    double squares = 0;
    int outside = 0;
    const int count = 200;
    for (int seed = 0; seed < count; ++seed) {
        const Mesh mesh = build_mesh(moved(test::octahedron_sphere(4), some_rotation(seed + 1000), Vector3d::Zero()));
        const auto nearest = [&](const Vector3d& position) {
            Index best = 0;
            for (const Vertex v : mesh.vertices()) {
                const Point target(position[0], position[1], position[2]);
                if (CGAL::squared_distance(mesh.point(v), target) < CGAL::squared_distance(mesh.point(Vertex(best)), target))
                    best = v;
            }
            return best;
        };
        const Evaluated measured = evaluate_with_uncertainty(mesh, whole(mesh), pins("ruler", {nearest(p), nearest(q)}));
        const double error = (measured.value - truth) / measured.uncertainty;
        squares += error * error;
        outside += std::abs(error) > 3;
    }
    EXPECT_LT(std::sqrt(squares / count), 1.2);
    EXPECT_GT(std::sqrt(squares / count), 0.4);
    EXPECT_LT(outside, 4);
}

TEST(Uncertainty, PickingsOfTheSameNameBecomeOneMeasure) {
    Annotation annotation;
    const auto add = [&](int id, const std::string& name, const Measure& measure) {
        Attribute attribute;
        attribute.id = id, attribute.name = name, attribute.value = measure;
        annotation.attributes.push_back(attribute);
    };
    add(0, "width", pins("ruler", {1, 2}));
    add(1, "height", pins("ruler", {3, 4}));
    add(2, "width", pins("ruler", {1, 3}));
    add(3, "width", pins("tape", {1, 3}));
    add(4, "width", pins("ruler", {1, 4}));
    EXPECT_EQ(merge_pickings(annotation), 2U);
    ASSERT_EQ(annotation.attributes.size(), 3U);
    EXPECT_EQ(annotation.attributes[0].measure()->repeats, (std::vector<std::vector<Index>>{{1, 3}, {1, 4}}));
    EXPECT_EQ(merge_pickings(annotation), 0U);
}

}  // namespace
}  // namespace ostraka
