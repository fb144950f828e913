// Axes of shapes whose axes are known, with noise, and of shapes that have none.
#include "ostraka/axis/axis.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/synthetic/make_mesh.h"
#include "ostraka/synthetic/synthetic_object.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

using namespace ostraka;
using namespace ostraka::test;

namespace {

std::vector<Index> all_faces(const Mesh& mesh) {
    std::vector<Index> faces(mesh.number_of_faces());
    std::iota(faces.begin(), faces.end(), Index{0});
    return faces;
}

Vector unit(double x, double y, double z) {
    const Vector v(x, y, z);
    return v / std::sqrt(v.squared_length());
}

/// A surface of revolution about z with the given profile, rotated so that z becomes `a` and translated to `at`.
Mesh revolved(const std::function<std::array<double, 2>(double)>& profile, const Vector& a, const Point& origin,
              double turn = 2 * M_PI) {
    const Vector u = std::abs(a.x()) < 0.9 ? CGAL::cross_product(a, Vector(1, 0, 0)) : CGAL::cross_product(a, Vector(0, 1, 0));
    const Vector v = u / std::sqrt(u.squared_length()), w = CGAL::cross_product(a, v);
    const bool closed = turn > 6.28;
    return build_mesh(grid(80, 60, closed, false, [&](double s, double t) {
        const auto [r, h] = profile(t);
        const Point p = origin + r * std::cos(turn * s) * v + r * std::sin(turn * s) * w + h * a;
        return std::array<double, 3>{p.x(), p.y(), p.z()};
    }));
}

std::array<double, 2> cylinder(double t) { return {1, 4 * t}; }
std::array<double, 2> vase(double t) { return {1 + 0.4 * std::sin(5 * t), 3 * t}; }
std::array<double, 2> cone(double t) { return {0.5 + t, 2 * t}; }
std::array<double, 2> capsule(double t) {
    if (t < 0.25) return {std::sin(M_PI / 2 * 4 * t) + 1e-4, -std::cos(M_PI / 2 * 4 * t)};
    if (t < 0.75) return {1, 6 * (t - 0.25)};
    return {std::cos(M_PI / 2 * (4 * t - 3)) + 1e-4, 3 + std::sin(M_PI / 2 * (4 * t - 3))};
}

void add_noise(Mesh& mesh, double noise_level, std::uint32_t seed = 3) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, noise_level * box_diagonal(mesh));
    std::vector<Vector> moves;
    for (std::size_t i = 0; i < mesh.number_of_vertices(); ++i)
        moves.emplace_back(normal(random), normal(random), normal(random));
    for (const Vertex v : mesh.vertices()) mesh.point(v) = mesh.point(v) + moves[v];
}

double angle(const Axis& axis, const Vector& a) { return std::acos(std::min(1.0, std::abs(axis.direction * a))) * 180 / M_PI; }
double offset(const Axis& axis, const Point& point) {
    return std::sqrt(CGAL::cross_product(point - axis.point, axis.direction).squared_length());
}

AxisOptions options_for(const std::string& method) {
    AxisOptions options;
    set_option(options, "method", method);
    return options;
}

}  // namespace

TEST(RotationAxis, OfSurfacesOfRevolutionWithAndWithoutNoise) {
    const Vector a = unit(0.3, -0.5, 0.8);
    const Point origin(10, -20, 30);
    const std::vector<std::pair<std::string, std::array<double, 2> (*)(double)>> shapes{
        {"cylinder", cylinder}, {"vase", vase}, {"cone", cone}, {"capsule", capsule}};
    for (const auto& [name, profile] : shapes)
        for (const double noise : {0.0, 0.001, 0.005}) {
            Mesh mesh = revolved(profile, a, origin);
            add_noise(mesh, noise);
            const Axis axis = rotation_axis(mesh, all_faces(mesh));
            ASSERT_TRUE(axis.found) << name << " " << noise << ": " << axis.reason << " " << axis.quality;
            EXPECT_LT(angle(axis, a), 0.05 + 60 * noise) << name << " " << noise;
            EXPECT_LT(offset(axis, origin + 1.5 * a), 0.002 + 4 * noise) << name << " " << noise;
            EXPECT_EQ(axis.figure("circle preserved")->value, 100) << name;
            if (name == "cylinder") {
                EXPECT_NEAR(axis.figure("largest diameter")->value, 2, 0.01 + 10 * noise);
            }
        }
}

