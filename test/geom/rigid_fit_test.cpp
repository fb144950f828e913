#include "ostraka/geom/rigid_fit.h"

#include "ostraka/core/error.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> cloud(std::size_t count, double size, const Vector3d& centre) {
    Random random(5);
    std::vector<Vector3d> points;
    for (std::size_t i = 0; i < count; ++i)
        points.push_back(centre + size * Vector3d(random.normal(), random.normal(), random.normal()));
    return points;
}

Motion some_motion(double scale) {
    Motion motion;
    motion.rotation = Eigen::AngleAxisd(2.1, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
    motion.translation = Vector3d(4, 5, -6);
    motion.scale = scale;
    return motion;
}

TEST(RigidFit, FindsTheMotionAtAnySizeAndPosition) {
    for (const double size : {1e-6, 1.0, 1e6}) {
        for (const double away : {0.0, 1e4}) {
            for (const bool scaled : {false, true}) {
                const Motion truth = some_motion(scaled ? 0.83 : 1);
                const auto from = cloud(30, size, away * size * Vector3d(1, 2, 3));
                std::vector<Vector3d> to;
                for (const Vector3d& p : from) to.push_back(truth(p));
                FitOptions options;
                options.scale = scaled;
                const Motion fitted = fit_motion(from, to, {}, options);
                EXPECT_NEAR((fitted.rotation - truth.rotation).norm(), 0, 1e-9);
                EXPECT_NEAR(fitted.scale, truth.scale, 1e-9);
                for (std::size_t i = 0; i < from.size(); ++i)
                    EXPECT_LT((fitted(from[i]) - to[i]).norm(), 1e-9 * (to[i].norm() + size));
            }
        }
    }
}

TEST(RigidFit, NeverReflects) {
    const auto from = cloud(20, 1, Vector3d::Zero());
    std::vector<Vector3d> to;
    for (const Vector3d& p : from) to.emplace_back(-p.x(), p.y(), p.z());
    EXPECT_NEAR(fit_motion(from, to).rotation.determinant(), 1, 1e-12);
}

TEST(RigidFit, IsTheLeastSquaresMotion) {
    const auto from = cloud(15, 1, Vector3d::Zero()), noise = cloud(15, 0.2, Vector3d(1, 0, 0));
    std::vector<Vector3d> to;
    std::vector<double> weights;
    for (std::size_t i = 0; i < from.size(); ++i) {
        to.push_back(some_motion(1.2)(from[i]) + noise[(i * 7) % 15]);
        weights.push_back(1 + static_cast<double>(i % 3));
    }
    FitOptions options;
    options.scale = true;
    const Motion best = fit_motion(from, to, weights, options);
    const auto cost = [&](const Motion& motion) {
        double sum = 0;
        for (std::size_t i = 0; i < from.size(); ++i) sum += weights[i] * (motion(from[i]) - to[i]).squaredNorm();
        return sum;
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (const double step : {1e-3, -1e-3}) {
            Motion turned = best, moved = best, scaled = best;
            turned.rotation = Eigen::AngleAxisd(step, Vector3d::Unit(axis)) * best.rotation;
            moved.translation[axis] += step;
            scaled.scale += step;
            EXPECT_GT(cost(turned), cost(best));
            EXPECT_GT(cost(moved), cost(best));
            EXPECT_GT(cost(scaled), cost(best));
        }
    }
}

TEST(RigidFit, MotionsInvertAndFollowEachOther) {
    const Motion a = some_motion(0.7), b = some_motion(1.3).inverse();
    const Vector3d p(0.3, -2, 5);
    EXPECT_LT((a.inverse()(a(p)) - p).norm(), 1e-12);
    EXPECT_LT((a.after(b)(p) - a(b(p))).norm(), 1e-12);
}

TEST(RigidFit, HandlesPointsThatLeaveTheMotionUndetermined) {
    const std::vector<Vector3d> single_point{{1, 2, 3}}, other{{4, 5, 6}}, same(5, Vector3d(1, 1, 1));
    EXPECT_LT((fit_motion(single_point, other)(single_point[0]) - other[0]).norm(), 1e-12);
    FitOptions options;
    options.scale = true;
    const Motion motion = fit_motion(same, same, {}, options);
    EXPECT_NEAR(motion.rotation.determinant(), 1, 1e-12);
    EXPECT_DOUBLE_EQ(motion.scale, 1);
    EXPECT_THROW((void)fit_motion(single_point, same), Error);
    EXPECT_THROW((void)fit_motion({}, {}), Error);
}

}  // namespace
}  // namespace ostraka
