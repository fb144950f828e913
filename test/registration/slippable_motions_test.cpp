#include "ostraka/registration/slippable_motions.h"

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

/// A piece of a parametric surface, with normals from finite differences.
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

Vector3d on_sphere(double u, double v) {
    const double a = 1.5 * u, b = 1.2 * (v - 0.5);
    return 3 * Vector3d(std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b));
}

/// Moved, so that nothing is aligned with the axes.
Motion tilted(double size) {
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(1.1, Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
    motion.translation = size * Vector3d(3, -2, 5);
    motion.scale = size;
    return motion;
}

SlippableMotions motions_of(Cloud c, const Motion& motion) {
    for (Vector3d& p : c.places) p = motion(p);
    for (Vector3d& n : c.normals) n = motion.rotation * n;
    return slippable_motions_of(c.places, c.normals, 0.02);
}

Motion about(const Vector3d& point, const Vector3d& axis, double angle) {
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
    motion.translation = point - motion.rotation * point;
    return motion;
}

TEST(SlippableMotionsTest, AreThoseOfTheSurface) {
    for (const double size : {1e-6, 1.0, 1e6}) {
        const Motion motion = tilted(size);
        const Vector3d origin = motion(Vector3d::Zero()), z = motion.rotation * Vector3d::UnitZ(),
                       x = motion.rotation * Vector3d::UnitX();
        const auto near = [&](const Vector3d& p, const Vector3d& q) { return (p - q).norm() < 1e-4 * size; };
        const auto along = [](const Vector3d& a, const Vector3d& b) { return std::abs(a.dot(b)) > 1 - 1e-8; };

        const SlippableMotions sphere = motions_of(cloud(on_sphere), motion);
        EXPECT_EQ(sphere.kind, SlippableKind::sphere);
        EXPECT_TRUE(near(sphere.point, origin));
        EXPECT_TRUE(sphere.contains(about(origin, Vector3d(1, -1, 2), 2), origin, 0.01, 1e-3 * size));
        EXPECT_FALSE(sphere.contains(about(origin + size * x, z, 2), origin, 0.01, 1e-3 * size));

        const SlippableMotions plane = motions_of(cloud([](double u, double v) { return Vector3d(2 * u, v, 0); }), motion);
        EXPECT_EQ(plane.kind, SlippableKind::plane);
        EXPECT_TRUE(along(plane.direction, z));
        Motion translated;
        translated.translation = size * x;
        EXPECT_TRUE(plane.contains(translated, origin, 0.01, 1e-3 * size));
        EXPECT_TRUE(plane.contains(about(origin + size * x, z, 1), origin, 0.01, 1e-3 * size));
        EXPECT_FALSE(plane.contains(about(origin, x, 0.5), origin, 0.01, 1e-3 * size));

        const SlippableMotions cylinder =
            motions_of(cloud([](double u, double v) { return Vector3d(std::cos(u), std::sin(u), 2 * v); }), motion);
        EXPECT_EQ(cylinder.kind, SlippableKind::cylinder);
        EXPECT_TRUE(along(cylinder.direction, z));
        translated.translation = size * z;
        EXPECT_TRUE(cylinder.contains(translated.after(about(origin, z, 3)), origin, 0.01, 1e-3 * size));

        const auto vase = [](double u, double v) {
            const double r = 1 + 0.4 * std::sin(4 * v) + 0.2 * v;
            return Vector3d(r * std::cos(2 * u), r * std::sin(2 * u), 2 * v);
        };
        const SlippableMotions revolution = motions_of(cloud(vase), motion);
        EXPECT_EQ(revolution.kind, SlippableKind::rotation);
        EXPECT_TRUE(along(revolution.direction, z));
        EXPECT_NEAR((revolution.point - origin).cross(z).norm(), 0, 1e-4 * size);
        EXPECT_TRUE(revolution.contains(about(origin, z, -2), origin, 0.01, 1e-3 * size));
        EXPECT_FALSE(revolution.contains(translated, origin, 0.01, 1e-3 * size));

        const SlippableMotions prism =
            motions_of(cloud([](double u, double v) { return Vector3d(u, 0.3 * std::sin(7 * u) + u * u, 2 * v); }), motion);
        EXPECT_EQ(prism.kind, SlippableKind::translation);
        EXPECT_TRUE(along(prism.direction, z));

        const SlippableMotions helix = motions_of(cloud([](double u, double v) {
                                                      const double a = 5 * u, r = 1 + v * (1 - v);
                                                      return Vector3d(r * std::cos(a), r * std::sin(a), 0.4 * a + v);
                                                  }),
                                                  motion);
        EXPECT_EQ(helix.kind, SlippableKind::helix);
        EXPECT_TRUE(along(helix.direction, z));
        EXPECT_NEAR(helix.pitch * (helix.direction.dot(z) < 0 ? 1 : 1), 0.4 * size, 1e-4 * size);

        EXPECT_EQ(motions_of(cloud([](double u, double v) { return Vector3d(2 * u, v, std::sin(5 * u) * std::cos(4 * v + 1)); }),
                             motion)
                      .kind,
                  SlippableKind::none);
    }
}

TEST(SlippableMotionsTest, WaysStayInTheGroup) {
    const SlippableMotions sphere = motions_of(cloud(on_sphere), tilted(1));
    const auto ways = sphere.sampled_motions(1, 1, 4);
    EXPECT_EQ(ways.size(), 6u);
    for (const auto& way : ways)
        for (const auto& step : way) {
            EXPECT_TRUE(step.rotates);
            EXPECT_TRUE(sphere.contains(step.motion, Vector3d::Zero(), 1e-6, 1e-6));
        }
}

TEST(SlippableMotionsTest, TooLittleLeavesAllOpen) {
    EXPECT_EQ(slippable_motions_of({}, {}).kind, SlippableKind::more);
    EXPECT_EQ(slippable_motions_of({Vector3d::Zero()}, {Vector3d::UnitX()}).kind, SlippableKind::more);
    const std::vector<Vector3d> one_place(20, Vector3d(1, 2, 3)), up(20, Vector3d::UnitZ());
    EXPECT_EQ(slippable_motions_of(one_place, up).kind, SlippableKind::more);
}

}  // namespace
}  // namespace ostraka
