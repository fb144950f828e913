#include "ostraka/measure/descriptors.h"

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
#include <map>
#include <numbers>
#include <numeric>
#include <random>

namespace ostraka {
namespace {

using Eigen::Vector3d;

/// Vertices moved by a rotation and a shift.
TriangleSoup moved(TriangleSoup soup, const Eigen::Matrix3d& turn, const Vector3d& shift) {
    for (auto& p : soup.points) {
        const Vector3d q = turn * Vector3d(p[0], p[1], p[2]) + shift;
        p = {q[0], q[1], q[2]};
    }
    return soup;
}

Eigen::Matrix3d some_turn(int seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> normal;
    return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized().toRotationMatrix();
}

TriangleSoup box(int n, double a, double b, double c) {
    TriangleSoup soup = test::box(n);
    for (auto& p : soup.points) p = {a * p[0], b * p[1], c * p[2]};
    return soup;
}

Annotation whole(const Mesh& mesh) {
    AnnotationSet set;
    return ensure_root(set, mesh);
}

Measure pins(const std::string& tool, std::vector<Index> points) {
    Measure measure;
    measure.tool = tool;
    measure.points = std::move(points);
    return measure;
}

TEST(Exactness, OfPolyhedraUnderRigidMotionToRounding) {
    // A box of 60,000 triangles: area, volume, centroid, box, ruler, tape along its edges, bounding: known, wherever it stands.
    const double a = 1, b = 2, c = 5, diagonal = std::sqrt(a * a + b * b + c * c);
    const TriangleSoup soup = box(70, a, b, c);
    const auto corner = [&](double x, double y, double z) {
        for (Index i = 0; i < soup.points.size(); ++i)
            if (soup.points[i] == std::array<double, 3>{x, y, z}) return i;
        return no_index;
    };
    const Index o = corner(0, 0, 0), far = corner(a, b, c), up = corner(0, 0, c);
    for (const double offset : {0.0, 10.0, 1e3, 1e6}) {
        const Vector3d shift = offset * Vector3d(1, -2, 3).normalized();
        const Eigen::Matrix3d turn = offset == 0 ? Eigen::Matrix3d::Identity() : some_turn(static_cast<int>(offset));
        const Mesh mesh = build_mesh(moved(soup, turn, shift));
        const Annotation root = whole(mesh);
        const double tolerance = 1e-12 * (1 + offset / diagonal);
        DescriptorSearch search(mesh);
        const auto value = [&](const std::string& name) { return search.find(root, name)->values.front(); };
        const auto near = [&](double x, double exact, const char* what) {
            EXPECT_LE(std::abs(x - exact), tolerance * std::abs(exact)) << what << " at " << offset;
        };
        near(value("area"), 2 * (a * b + b * c + c * a), "area");
        near(value("volume"), a * b * c, "volume");
        EXPECT_EQ(value("volume bound"), 0);
        near(value("mean curvature integral"), std::numbers::pi * (a + b + c), "mean curvature");
        const Vector3d middle = turn * Vector3d(a / 2, b / 2, c / 2) + shift;
        for (const char* name : {"centroid", "solid centroid", "box centre"}) {
            const auto at = search.find(root, name)->values;
            const double allowed = (std::string(name) == "box centre" ? 1e-6 : tolerance) * (diagonal + offset);
            EXPECT_LE((Vector3d(at[0], at[1], at[2]) - middle).norm(), allowed) << name << " at " << offset;
        }
        near(evaluate(mesh, root, pins("ruler", {o, far})), diagonal, "ruler");
        near(evaluate(mesh, root, pins("tape", {o, up})), c, "tape");
        Measure bounding = pins("bounding", {o, far});
        const Vector3d z = turn * Vector3d::UnitZ();
        bounding.direction = std::array<double, 3>{z[0], z[1], z[2]};
        near(evaluate(mesh, root, bounding), c, "bounding");
        Annotation side;  // the faces on x = 0
        for (const Face f : mesh.faces())
            if (std::abs((turn.transpose() *
                          (Vector3d(centroid(mesh, f).x(), centroid(mesh, f).y(), centroid(mesh, f).z()) - shift))[0]) < 1e-6)
                side.faces.push_back(f);
        near(search.find(side, "area")->values.front(), b * c, "area of a side");
        near(search.find(side, "perimeter")->values.front(), 2 * (b + c), "perimeter of a side");
        near(search.find(side, "circularity")->values.front(), 4 * (b + c) * (b + c) / (b * c), "circularity");
    }
}

/// Each triangle in four, flat.
TriangleSoup in_four(const TriangleSoup& soup) {
    TriangleSoup result{soup.points, {}};
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index p, Index q) {
        const auto [entry, fresh] = middles.try_emplace(std::minmax(p, q), static_cast<Index>(result.points.size()));
        if (fresh) {
            const auto a = result.points[p], b = result.points[q];
            result.points.push_back({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2});
        }
        return entry->second;
    };
    for (const auto& [p, q, r] : soup.triangles) {
        const Index u = middle(p, q), v = middle(q, r), w = middle(r, p);
        for (const auto& t : {std::array{p, u, w}, {u, q, v}, {w, v, r}, {u, v, w}}) result.triangles.push_back(t);
    }
    return result;
}

TEST(Exactness, OfRegularPolyhedra) {
    const double s3 = std::sqrt(3.0), golden = (1 + std::sqrt(5.0)) / 2;
    struct Solid {
        TriangleSoup soup;
        double area, volume, width;  ///< width: extent along x
    };
    std::vector<Solid> solids;
    // Edge length 2 sqrt(2), sqrt(2), 2.
    solids.push_back(
        {{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}}, 8 * s3, 8.0 / 3, 2});
    solids.push_back({{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                       {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}},
                      4 * s3,
                      4.0 / 3,
                      2});
    Solid ball{{}, 20 * s3, 10.0 / 3 * (3 + std::sqrt(5.0)), 2 * golden};
    for (const double a : {-1.0, 1.0})
        for (const double b : {-golden, golden}) {
            ball.soup.points.push_back({0, a, b});
            ball.soup.points.push_back({a, b, 0});
            ball.soup.points.push_back({b, 0, a});
        }
    const auto apart = [&](Index i, Index j) {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) sum += std::pow(ball.soup.points[i][k] - ball.soup.points[j][k], 2);
        return sum;
    };
    for (Index i = 0; i < 12; ++i)
        for (Index j = i + 1; j < 12; ++j)
            for (Index k = j + 1; k < 12; ++k) {
                if (apart(i, j) > 4.1 || apart(j, k) > 4.1 || apart(k, i) > 4.1) continue;
                const Vector3d p(ball.soup.points[i].data()), q(ball.soup.points[j].data()), r(ball.soup.points[k].data());
                const bool outward = (q - p).cross(r - p).dot(p) > 0;
                ball.soup.triangles.push_back(outward ? std::array{i, j, k} : std::array{i, k, j});
            }
    ASSERT_EQ(ball.soup.triangles.size(), 20U);
    solids.push_back(ball);
    for (Solid& solid : solids) {
        for (int k = 0; k < 4; ++k) solid.soup = in_four(solid.soup);
        for (const double offset : {0.0, 1e3, 1e6}) {
            const Vector3d shift = offset * Vector3d(2, 1, -2) / 3;
            const Eigen::Matrix3d turn = some_turn(static_cast<int>(offset) + 5);
            const Mesh mesh = build_mesh(moved(solid.soup, turn, shift));
            const Annotation root = whole(mesh);
            const double diagonal = box_diagonal(mesh), tolerance = 1e-12 * (1 + offset / diagonal);
            DescriptorSearch search(mesh);
            EXPECT_LE(std::abs(search.find(root, "area")->values[0] - solid.area), tolerance * solid.area) << offset;
            EXPECT_LE(std::abs(search.find(root, "volume")->values[0] - solid.volume), tolerance * solid.volume) << offset;
            for (const char* name : {"centroid", "solid centroid"}) {
                const auto at = search.find(root, name)->values;
                EXPECT_LE((Vector3d(at[0], at[1], at[2]) - shift).norm(), tolerance * (diagonal + offset)) << name << offset;
            }
            Measure bounding = pins("bounding", {0, 1});
            const Vector3d x = turn * Vector3d::UnitX();
            bounding.direction = std::array<double, 3>{x[0], x[1], x[2]};
            const auto ends = extremes(mesh, root, *bounding.direction);
            bounding.points.assign(ends.begin(), ends.end());
            EXPECT_LE(std::abs(evaluate(mesh, root, bounding) - solid.width), tolerance * solid.width) << offset;
        }
    }
}

