#include "ostraka/reconstruction/rigid_scale.h"

#include "ostraka/core/error.h"
#include "ostraka/registration/procrustes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>

namespace ostraka {
namespace {

using Eigen::Vector3d;

/// A hand and a forearm: two groups of five landmarks that meet at the origin.
std::vector<Vector3d> arm() {
    std::vector<Vector3d> marks;
    for (const double side : {-1.0, 1.0})
        for (const auto& p :
             {Vector3d(4, 0, 0), Vector3d(5, 1, 0), Vector3d(5, 0, 1), Vector3d(6, 0.5, 0.3), Vector3d(5.5, -0.8, 0.4)})
            marks.emplace_back(side * p.x(), p.y(), p.z());
    return marks;
}

std::vector<Vector3d> turned(std::vector<Vector3d> marks, double scale, double bend) {
    const Eigen::AngleAxisd joint(bend, Vector3d::UnitZ()), rigid_rotation(0.7, Vector3d(1, 2, -1).normalized());
    for (std::size_t i = 0; i < marks.size(); ++i) {
        if (i >= marks.size() / 2) marks[i] = joint * marks[i];
        marks[i] = scale * (rigid_rotation * marks[i]) + Vector3d(100, -20, 3);
    }
    return marks;
}

TEST(RigidScale, IsThatOfASimilarity) {
    EXPECT_NEAR(rigid_scale(arm(), turned(arm(), 1.3, 0)), 1.3, 1e-9);
    EXPECT_NEAR(rigid_scale(arm(), turned(arm(), 0.001, 0)), 0.001, 1e-12);
}

TEST(RigidScale, PostureDoesNotChangeIt) {
    const auto marks = arm();
    for (const double bend : {0.5, 1.5, 2.5}) {
        const auto bent = turned(marks, 1.3, bend);
        EXPECT_NEAR(rigid_scale(marks, bent), 1.3, 1e-9) << bend;
    }
    // The similarity over all landmarks interprets the bent arm as a smaller one.
    Landmarks from(10, 3), to(10, 3);
    const auto bent = turned(marks, 1.3, 1.5);
    for (Eigen::Index i = 0; i < 10; ++i) {
        from.row(i) = marks[static_cast<std::size_t>(i)].transpose();
        to.row(i) = bent[static_cast<std::size_t>(i)].transpose();
    }
    ProcrustesOptions scaled;
    scaled.scaling = true;
    EXPECT_LT(procrustes(from, to, scaled).scale, 1.1);
}

TEST(RigidStrain, IsZeroInAnyPosture) {
    const auto marks = arm();
    for (const double bend : {0.0, 0.5, 2.5}) EXPECT_NEAR(rigid_strain(marks, turned(marks, 1.3, bend)).value(), 0, 1e-9) << bend;
    EXPECT_FALSE(rigid_strain({marks.begin(), marks.begin() + 5}, {marks.begin(), marks.begin() + 5}));
}

TEST(RigidStrain, DetectsAnotherShape) {
    auto other = arm();
    for (Vector3d& p : other) p = Vector3d(0.5, 2, 1).cwiseProduct(p);
    EXPECT_NEAR(rigid_strain(arm(), other).value(), 0.2379, 1e-3);
}

TEST(RigidScale, OfFewOrCoincidingLandmarks) {
    EXPECT_EQ(rigid_scale({}, {}), 0);
    EXPECT_EQ(rigid_scale({Vector3d(1, 2, 3)}, {Vector3d(1, 2, 3)}), 0);
    EXPECT_EQ(rigid_scale({Vector3d(1, 2, 3), Vector3d(1, 2, 3)}, {Vector3d(0, 0, 0), Vector3d(1, 0, 0)}), 0);
    EXPECT_NEAR(rigid_scale({Vector3d(0, 0, 0), Vector3d(2, 0, 0)}, {Vector3d(0, 5, 0), Vector3d(0, 6, 0)}), 0.5, 1e-12);
    EXPECT_THROW(static_cast<void>(rigid_scale({Vector3d(0, 0, 0)}, {})), Error);
}

}  // namespace
}  // namespace ostraka
