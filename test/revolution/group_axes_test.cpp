#include "ostraka/revolution/group_axes.h"

#include "pot_sherds.h"
#include "sherds.h"

#include "ostraka/geom/eigen.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

using Eigen::Vector3d;
using test::sherd;
using test::tilted;

Fragment block(const Vector3d& at) {
    std::vector<int> side;
    Fragment fragment;
    fragment.mesh = build_mesh(test::box_grid(
        {8, 10, 12},
        [&](double u, double v, double w) {
            return std::array<double, 3>{at.x() + u, at.y() + 1.3 * v, at.z() + 1.7 * w};
        },
        side));
    return fragment;
}

TEST(GroupAxis, AxesOfWellPlacedSherdsAgree) {
    const Motion placement = tilted();
    const std::vector<Fragment> placed{sherd(0, 2, 0, 0.7, placement), sherd(2, 4, 0.3, 1, placement),
                                       sherd(4, 6, 0, 1, placement)};
    const GroupAxis group = axis_of_group(placed, {{0, 1}, {1, 2}});
    ASSERT_TRUE(group.axis.found) << group.axis.reason;
    EXPECT_GT(std::abs(eigen(group.axis.direction).dot(placement.rotation * Vector3d::UnitZ())), 1 - 1e-5);
    EXPECT_NEAR(group.round, 1, 1e-9);
    EXPECT_NEAR(group.diameter, 3, 0.03);
    ASSERT_EQ(group.joins.size(), 2U);
    for (const JoinAxes& join : group.joins) {
        EXPECT_EQ(join.agree, AxesAgree::yes);
        EXPECT_LT(join.angle, 0.5);
        EXPECT_LT(join.offset, 0.005);
    }
}

TEST(GroupAxis, AWrongJoinContradicts) {
    Motion wrong;
    wrong.rotation = Eigen::AngleAxisd(0.5, Vector3d(std::cos(5), std::sin(5), 0)).toRotationMatrix();
    const std::vector<Fragment> placed{sherd(0, 2, 0, 0.9, {}), sherd(2, 4, 0, 1, {}), sherd(4, 5.5, 0, 1, wrong)};
    const GroupAxis group = axis_of_group(placed, {{0, 1}, {1, 2}});
    ASSERT_EQ(group.joins.size(), 2U);
    EXPECT_EQ(group.joins[0].agree, AxesAgree::yes);
    EXPECT_EQ(group.joins[1].agree, AxesAgree::no);
    EXPECT_NEAR(group.joins[1].angle, 0.5 * 180 / M_PI, 1);
    ASSERT_EQ(group.fragments.size(), 3U);
    EXPECT_EQ(group.fragments[2].use, SherdUse::left_out);
}

TEST(GroupAxis, BlocksHaveNoAxis) {
    const std::vector<Fragment> placed{block({0, 0, 0}), block({1, 0, 0}), block({0, 1.3, 0.2})};
    const GroupAxis group = axis_of_group(placed, {{0, 1}, {0, 2}});
    EXPECT_FALSE(group.axis.found);
    EXPECT_FALSE(group.axis.reason.empty());
    for (const JoinAxes& join : group.joins) EXPECT_EQ(join.agree, AxesAgree::unknown);
    EXPECT_FALSE(axis_of_group({}, {}).axis.found);
}

}  // namespace
}  // namespace ostraka