TEST(Exactness, OfTheExactTape) {
    const double a = 1, b = 2, c = 5, diagonal = std::sqrt(a * a + b * b + c * c);
    const TriangleSoup soup = box(8, a, b, c);
    Index first = 0, last = 0;
    for (Index i = 0; i < soup.points.size(); ++i) {
        if (soup.points[i] == std::array<double, 3>{0, 0, 0}) first = i;
        if (soup.points[i] == std::array<double, 3>{a, b, c}) last = i;
    }
    for (const double offset : {0.0, 10.0, 1e3, 1e6}) {
        const Mesh mesh =
            build_mesh(moved(soup, some_turn(static_cast<int>(offset) + 1), offset * Vector3d(1, -2, 3).normalized()));
        Measure exact = pins("tape", {first, last});
        exact.exact = true;
        EXPECT_NEAR(evaluate(mesh, whole(mesh), exact), std::hypot(a + b, c),
                    1e-12 * (1 + offset / diagonal) * std::hypot(a + b, c));
    }
}

TEST(OrientedBox, IsExactOnBoxes) {
    for (int seed = 0; seed < 12; ++seed) {
        const double a = 1, b = 1 + seed * 0.3, c = 4 - seed * 0.2;
        const TriangleSoup soup = moved(box(1 + seed % 4, a, b, c), some_turn(seed), Vector3d(seed, 2 * seed, -seed));
        const OrientedBox found = oriented_box(soup.points);
        std::array<double, 3> sides{a, b, c};
        std::sort(sides.rbegin(), sides.rend());
        EXPECT_NEAR(found.volume(), a * b * c, 1e-6 * a * b * c);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found.sides[k], sides[k], 1e-6 * sides[0]) << seed;
    }
}

