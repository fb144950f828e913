// Axes and diameters with intervals: sherds whose vessel is known, and parts that determine none.
#include "ostraka/axis/revolution_axis.h"
#include "meshes.h"
#include "ostraka/core/angles.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/stats/random.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <CGAL/Polygon_mesh_processing/orientation.h>

#include <cmath>
#include <numeric>

using namespace ostraka;
using namespace ostraka::test;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

std::vector<Index> all_faces(const Mesh& mesh) {
    std::vector<Index> faces(mesh.number_of_faces());
    std::iota(faces.begin(), faces.end(), Index{0});
    return faces;
}

struct Sherd {
    Mesh mesh;
    Vector3d direction;
    double rim = 0;  ///< diameter at the top of the lip
};

/// Outer side, lip (a half circle) and inner side of a conical bowl, over an arc in degrees, with noise along the normals. The
/// rim has radius 100, the wall is 6 thick and 40 high. `roughness`: waves of a straight fracture at its lower end; 0: the wall
/// is open there. `lean`: change of the radius per height.
Sherd rim_sherd(double arc, double noise, std::uint64_t seed, double scale = 1, const Vector3d& origin = Vector3d::Zero(),
                double roughness = 0, double lean = 0.35) {
    Random random(seed, 5);
    const Vector2d along = Vector2d(lean, 1).normalized(), across(along.y(), -along.x());
    const double length = 40, radius = 3, turn = pi * radius;
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(1.1, Vector3d(1, -2, 0.7).normalized()).toRotationMatrix();
    const double total = 2 * length + turn;
    const auto columns = static_cast<Index>(std::max(10.0, arc * degree * 100 / 1.2)), rows = static_cast<Index>(total / 1.2);
    Sherd sherd;
    sherd.direction = rotation.col(2);
    sherd.mesh = build_mesh(grid(columns, rows, false, roughness > 0, [&](double s, double t) {
        const double at = t * total, angle = (s - 0.5) * arc * degree;
        const double reach = 1 + roughness / length * (std::sin(7 * s) + 0.4 * std::sin(23 * s));
        Vector2d p(100, 0), n = across;
        if (at < length) p += radius * across - reach * (length - at) * along;
        else if (at < length + turn) {
            const double q = (at - length) / radius;
            n = std::cos(q) * across + std::sin(q) * along;
            p += radius * n;
        } else {
            n = -across;
            p += -radius * across - reach * (at - length - turn) * along;
        }
        p += noise * random.normal() * n;
        const Vector3d q = scale * (rotation * Vector3d(p.x() * std::cos(angle), p.x() * std::sin(angle), p.y()) + origin);
        return std::array<double, 3>{q.x(), q.y(), q.z()};
    }));
    // The top of the half circle, not its middle.
    sherd.rim = 2 * 100 * scale;
    return sherd;
}

double angle_to(const Axis& axis, const Vector3d& direction) {
    return std::acos(std::min(1.0, std::abs(eigen(axis.direction).dot(direction)))) / degree;
}

bool holds(const DiameterEstimate& diameter, double truth) { return truth >= diameter.low && truth <= diameter.high; }

RevolutionAxis axis_of(const Mesh& mesh, const RevolutionAxisOptions& options = {}) {
    return revolution_axis(mesh, all_faces(mesh), {}, options);
}

}  // namespace

TEST(RevolutionAxis, OfARimSherd) {
    for (const double arc : {25.0, 60.0}) {
        const Sherd sherd = rim_sherd(arc, 0.05, 3);
        const RevolutionAxis result = axis_of(sherd.mesh);
        ASSERT_TRUE(result.axis.found) << arc << ": " << result.axis.reason;
        const DiameterEstimate& rim = result.diameters.front();
        ASSERT_EQ(rim.name, "rim diameter") << arc;
        EXPECT_NEAR(rim.value, sherd.rim, 8) << arc;
        EXPECT_LT(angle_to(result.axis, sherd.direction), 2) << arc;
        EXPECT_NEAR(result.axis.figure("circle preserved")->value, arc / 3.6, 0.6) << arc;
        EXPECT_LE(rim.low, rim.value);
        EXPECT_GE(rim.high, rim.value);
        EXPECT_GT(result.axis.figure("direction within")->value, result.axis.figure("direction error")->value);
    }
}

