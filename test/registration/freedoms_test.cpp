#include "ostraka/registration/freedoms.h"

#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace ostraka {
namespace {

using Eigen::Vector3d;

struct Cloud {
    std::vector<Vector3d> places, normals;
};

/// A piece of a surface given by two parameters, its normals by differences.
Cloud cloud(const std::function<Vector3d(double, double)>& surface) {
    Cloud c;
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j) {
            const double u = (i + 0.5) / 20, v = (j + 0.5) / 20, e = 1e-6;
            const Vector3d du = surface(u + e, v) - surface(u - e, v), dv = surface(u, v + e) - surface(u, v - e);
            c.places.push_back(surface(u, v));
            c.normals.push_back(du.cross(dv).normalized());
        }
    return c;
}

Vector3d on_ball(double u, double v) {
    const double a = 1.5 * u, b = 1.2 * (v - 0.5);
    return 3 * Vector3d(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
}

/// Moved, so that nothing stands in the axes.
Motion tilted(double size) {
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(1.1, Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
    motion.translation = size * Vector3d(3, -2, 5);
    motion.scale = size;
    return motion;
}

Freedom of(Cloud c, const Motion& motion) {
    for (Vector3d& p : c.places) p = motion(p);
    for (Vector3d& n : c.normals) n = motion.rotation * n;
    return freedom_of(c.places, c.normals, 0.02);
}

Motion about(const Vector3d& point, const Vector3d& axis, double angle) {
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
    motion.translation = point - motion.rotation * point;
    return motion;
}

TEST(Freedoms, AreThoseOfTheSurface) {
    for (const double size : {1e-6, 1.0, 1e6}) {
        const Motion there = tilted(size);
        const Vector3d origin = there(Vector3d::Zero()), z = there.rotation * Vector3d::UnitZ(),
                       x = there.rotation * Vector3d::UnitX();
        const auto near = [&](const Vector3d& p, const Vector3d& q) { return (p - q).norm() < 1e-4 * size; };
        const auto along = [](const Vector3d& a, const Vector3d& b) { return std::abs(a.dot(b)) > 1 - 1e-8; };

        const Freedom ball = of(cloud(on_ball), there);
        EXPECT_EQ(ball.kind, FreedomKind::ball);
        EXPECT_TRUE(near(ball.point, origin));
        EXPECT_TRUE(ball.contains(about(origin, Vector3d(1, -1, 2), 2), origin, 0.01, 1e-3 * size));
        EXPECT_FALSE(ball.contains(about(origin + size * x, z, 2), origin, 0.01, 1e-3 * size));

        const Freedom plane = of(cloud([](double u, double v) { return Vector3d(2 * u, v, 0); }), there);
        EXPECT_EQ(plane.kind, FreedomKind::plane);
        EXPECT_TRUE(along(plane.direction, z));
        Motion shift;
        shift.translation = size * x;
        EXPECT_TRUE(plane.contains(shift, origin, 0.01, 1e-3 * size));
        EXPECT_TRUE(plane.contains(about(origin + size * x, z, 1), origin, 0.01, 1e-3 * size));
        EXPECT_FALSE(plane.contains(about(origin, x, 0.5), origin, 0.01, 1e-3 * size));

        const Freedom tube = of(cloud([](double u, double v) { return Vector3d(std::cos(u), std::sin(u), 2 * v); }), there);
        EXPECT_EQ(tube.kind, FreedomKind::tube);
        EXPECT_TRUE(along(tube.direction, z));
        shift.translation = size * z;
        EXPECT_TRUE(tube.contains(shift.after(about(origin, z, 3)), origin, 0.01, 1e-3 * size));

        const auto vase = [](double u, double v) {
            const double r = 1 + 0.4 * std::sin(4 * v) + 0.2 * v;
            return Vector3d(r * std::cos(2 * u), r * std::sin(2 * u), 2 * v);
        };
        const Freedom turn = of(cloud(vase), there);
        EXPECT_EQ(turn.kind, FreedomKind::turn);
        EXPECT_TRUE(along(turn.direction, z));
        EXPECT_NEAR((turn.point - origin).cross(z).norm(), 0, 1e-4 * size);
        EXPECT_TRUE(turn.contains(about(origin, z, -2), origin, 0.01, 1e-3 * size));
        EXPECT_FALSE(turn.contains(shift, origin, 0.01, 1e-3 * size));

        const Freedom prism =
            of(cloud([](double u, double v) { return Vector3d(u, 0.3 * std::sin(7 * u) + u * u, 2 * v); }), there);
        EXPECT_EQ(prism.kind, FreedomKind::shift);
        EXPECT_TRUE(along(prism.direction, z));

        const Freedom screw = of(cloud([](double u, double v) {
                                     const double a = 5 * u, r = 1 + v * (1 - v);
                                     return Vector3d(r * std::cos(a), r * std::sin(a), 0.4 * a + v);
                                 }),
                                 there);
        EXPECT_EQ(screw.kind, FreedomKind::screw);
        EXPECT_TRUE(along(screw.direction, z));
        EXPECT_NEAR(screw.pitch * (screw.direction.dot(z) < 0 ? 1 : 1), 0.4 * size, 1e-4 * size);

        EXPECT_EQ(
            of(cloud([](double u, double v) { return Vector3d(2 * u, v, std::sin(5 * u) * std::cos(4 * v + 1)); }), there).kind,
            FreedomKind::none);
    }
}

TEST(Freedoms, WaysStayInTheGroup) {
    const Freedom ball = of(cloud(on_ball), tilted(1));
    const auto ways = ball.ways(1, 1, 4);
    EXPECT_EQ(ways.size(), 6u);
    for (const auto& way : ways)
        for (const auto& step : way) {
            EXPECT_TRUE(step.turns);
            EXPECT_TRUE(ball.contains(step.motion, Vector3d::Zero(), 1e-6, 1e-6));
        }
}

TEST(Freedoms, TooLittleLeavesAllOpen) {
    EXPECT_EQ(freedom_of({}, {}).kind, FreedomKind::more);
    EXPECT_EQ(freedom_of({Vector3d::Zero()}, {Vector3d::UnitX()}).kind, FreedomKind::more);
    const std::vector<Vector3d> one_place(20, Vector3d(1, 2, 3)), up(20, Vector3d::UnitZ());
    EXPECT_EQ(freedom_of(one_place, up).kind, FreedomKind::more);
}

}  // namespace
}  // namespace ostraka