/// The least volume over many directions, each with its smallest rectangle found by brute force over turns.
double least_box_by_search(const std::vector<std::array<double, 3>>& points) {
    Eigen::Matrix3Xd p(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
        p.col(static_cast<Eigen::Index>(i)) = Vector3d(points[i][0], points[i][1], points[i][2]);
    const auto volume = [&](const Eigen::Quaterniond& q) {
        const Eigen::Matrix3Xd turned = q.toRotationMatrix() * p;
        return (turned.rowwise().maxCoeff() - turned.rowwise().minCoeff()).prod();
    };
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    double best = std::numeric_limits<double>::infinity();
    for (int start = 0; start < 60; ++start) {  // from random orientations, downhill by random steps
        Eigen::Quaterniond at = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized();
        double here = volume(at);
        for (double step = 0.3; step > 1e-4;) {
            bool better = false;
            for (int tries = 0; tries < 12 && !better; ++tries) {
                const Eigen::Quaterniond next =
                    (Eigen::Quaterniond(1, step * normal(random), step * normal(random), step * normal(random)).normalized() *
                     at);
                const double v = volume(next);
                if (v < here) here = v, at = next, better = true;
            }
            if (!better) step /= 2;
        }
        best = std::min(best, here);
    }
    return best;
}

TEST(OrientedBox, IsWithinOnePercentOfTheLeast) {
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
        const auto points = moved(soup, some_turn(seed + 50), Vector3d::Zero()).points;
        const double least = least_box_by_search(points), found = oriented_box(points).volume();
        EXPECT_LE(found, 1.01 * least) << "kind " << kind;
        RecordProperty("ratio_" + std::to_string(seed), std::to_string(found / least));
    }
}