TEST(RevolutionAxis, IntervalsHoldTheTruth) {
    int diameters = 0, directions = 0;
    constexpr int draws = 12;
    for (int draw = 0; draw < draws; ++draw) {
        const Sherd sherd = rim_sherd(35, 0.1, 100 + static_cast<std::uint64_t>(draw));
        const RevolutionAxis result = axis_of(sherd.mesh, {.out_of_round = 0});
        ASSERT_TRUE(result.axis.found) << draw << ": " << result.axis.reason;
        directions += angle_to(result.axis, sherd.direction) <= result.axis.figure("direction within")->value ? 1 : 0;
        const DiameterEstimate& rim = result.diameters.front();
        diameters += holds(rim, sherd.rim) ? 1 : 0;
        EXPECT_LT(rim.high - rim.low, 0.1 * sherd.rim);
    }
    EXPECT_GE(directions, 9);
    EXPECT_GE(diameters, 9);
}

TEST(RevolutionAxis, AStraightFractureIsNoRim) {
    for (const std::uint64_t seed : {51, 52, 53}) {
        const Sherd sherd = rim_sherd(45, 0.05, seed, 1, Vector3d::Zero(), 0.3, 0.7);
        const RevolutionAxis result = axis_of(sherd.mesh);
        ASSERT_TRUE(result.rim_direction) << result.axis.reason;
        EXPECT_GT(eigen(*result.rim_direction).dot(sherd.direction), 0.99);
        EXPECT_NEAR(result.diameters.front().value, sherd.rim, 1.5);
    }
}

TEST(RevolutionAxis, ThePartIsBelowItsRim) {
    for (const std::uint64_t seed : {41, 42, 43}) {
        const Sherd sherd = rim_sherd(50, 0.05, seed);
        const RevolutionAxis result = axis_of(sherd.mesh);
        ASSERT_TRUE(result.rim_direction) << result.axis.reason;
        EXPECT_GT(eigen(*result.rim_direction).dot(sherd.direction), 0.99);
    }
    const Mesh wall = build_mesh(grid(60, 40, false, false, [&](double s, double t) {
        const double a = s * 50 * degree;
        return std::array<double, 3>{100 * std::cos(a), 100 * std::sin(a), 60 * t};
    }));
    EXPECT_FALSE(axis_of(wall).rim_direction);
}

// On a long arc the top of the lip, not the axis, limits the diameter.
TEST(RevolutionAxis, IntervalsHoldTheTopOfALeaningLip) {
    int diameters = 0;
    constexpr int draws = 10;
    for (int draw = 0; draw < draws; ++draw) {
        const Sherd sherd = rim_sherd(75, 0.05, 300 + static_cast<std::uint64_t>(draw));
        const RevolutionAxis result = axis_of(sherd.mesh, {.out_of_round = 0});
        ASSERT_TRUE(result.axis.found) << draw << ": " << result.axis.reason;
        const DiameterEstimate& rim = result.diameters.front();
        ASSERT_EQ(rim.name, "rim diameter");
        diameters += holds(rim, sherd.rim) ? 1 : 0;
        EXPECT_NEAR(rim.value, sherd.rim, 0.4);
        EXPECT_LT(rim.high - rim.low, 1.0);
    }
    EXPECT_GE(diameters, 8);
}

TEST(RevolutionAxis, AShortArcCannotBeTold) {
    const Sherd sherd = rim_sherd(9, 0.3, 8);
    const RevolutionAxis result = axis_of(sherd.mesh);
    EXPECT_FALSE(result.axis.found);
    ASSERT_TRUE(result.undetermined) << result.axis.reason;
    EXPECT_NE(result.axis.reason.find("cannot be told"), std::string::npos) << result.axis.reason;
    const DiameterEstimate& diameter = result.diameters.front();
    EXPECT_TRUE(holds(diameter, sherd.rim)) << diameter.low << " " << diameter.high;
    // A wide interval is accepted if that is the option, unless it has no upper bound.
    const RevolutionAxis accepted = axis_of(sherd.mesh, {.max_interval = 10});
    EXPECT_TRUE(!accepted.undetermined || !std::isfinite(accepted.diameters.front().high)) << accepted.axis.reason;
}