TEST(RotationAxis, OfASherd) {
    const Vector a = unit(0, 0.6, 0.8);
    for (const double degrees : {60.0, 120.0})
        for (const double noise : {0.0, 0.001}) {
            Mesh mesh = revolved(vase, a, Point(1, 2, 3), degrees * M_PI / 180);
            add_noise(mesh, noise);
            const Axis axis = rotation_axis(mesh, all_faces(mesh));
            ASSERT_TRUE(axis.found) << degrees << " " << noise << ": " << axis.reason;
            EXPECT_LT(angle(axis, a), 0.2 + 1500 * noise) << degrees << " " << noise;
            EXPECT_NEAR(axis.figure("circle preserved")->value, degrees / 3.6, 1.5) << degrees << " " << noise;
            EXPECT_NEAR(axis.figure("largest diameter")->value, 2.8, 0.05 + 100 * noise) << degrees << " " << noise;
        }
}

TEST(RotationAxis, HandlesAndSpoutsDoNotTiltIt) {
    for (const char* name : {"vase", "teapot"}) {
        const Mesh mesh = make_mesh(synthetic_object(name), {.vertices = 8000}).mesh;
        const Axis axis = rotation_axis(mesh, all_faces(mesh));
        ASSERT_TRUE(axis.found) << name << ": " << axis.reason << " " << axis.quality;
        EXPECT_LT(angle(axis, Vector(0, 0, 1)), 0.3) << name;
        EXPECT_LT(offset(axis, Point(0, 0, 50)), 0.005 * box_diagonal(mesh)) << name;
    }
}

TEST(RotationAxis, OfAQuarterOfACylinder) {
    for (const double degrees : {90.0, 180.0}) {
        const Mesh wall = build_mesh(grid(80, 20, false, false, [&](double s, double t) {
            const double a = s * degrees * M_PI / 180;
            return std::array<double, 3>{100 * std::cos(a), 100 * std::sin(a), 40 * t};
        }));
        const Axis axis = rotation_axis(wall, all_faces(wall));
        ASSERT_TRUE(axis.found) << degrees << axis.reason;
        EXPECT_LT(angle(axis, Vector(0, 0, 1)), 1e-3);
        EXPECT_LT(offset(axis, Point(0, 0, 0)), 1e-2);
        EXPECT_NEAR(axis.figure("largest diameter")->value, 200, 0.1);
        EXPECT_NEAR(axis.figure("circle preserved")->value, degrees / 3.6, 0.5);
        EXPECT_LT(axis.figure("diameter error")->value, 0.01);
    }
    // A short arc with noise: many lines fit equally well.
    Mesh strip = build_mesh(grid(60, 20, false, false, [](double s, double t) {
        const double a = s * 4.6 * M_PI / 180;
        return std::array<double, 3>{100 * std::cos(a), 100 * std::sin(a), 40 * t};
    }));
    add_noise(strip, 0.002);
    EXPECT_FALSE(rotation_axis(strip, all_faces(strip)).found);
}