TEST(Solid, OpenRegionsAreClosedByTheirOutlines) {
    // A cup: a box without its lid. The outline is plane: the fan closes it exactly and nothing is in doubt.
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
    // A cap cut from a sphere by a bent edge: whatever closes it inside the hull of its outline stays within the bound.
    const Mesh sphere = build_mesh(test::octahedron_sphere(5));
    std::vector<Index> cap, rest;
    for (const Face f : sphere.faces()) {
        const Point p = centroid(sphere, f);
        (p.z() > 0.3 + 0.2 * p.x() * p.x() - 0.1 * p.y() ? cap : rest).push_back(f);
    }
    const RegionSolid a = region_solid(sphere, cap), b = region_solid(sphere, rest),
                      all = region_solid(sphere, [&] {
                          std::vector<Index> faces(sphere.number_of_faces());
                          std::iota(faces.begin(), faces.end(), Index{0});
                          return faces;
                      }());
    EXPECT_EQ(a.outlines, 1U);
    EXPECT_NEAR(a.volume + b.volume, all.volume, 1e-12);  // both are closed by the same fan
    EXPECT_GT(a.volume_bound, 0);
    EXPECT_NEAR(a.volume_bound, b.volume_bound, 1e-12);
    // Another surface over the outline: a fan from one of its vertices.
    const Outline outline = extract_outlines(sphere, cap).front();
    double other = 0;
    for (const Index f : cap) {
        const auto [p, q, r] = corners(sphere, Face(f));
        other += CGAL::cross_product(sphere.point(p) - CGAL::ORIGIN, sphere.point(q) - CGAL::ORIGIN) *
                 (sphere.point(r) - CGAL::ORIGIN) / 6;
    }
    for (std::size_t i = 0; i < outline.size(); ++i)
        other -= CGAL::cross_product(sphere.point(Vertex(outline[i])) - CGAL::ORIGIN,
                                     sphere.point(Vertex(outline[(i + 1) % outline.size()])) - CGAL::ORIGIN) *
                 (sphere.point(Vertex(outline[0])) - CGAL::ORIGIN) / 6;
    EXPECT_GT(std::abs(other - a.volume), 1e-9);
    EXPECT_LE(std::abs(other - a.volume), a.volume_bound);
}

TEST(Solid, HullVolume) {
    EXPECT_EQ(hull_volume({}), 0);
    EXPECT_EQ(hull_volume({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), 0);
    EXPECT_EQ(hull_volume({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.3, 0.2, 0}}), 0);
    EXPECT_EQ(hull_volume(std::vector<Point>(5, Point(1, 2, 3))), 0);
    EXPECT_NEAR(hull_volume({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.1, 0.1}}), 1.0 / 6, 1e-15);
}