TEST(RevolutionAxis, OfCylinderAndCone) {
    for (const double slope : {0.0, 0.4}) {
        const Mesh wall = build_mesh(grid(60, 40, false, false, [&](double s, double t) {
            const double a = s * 50 * degree, r = 100 - slope * 60 * t;
            return std::array<double, 3>{r * std::cos(a), r * std::sin(a), 60 * t};
        }));
        const RevolutionAxis result = axis_of(wall, {.out_of_round = 0});
        const Axis& axis = result.axis;
        ASSERT_TRUE(axis.found) << slope << ": " << axis.reason;
        EXPECT_LT(angle_to(axis, Vector3d::UnitZ()), 0.02) << slope;
        EXPECT_EQ(axis.figure("rim diameter"), nullptr);
        EXPECT_NEAR(axis.figure("largest diameter")->value, 200, slope > 0 ? 4 : 0.1) << slope;
        EXPECT_LT(Vector2d(axis.point.x(), axis.point.y()).norm(), 0.05) << slope;
    }
}

TEST(RevolutionAxis, FarAwayTinyHugeAndInsideOut) {
    const Sherd reference = rim_sherd(40, 0.05, 4);
    const RevolutionAxis expected = axis_of(reference.mesh);
    ASSERT_TRUE(expected.axis.found) << expected.axis.reason;
    const double diameter = expected.diameters.front().value;
    for (const double scale : {1e-3, 1.0, 1e6}) {
        const Sherd sherd = rim_sherd(40, 0.05, 4, scale, Vector3d(3e4, -2e4, 1e4));
        const Axis axis = axis_of(sherd.mesh).axis;
        ASSERT_TRUE(axis.found) << scale << ": " << axis.reason;
        EXPECT_NEAR(axis.figure("rim diameter")->value / scale, diameter, 0.3) << scale;
        EXPECT_LT(angle_to(axis, eigen(expected.axis.direction)), 0.1) << scale;
    }
    Mesh reversed = reference.mesh;
    CGAL::Polygon_mesh_processing::reverse_face_orientations(reversed);
    const Axis axis = axis_of(reversed).axis;
    ASSERT_NE(axis.figure("rim diameter"), nullptr);
    EXPECT_NEAR(axis.figure("rim diameter")->value, diameter, 0.3);
}

TEST(RevolutionAxis, NoneForPartsWithoutAxis) {
    const Mesh sphere = build_mesh(octahedron_sphere(4));
    const Axis many = axis_of(sphere).axis;
    EXPECT_FALSE(many.found);
    EXPECT_NE(many.reason.find("many axes"), std::string::npos) << many.reason;
    const Mesh tile = build_mesh(grid(20, 20, false, false, [](double u, double v) { return std::array<double, 3>{u, v, 0}; }));
    EXPECT_NE(axis_of(tile).axis.reason.find("flat"), std::string::npos);
    TriangleSoup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    soup.triangles = {{0, 1, 2}};
    const Mesh triangle = build_mesh(soup);
    EXPECT_FALSE(axis_of(triangle).axis.found);
    const Mesh cube = build_mesh(box(20));
    EXPECT_FALSE(axis_of(cube).axis.found);
}

TEST(RevolutionAxis, TheSameBitsTwice) {
    const Sherd sherd = rim_sherd(30, 0.05, 6);
    const RevolutionAxis first = axis_of(sherd.mesh), second = axis_of(sherd.mesh);
    EXPECT_EQ(first.axis.direction, second.axis.direction);
    EXPECT_EQ(first.diameters.front().low, second.diameters.front().low);
}

TEST(RevolutionAxis, TheCommandTellsTheIntervalOrThatItCannot) {
    const Scratch scratch;
    const std::string good = (scratch / "good.ply").string(), poor = (scratch / "poor.ply").string();
    write_mesh(good, rim_sherd(40, 0.05, 4).mesh);
    write_mesh(poor, rim_sherd(9, 0.3, 8).mesh);
    const auto told = run_command("axis --json " + good);
    EXPECT_EQ(told.code, 0) << told.out << told.err;
    EXPECT_NE(told.out.find("\"low\""), std::string::npos) << told.out;
    EXPECT_NE(run_command("axis " + good).out.find("95 % interval between"), std::string::npos);
    const auto doubtful = run_command("axis " + poor);
    EXPECT_EQ(doubtful.code, 3) << doubtful.out << doubtful.err;
    EXPECT_NE(doubtful.out.find("cannot be told: "), std::string::npos) << doubtful.out;
    EXPECT_EQ(run_command("axis --out-of-round 2 " + good).code, 2);
}