TEST(RotationAxis, NoneForShapesWithoutAxis) {
    for (const double noise : {0.0, 0.001, 0.005}) {
        Mesh sphere = build_mesh(octahedron_sphere(4));
        add_noise(sphere, noise);
        const Axis no_axis = rotation_axis(sphere, all_faces(sphere));
        EXPECT_FALSE(no_axis.found) << noise;
        EXPECT_NE(no_axis.reason.find("many axes"), std::string::npos) << noise << " " << no_axis.reason;
        Mesh cube = build_mesh(box(20));
        add_noise(cube, noise);
        EXPECT_FALSE(rotation_axis(cube, all_faces(cube)).found) << noise;
    }
    TriangleSoup soup = octahedron_sphere(4);
    for (auto& p : soup.points) p = {p[0], 1.5 * p[1], 2.2 * p[2]};
    const Mesh ellipsoid = build_mesh(soup);
    EXPECT_FALSE(rotation_axis(ellipsoid, all_faces(ellipsoid)).found);
    const Mesh hand = make_mesh(synthetic_object("hand"), {.vertices = 3000}).mesh;
    EXPECT_FALSE(rotation_axis(hand, all_faces(hand)).found);
    const Mesh flat = build_mesh(grid(10, 10, false, false, [](double s, double t) { return std::array<double, 3>{s, t, 0}; }));
    const Axis no_axis = rotation_axis(flat, all_faces(flat));
    EXPECT_FALSE(no_axis.found);
    EXPECT_NE(no_axis.reason.find("flat"), std::string::npos);
}

TEST(RotationAxis, OfATorusAtAnyScaleAndPosition) {
    for (const double scale : {1e-9, 1.0, 1e9}) {
        const Mesh mesh = build_mesh(moved(torus(60, 30), scale, {0, 0, 0}));
        const Axis axis = rotation_axis(mesh, all_faces(mesh));
        ASSERT_TRUE(axis.found) << scale << axis.reason;
        EXPECT_LT(angle(axis, Vector(0, 0, 1)), 0.05);
        EXPECT_NEAR(axis.figure("largest diameter")->value / scale, 6, 0.2);
    }
    const Mesh away = build_mesh(moved(torus(60, 30), 1, {1e6, -2e6, 3e6}));
    const Axis axis = rotation_axis(away, all_faces(away));
    ASSERT_TRUE(axis.found);
    EXPECT_LT(offset(axis, Point(1e6, -2e6, 0)), 1e-2);
}

TEST(SliceAxis, OfTubes) {
    const Vector a = unit(1, 2, -0.5);
    for (const double turn : {2 * M_PI, 2.0})
        for (const double noise : {0.0, 0.001, 0.005}) {
            Mesh mesh = revolved(cylinder, a, Point(0, 0, 0), turn);
            add_noise(mesh, noise);
            const Axis axis = slice_axis(mesh, all_faces(mesh));
            ASSERT_TRUE(axis.found) << turn << " " << noise << ": " << axis.reason;
            EXPECT_LT(angle(axis, a), 0.5 + 300 * noise) << turn << " " << noise;
            EXPECT_LT(offset(axis, Point(0, 0, 0) + 2 * a), 0.01 + 15 * noise) << turn << " " << noise;
            EXPECT_NEAR(axis.figure("mean radius")->value, 1, 0.02 + 15 * noise) << turn << " " << noise;
        }
    // A quarter of a torus: the centres run along its circle of radius 2.
    const Mesh bend = build_mesh(grid(60, 40, false, true, [](double s, double t) {
        const double b = 2 * M_PI * t, c = M_PI / 2 * s;
        return std::array<double, 3>{(2 + 0.4 * std::cos(b)) * std::cos(c), (2 + 0.4 * std::cos(b)) * std::sin(c),
                                     0.4 * std::sin(b)};
    }));
    const Axis axis = slice_axis(bend, all_faces(bend));
    ASSERT_TRUE(axis.found) << axis.reason;
    for (std::size_t i = 3; i + 3 < axis.lines[0].size(); ++i) {
        const Point& p = axis.lines[0][i];
        EXPECT_NEAR(std::hypot(p.x(), p.y()), 2, 0.03) << i;
        EXPECT_NEAR(p.z(), 0, 0.01);
    }
}

TEST(SliceAxis, NoneForShapesWithoutAxis) {
    for (const TriangleSoup& soup : {octahedron_sphere(3), box(10), torus(30, 20)}) {
        const Mesh mesh = build_mesh(soup);
        const Axis axis = slice_axis(mesh, all_faces(mesh));
        EXPECT_FALSE(axis.found);
        EXPECT_FALSE(axis.reason.empty());
    }
}