TEST(Reference, MassPropertiesMeasuredInACadSystem) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "reference-trimesh";
    if (!std::filesystem::exists(folder / "mass_properties.json")) GTEST_SKIP() << folder << " is not here";
    const Json list = read_json(folder / "mass_properties.json");
    for (const auto& entry : list.GetArray()) {
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
    EXPECT_EQ(region.attributes[0].descriptor.unit, "mm^2");
    Annotation point;
    point.type = AnnotationType::point;
    point.points = {4};
    EXPECT_EQ(search.describe(point, {heights}).size(), 15U);
    Annotation line;
    line.type = AnnotationType::line;
    line.polylines = {{0, no_index}};
    line.polylines[0][1] = mesh.source(mesh.halfedge(Vertex(0)));
    EXPECT_GT(search.describe(line).front().values.front(), 0);
    // What is wrong is said.
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

TEST(Describe, TheLargestIdLeavesFreeOnes) {
    Annotation annotation;
    annotation.attributes.emplace_back();
    annotation.attributes[0].id = std::numeric_limits<int>::max();
    store(annotation, {{"a", {1}, false, 0, ""}, {"b", {2}, false, 0, ""}}, "mm");
    ASSERT_EQ(annotation.attributes.size(), 3U);
    EXPECT_EQ(annotation.attributes[1].id, 0);
    EXPECT_EQ(annotation.attributes[2].id, 1);
}

TEST(Uncertainty, OfARulerIsThatOfItsPins) {
    // On a flat grid of unit cells the faces around an inner vertex have three units of area: a third is one.
    const Mesh mesh = build_mesh(test::grid(10, 10, false, false, [](double u, double v) {
        return std::array<double, 3>{10 * u, 10 * v, 0};
    }));
    const Annotation root = whole(mesh);
    const Index a = 5 * 11 + 2, b = 5 * 11 + 8, c = 5 * 11 + 9;
    const double s = 1 / (4 * std::numbers::pi);
    Evaluated taken = evaluate_with_uncertainty(mesh, root, pins("ruler", {a, b}));
    EXPECT_DOUBLE_EQ(taken.value, 6);
    EXPECT_NEAR(taken.uncertainty, std::sqrt(2 * s), 1e-12);
    // A pin in the middle of a straight way changes nothing; at a corner it counts twice.
    EXPECT_NEAR(evaluate_with_uncertainty(mesh, root, pins("ruler", {a, 5 * 11 + 5, b})).uncertainty, std::sqrt(2 * s), 1e-12);
    EXPECT_NEAR(evaluate_with_uncertainty(mesh, root, pins("ruler", {a, b, 2 * 11 + 8})).uncertainty, std::sqrt(4 * s), 1e-12);
    // Picked again: the mean, and the spread of the mean added.
    Measure again = pins("ruler", {a, b});
    again.repeats = {{a, c}};
    taken = evaluate_with_uncertainty(mesh, root, again);
    EXPECT_DOUBLE_EQ(taken.value, 6.5);
    EXPECT_EQ(taken.pickings, 2U);
    EXPECT_NEAR(taken.spread, std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(taken.uncertainty, std::sqrt(2 * s + 0.5 / 2), 1e-12);
    EXPECT_DOUBLE_EQ(evaluate(mesh, root, again), 6.5);
    Measure bounding = pins("bounding", {a, b, c});
    bounding.direction = {1, 0, 0};
    EXPECT_NEAR(evaluate_with_uncertainty(mesh, root, bounding).uncertainty, std::sqrt(2 * s), 1e-12);
    bounding.direction = {0, 0, 1};
    EXPECT_EQ(evaluate_with_uncertainty(mesh, root, bounding).uncertainty, 0) << "all at one height";
    again.repeats = {{a}};
    EXPECT_THROW((void)evaluate(mesh, root, again), Error);
}

TEST(Uncertainty, CoversWhatPickingOnCoarseMeshesGivesAway) {
    // Two fixed places on a sphere, pinned to the nearest vertices of turned meshes: the error stays within three of what is said
    // nearly always, and is not far below it on the whole.
    const Vector3d p(1, 0, 0), q = Vector3d(-0.3, 1, 0.4).normalized();
    const double truth = (p - q).norm();
    double squares = 0;
    int outside = 0;
    const int count = 200;
    for (int seed = 0; seed < count; ++seed) {
        const Mesh mesh = build_mesh(moved(test::octahedron_sphere(4), some_turn(seed + 1000), Vector3d::Zero()));
        const auto nearest = [&](const Vector3d& place) {
            Index best = 0;
            for (const Vertex v : mesh.vertices()) {
                const Point at(place[0], place[1], place[2]);
                if (CGAL::squared_distance(mesh.point(v), at) < CGAL::squared_distance(mesh.point(Vertex(best)), at)) best = v;
            }
            return best;
        };
        const Evaluated taken = evaluate_with_uncertainty(mesh, whole(mesh), pins("ruler", {nearest(p), nearest(q)}));
        const double error = (taken.value - truth) / taken.uncertainty;
        squares += error * error;
        outside += std::abs(error) > 3;
    }
    EXPECT_LT(std::sqrt(squares / count), 1.2);
    EXPECT_GT(std::sqrt(squares / count), 0.4);
    EXPECT_LT(outside, 4);
}

TEST(Uncertainty, PickingsOfOneNameBecomeOneMeasure) {
    Annotation annotation;
    const auto add = [&](int id, const std::string& name, const Measure& measure) {
        Attribute attribute;
        attribute.id = id, attribute.name = name, attribute.type = AttributeType::measure, attribute.measure = measure;
        annotation.attributes.push_back(attribute);
    };
    add(0, "width", pins("ruler", {1, 2}));
    add(1, "height", pins("ruler", {3, 4}));
    add(2, "width", pins("ruler", {1, 3}));
    add(3, "width", pins("tape", {1, 3}));
    add(4, "width", pins("ruler", {1, 4}));
    EXPECT_EQ(merge_pickings(annotation), 2U);
    ASSERT_EQ(annotation.attributes.size(), 3U);
    EXPECT_EQ(annotation.attributes[0].measure.repeats, (std::vector<std::vector<Index>>{{1, 3}, {1, 4}}));
    EXPECT_EQ(merge_pickings(annotation), 0U);
}

}  // namespace
}  // namespace ostraka
