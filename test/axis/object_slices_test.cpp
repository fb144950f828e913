// Objects cut along their own axes, and the axes with which their slices are compared.
#include "ostraka/axis/object_slices.h"

#include "meshes.h"
#include "ostraka/core/error.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// An ellipsoid with half axes 1, 1, 3 whose long axis is y.
Mesh lying() {
    TriangleSoup soup = octahedron_sphere(4);
    for (auto& p : soup.points) p[1] *= 3;
    return build_mesh(soup);
}

}  // namespace

TEST(ObjectSlices, HeightsAreAboveTheLowestPointAlongTheAxis) {
    CutOptions options;
    options.places.count = 5;
    options.up = {0, 1, 1};
    for (const AxisMethod direction : {AxisMethod::principal, AxisMethod::rotation}) {
        options.direction = direction;
        const SlicedObject cut = cut_object(lying(), {}, options);
        ASSERT_EQ(cut.slices.size(), 5U) << cut.reason;
        EXPECT_NEAR(cut.frames[0].normal.y(), 1, 1e-4) << "it points upwards as far as it does";
        EXPECT_EQ(cut.lowest, 0);
        EXPECT_NEAR(cut.highest, 6, 1e-3);
        EXPECT_NEAR(cut.slices[2].height, 3, 1e-3);
    }
    options.direction.reset();
    options.up = {0, 0, -1};
    EXPECT_NEAR(cut_object(lying(), {}, options).highest, 2, 1e-9);
    options.direction = AxisMethod::skeleton;
    const SlicedObject bent = cut_object(lying(), {}, options);
    EXPECT_FALSE(bent.parallel);
    EXPECT_EQ(bent.slices.size(), 5U);
    EXPECT_FALSE(bent.curve.empty());
}

TEST(ObjectSlices, ReportsWhyAnObjectHasNoSuchAxis) {
    CutOptions options;
    options.direction = AxisMethod::principal;
    const SlicedObject unsliced = cut_object(build_mesh(octahedron_sphere(3)), {}, options);
    EXPECT_TRUE(unsliced.slices.empty());
    EXPECT_NE(unsliced.reason.find("no principal axis to slice along"), std::string::npos) << unsliced.reason;
    EXPECT_THROW(cut_object(build_mesh({{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}, {{0, 1, 2}}}), {}, options), Error);
}

TEST(ObjectSlices, ComparedAxes) {
    const Mesh mesh = lying();
    CutOptions options;
    options.up = {0, 1, 0};
    options.places.count = 6;
    const SlicedObject cut = cut_object(mesh, {}, options);
    EXPECT_EQ(compared_axes(mesh, {}, cut, false).size(), 2U);
    const auto axes = compared_axes(mesh, {}, cut, true);
    ASSERT_EQ(axes.size(), 6U);
    for (const auto& axis : axes) EXPECT_LT(axis.straightness.mean, 0.1) << axis.name;
    EXPECT_EQ(axes[2].name, "rotation");
    EXPECT_EQ(axes[2].reason, "");
    options.places.heights = {1, 2};
    const auto two = compared_axes(mesh, {}, cut_object(mesh, {}, options), false);
    ASSERT_EQ(two.size(), 2U);
    EXPECT_EQ(two[1].reason, "two barycentres are always collinear");
    options.places.heights = {1};
    EXPECT_TRUE(compared_axes(mesh, {}, cut_object(mesh, {}, options), true).empty());
}
