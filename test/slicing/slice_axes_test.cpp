// Axes of stacks of discs whose centres are known; walls of known evenness; tubes between other parts.
#include "ostraka/slicing/slice_axes.h"

#include "ostraka/core/error.h"
#include "prisms.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// A slice made of polygons, without a mesh.
Slice slice_at(double height, const std::vector<Polygon>& polygons) {
    Slice slice = slice_mesh(walls(polygons), slice_frame({0, 0, 0}, {0, 0, 1}), {0.5}).slices[0];
    slice.height = height;
    return slice;
}

}  // namespace

TEST(SliceAxes, OfALeaningTube) {
    SliceStack stack;
    stack.frame = slice_frame({5, 6, 7}, {0, 1, 0});
    for (int i = 0; i <= 10; ++i) stack.slices.push_back(slice_at(i, {ellipse(50, 2, 2, {0.3 * i, 0})}));
    const auto descriptors = describe_slices(stack.slices);
    const auto centres = barycentres(stack, descriptors);
    ASSERT_EQ(centres.size(), 11U);
    const SliceLine mean = mean_line(stack.frame, centres), fit = regression_line(stack.frame, centres);
    EXPECT_NEAR((mean.direction - Vector(0, 1, 0)).squared_length(), 0, 1e-20);
    const Vector lean = (stack.frame.normal + 0.3 * stack.frame.u) / std::sqrt(1.09);
    EXPECT_NEAR((fit.direction - lean).squared_length(), 0, 1e-20);
    // The mean line is 0.3 |i - 5| away, 0.3 * 30 / 11 on average; the fitted one passes through all.
    const Straightness from_mean = straightness(centres, mean), from_fit = straightness(centres, fit);
    EXPECT_NEAR(from_mean.mean, 0.3 * 30 / 11, 1e-9);
    EXPECT_NEAR(from_mean.maximum, 1.5, 1e-9);
    EXPECT_NEAR(from_mean.length, 10, 1e-9);
    EXPECT_NEAR(from_mean.relative, 0.03 * 30 / 11, 1e-10);
    EXPECT_NEAR(from_fit.mean, 0, 1e-9);
    EXPECT_NEAR(from_fit.length, 10 * std::sqrt(1.09), 1e-9);
    EXPECT_NEAR(straightness(centres, centres).mean, 0, 1e-12);
    EXPECT_NEAR(straightness(centres, std::vector<Point>{centres.front(), centres.back()}).length, 10 * std::sqrt(1.09), 1e-9);
    // Outlines and material differ if the cavity is eccentric.
    SliceStack hollow = stack;
    hollow.slices = {slice_at(0, {ellipse(400, 3, 3), reversed(ellipse(400, 1, 1, {1, 0}))})};
    const auto of_hollow = describe_slices(hollow.slices);
    EXPECT_NEAR((hollow.frame.place(barycentres(hollow, of_hollow)[0])).x(), -1.0 / 8, 1e-4);
    EXPECT_NEAR((hollow.frame.place(barycentres(hollow, of_hollow, true)[0])).x(), 0, 1e-9);
}

TEST(SliceAxes, OfTooFewSlices) {
    const SliceFrame frame = slice_frame({0, 0, 0}, {0, 0, 1});
    EXPECT_THROW((void)mean_line(frame, {}), Error);
    EXPECT_THROW((void)regression_line(frame, {{1, 2, 3}}), Error);
    EXPECT_THROW((void)regression_line(frame, {{1, 2, 3}, {1, 2, 3}}), Error);
    EXPECT_THROW((void)straightness({{1, 2, 3}}, std::vector<Point>{}), Error);
    EXPECT_EQ(straightness({{0, 3, 1}}, SliceLine{}).mean, 3);
    EXPECT_EQ(straightness({{0, 3, 1}}, SliceLine{}).relative, 0);
    EXPECT_EQ(straightness({}, SliceLine{}).mean, 0);
}