TEST(PrincipalAxis, OfABoxIsExact) {
    TriangleSoup soup = box(4);
    for (auto& p : soup.points) p = {4 * p[0], 2 * p[1], p[2]};
    const Mesh mesh = build_mesh(soup);
    const AreaMoments moments = area_moments(mesh, all_faces(mesh));
    EXPECT_NEAR(moments.area, 28, 1e-12);
    EXPECT_NEAR(moments.centroid.x(), 2, 1e-12);
    // Variance along x: faces across x at +-2 (area 2 each), the others spread evenly (variance 16 / 12).
    EXPECT_NEAR(moments.variances[0], (4 * 4 + 24 * 16.0 / 12) / 28, 1e-12);
    const Axis axis = principal_axis(mesh, all_faces(mesh));
    EXPECT_TRUE(axis.found);
    EXPECT_NEAR(axis.direction.x(), 1, 1e-12);
    EXPECT_NEAR(axis.figure("extent 1")->value, 4, 1e-12);
    const Mesh cube = build_mesh(box(4));
    EXPECT_FALSE(principal_axis(cube, all_faces(cube)).found);
}

TEST(CircleAxis, OfARim) {
    std::vector<Point> rim;
    const Vector a = unit(1, 1, 1), u = unit(1, -1, 0), w = CGAL::cross_product(a, u);
    for (int i = 0; i <= 90; ++i)
        rim.push_back(Point(5, 6, 7) + 3 * std::cos(i * M_PI / 180) * u + 3 * std::sin(i * M_PI / 180) * w);
    const Axis axis = circle_axis(rim);
    ASSERT_TRUE(axis.found);
    EXPECT_LT(angle(axis, a), 1e-5);
    EXPECT_LT(offset(axis, Point(5, 6, 7)), 1e-9);
    EXPECT_NEAR(axis.figure("diameter")->value, 6, 1e-9);
    EXPECT_NEAR(axis.figure("circle preserved")->value, 25, 1e-6);
    EXPECT_NEAR(axis.figure("diameter at least")->value, 6, 1e-9);
    EXPECT_NEAR(axis.figure("diameter at most")->value, 6, 1e-9);
    // Three points on a short arc do not cover the circle.
    const Axis three = circle_axis({rim[0], rim[5], rim[10]});
    EXPECT_NEAR(three.figure("circle preserved")->value, 1000.0 / 360, 1e-6);
    EXPECT_FALSE(circle_axis({{0, 0, 0}, {1, 0, 0}}).found);
    EXPECT_FALSE(circle_axis({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 0, 0}}).found);
}

TEST(Axis, AsAnObjFile) {
    Axis axis;
    axis.lines = {{{0, 0, 0}, {0.1, 0, 1}}, {{1, 0, 0}, {1, 1, 0}, {1, 1, 1}}};
    EXPECT_EQ(to_obj(axis), "# axis\nv 0 0 0\nv 0.10000000000000001 0 1\nl 1 2\nv 1 0 0\nv 1 1 0\nv 1 1 1\nl 3 4 5\n");
    EXPECT_EQ(to_obj({}), "# axis\n");
}

TEST(SkeletonAxis, OfClosedAndCappedParts) {
    const Vector a = unit(0.2, 0.3, 1);
    const Mesh open = revolved(cylinder, a, Point(1, 1, 1));
    const Axis tube = skeleton_axis(open, all_faces(open));
    ASSERT_TRUE(tube.found) << tube.reason;
    EXPECT_LT(angle(tube, a), 1.5);
    EXPECT_LT(offset(tube, Point(1, 1, 1) + 2 * a), 0.05);
    const Mesh ring = build_mesh(torus(60, 24));
    const Axis loop = skeleton_axis(ring, all_faces(ring));
    ASSERT_TRUE(loop.found) << loop.reason;
    EXPECT_EQ(loop.lines[0].front(), loop.lines[0].back()) << "a torus shrinks to a loop";
    EXPECT_NEAR(loop.figure("length")->value, 4 * M_PI, 0.5);
    const Mesh sphere = build_mesh(octahedron_sphere(3));
    EXPECT_FALSE(skeleton_axis(sphere, all_faces(sphere)).found);
}