TEST(SliceAxes, ThicknessHomogeneityOfWalls) {
    // Concentric rings, of walls 1, 2 and 3: even within, not across.
    std::vector<Slice> slices;
    for (const double wall : {1.0, 2.0, 3.0})
        slices.push_back(slice_at(wall, {ellipse(500, 5, 5), reversed(ellipse(500, 5 - wall, 5 - wall))}));
    slices.push_back(slice_at(4, {ellipse(50, 5, 5)}));
    const auto homogeneous = thickness_homogeneity(slices);
    EXPECT_EQ(homogeneous.slices, 3U);
    EXPECT_EQ(homogeneous.beside, 0U);
    EXPECT_NEAR(homogeneous.mean, 2, 1e-3);
    EXPECT_NEAR(homogeneous.within, 0, 1e-3);
    EXPECT_NEAR(homogeneous.across, 1.4826 / 2, 1e-3);
    EXPECT_NEAR(homogeneous.overall, std::sqrt(2.0 / 3) / 2, 1e-3);
    const auto single = thickness_homogeneity({slices[0]});
    EXPECT_TRUE(std::isnan(single.across));
    EXPECT_NEAR(single.overall, 0, 1e-3);
    EXPECT_TRUE(std::isnan(thickness_homogeneity({}).mean));
    // No wall at all: the hole covers the outline.
    const auto no_wall = thickness_homogeneity({slice_at(0, {ellipse(50, 5, 5), reversed(ellipse(50, 5, 5))})});
    EXPECT_TRUE(std::isnan(no_wall.mean) || no_wall.mean < 1e-12);
}

TEST(SliceAxes, HandlesCrumbsAndAFootDoNotChangeTheHomogeneity) {
    const auto ring = [](double wall) { return std::vector{ellipse(500, 5, 5), reversed(ellipse(500, 5 - wall, 5 - wall))}; };
    std::vector<Slice> slices;
    for (int i = 0; i < 9; ++i) slices.push_back(slice_at(i, ring(1)));
    const auto simple = thickness_homogeneity(slices);
    // A small piece next to the wall; a thick foot.
    auto crumbs = ring(1);
    crumbs.push_back(ellipse(40, 0.1, 0.1, {8, 0})), crumbs.push_back(reversed(ellipse(40, 0.05, 0.05, {8, 0})));
    slices.push_back(slice_at(9, crumbs));
    slices.push_back(slice_at(-1, ring(4)));
    // A hollow handle, and one that encloses a hole with the wall.
    auto handle = ring(1), joined = ring(1);
    handle.push_back(ellipse(80, 1, 1, {8, 0})), handle.push_back(reversed(ellipse(80, 0.2, 0.2, {8, 0})));
    joined[0] = ellipse(500, 9, 6), joined.push_back(reversed(ellipse(80, 1, 1, {7, 0})));
    slices.push_back(slice_at(10, handle)), slices.push_back(slice_at(11, joined));
    const auto disturbed = thickness_homogeneity(slices);
    EXPECT_EQ(disturbed.slices, 11U);
    EXPECT_EQ(disturbed.beside, 2U);
    EXPECT_NEAR(disturbed.mean, simple.mean, 1e-9);
    EXPECT_NEAR(disturbed.within, simple.within, 1e-9);
    EXPECT_NEAR(disturbed.across, 0, 1e-9);
}

TEST(SliceAxes, TheTubeBetweenFeetAndHead) {
    SliceStack stack;
    // Two feet, an even body, wide shoulders, a square head; slices in any order.
    for (int i = 0; i < 4; ++i) stack.slices.push_back(slice_at(i, {ellipse(40, 1, 1, {-2, 0}), ellipse(40, 1, 1, {2, 0})}));
    for (int i = 4; i < 20; ++i) stack.slices.push_back(slice_at(i, {ellipse(60, 3 - 0.01 * i, 3 + 0.01 * i)}));
    for (int i = 20; i < 25; ++i) stack.slices.push_back(slice_at(i, {ellipse(60, 8, 2)}));
    for (int i = 25; i < 28; ++i) stack.slices.push_back(slice_at(i, {ellipse(60, 1.2, 1.2)}));
    std::reverse(stack.slices.begin(), stack.slices.begin() + 15);
    const auto descriptors = describe_slices(stack.slices);
    const Tube tube = tubular_part(stack, descriptors);
    ASSERT_TRUE(tube.found) << tube.reason;
    EXPECT_EQ(tube.first, 4U);
    EXPECT_EQ(tube.last, 19U);
    EXPECT_EQ(tube.cluster[0], -1);
    EXPECT_EQ(tube.cluster[22], -1);
    EXPECT_NE(tube.cluster[26], tube.cluster[10]);
    TubeOptions strict;
    strict.max_roundness = 1e-6;
    EXPECT_FALSE(tubular_part(stack, descriptors, strict).found);
    EXPECT_FALSE(tubular_part({}, {}).found);
    EXPECT_THROW((void)tubular_part(stack, {}), Error);
    // All the same: one group.
    SliceStack uniform;
    for (int i = 0; i < 5; ++i) uniform.slices.push_back(slice_at(i, {ellipse(40, 1, 1)}));
    const Tube uniform_tube = tubular_part(uniform, describe_slices(uniform.slices));
    EXPECT_TRUE(uniform_tube.found && uniform_tube.first == 0 && uniform_tube.last == 4);
}