TEST(Axis, DegenerateParts) {
    const Mesh triangle = build_mesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
    const Mesh line = build_mesh({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}});
    for (const char* method : {"rotation", "slices", "principal", "skeleton"}) {
        EXPECT_THROW(find_axis(triangle, {}, options_for(method)), Error) << method;
        EXPECT_THROW(find_axis(line, {0}, options_for(method)), Error) << method;
    }
    for (const char* method : {"rotation", "slices"}) {
        const Axis axis = find_axis(triangle, {0}, options_for(method));
        EXPECT_FALSE(axis.found);
        EXPECT_FALSE(axis.reason.empty());
    }
    EXPECT_THROW(options_for("guess"), Error);
}

TEST(Axis, DoesNotDependOnThreads) {
    const Mesh mesh = make_mesh(synthetic_object("vase"), {.vertices = 3000}).mesh;
    for (const char* method : {"rotation", "slices", "principal"}) {
        set_threads(1);
        const Axis first_result = find_axis(mesh, all_faces(mesh), options_for(method));
        set_threads(3);
        const Axis second_result = find_axis(mesh, all_faces(mesh), options_for(method));
        set_threads(0);
        EXPECT_EQ(first_result.direction, second_result.direction) << method;
        EXPECT_EQ(first_result.point, second_result.point) << method;
        EXPECT_EQ(first_result.lines, second_result.lines) << method;
    }
    const Axis first_result = skeleton_axis(mesh, all_faces(mesh));
    const std::vector<std::unique_ptr<char[]>> occupied_memory = [] {  // another state of the memory
        std::vector<std::unique_ptr<char[]>> blocks;
        for (std::size_t i = 0; i < 4000; ++i) {
            auto block = std::make_unique<char[]>(40 + i % 200);
            if (i % 3 == 0) blocks.push_back(std::move(block));
        }
        return blocks;
    }();
    set_threads(3);
    const Axis repeated = skeleton_axis(mesh, all_faces(mesh));
    set_threads(0);
    EXPECT_EQ(first_result.lines, repeated.lines);
    EXPECT_EQ(first_result.direction, repeated.direction);
}

TEST(Axis, OfTheSherdsOfOneVessel) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "fragments-vessel-sherds";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the sherds are not here: " << folder;
    // In their assembled poses they form a vessel; the axis of each large sherd must be close to the vessel's.
    std::vector<Mesh> sherds;
    TriangleSoup all_sherds;
    for (int i = 1; i <= 5; ++i) {
        sherds.push_back(read_mesh(folder / ("TU_96_2_5f_piece0" + std::to_string(i) + ".obj")).mesh);
        all_sherds = joined(all_sherds, to_soup(sherds.back()));
    }
    const Mesh vessel = build_mesh(all_sherds);
    const Axis vessel_axis = rotation_axis(vessel, all_faces(vessel));
    ASSERT_TRUE(vessel_axis.found) << vessel_axis.reason << " " << vessel_axis.quality;
    std::vector<double> diameters;
    for (std::size_t i = 0; i < sherds.size(); ++i) {
        const Axis axis = rotation_axis(sherds[i], all_faces(sherds[i]));
        RecordProperty("sherd " + std::to_string(i + 1),
                       axis.found ? std::to_string(angle(axis, vessel_axis.direction)) : axis.reason);
        EXPECT_TRUE(axis.found) << i + 1 << ": " << axis.reason;
        if (axis.found) {
            EXPECT_LT(angle(axis, vessel_axis.direction), 2);
            // There are gaps between them, so that the whole is wider than each sherd indicates; the sherds agree with each
            // other.
            diameters.push_back(axis.figure("largest diameter")->value);
            EXPECT_NEAR(diameters.back(), diameters.front(), 0.01 * diameters.front());
        }
    }
}
