// Objects as their slices: heights, hollowness, the middle axis.
#include "ostraka/slicing/sliced_object.h"

#include "meshes.h"
#include "ostraka/core/error.h"
#include "prisms.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

TEST(SlicedObject, HeightsAreListedSpacedOrInLayers) {
    SliceHeights places;
    places.count = 2;
    EXPECT_EQ(places.in(8), (std::vector<double>{2, 6}));
    places.from = 0.5;
    EXPECT_EQ(places.in(8), (std::vector<double>{5, 7}));
    places.spacing = 2;
    EXPECT_EQ(places.in(8), (std::vector<double>{4, 6, 8}));
    places.heights = {3, 1};
    EXPECT_EQ(places.in(8), (std::vector<double>{3, 1}));
}

TEST(SlicedObject, ParallelSlicesStoreTheirFrameAndTheHeightRange) {
    const Mesh mesh = build_mesh(moved(box(3), 2, {0, 0, 1}));
    SlicedObject cut = slice_parallel(mesh, slice_frame({0, 0, 0}, {0, 0, 1}), {2.5, 1.5, 9});
    EXPECT_TRUE(cut.met());
    EXPECT_EQ(cut.lowest, 1);
    EXPECT_EQ(cut.highest, 3);
    EXPECT_EQ(cut.frames.size(), 3U);
    EXPECT_EQ(cut.sorted_heights(), (std::vector<double>{1.5, 2.5, 9}));
    ASSERT_EQ(cut.centres().size(), 2U) << "the third plane misses";
    EXPECT_NEAR(CGAL::squared_distance(cut.centres()[0], Point(1, 1, 2.5)), 0, 1e-24);
    EXPECT_NEAR(cut.descriptors[1].area, 4, 1e-12);
    add_medial_axes(cut, {0.1, 0.01});
    ASSERT_EQ(cut.medial.size(), 3U);
    EXPECT_EQ(cut.medial[0].levels[0].residue, 0.01) << "the finest comes first";
    EXPECT_FALSE(slice_parallel(mesh, cut.frames[0], {9}).met());
    const SlicedObject across = slice_across(mesh, {{1, 1, 1}, {1, 1, 3}}, 4);
    EXPECT_FALSE(across.parallel);
    EXPECT_EQ(across.highest, 2);
    EXPECT_EQ(across.centres().size(), 4U);
    const Mesh line = build_mesh({{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}, {{0, 1, 2}}});
    EXPECT_THROW(slice_parallel(line, cut.frames[0], {1}), Error);
}

TEST(SlicedObject, VesselsAreHollowAndBallsAreNot) {
    const TriangleSoup ball = octahedron_sphere(4);
    TriangleSoup within = moved(ball, 0.9, {0, 0, 0});
    for (auto& t : within.triangles) std::swap(t[1], t[2]);
    for (const Vector& up : {Vector(0, 0, 1), Vector(1, 2, 3)}) {
        EXPECT_TRUE(is_hollow(build_mesh(joined(ball, within)), up));
        EXPECT_FALSE(is_hollow(build_mesh(ball), up));
    }
}

TEST(SlicedObject, TheMedianFrameStaysWithTheBody) {
    // A handle beside the body at one height of three.
    const Polygon body = rectangle(2, 2), arm = rectangle(1, 1, {10, 0});
    TriangleSoup soup = to_soup(walls({body}));
    for (double z : {1.0, 2.0}) soup = joined(soup, moved(to_soup(walls({body})), 1, {0, 0, z}));
    soup = joined(soup, to_soup(walls({arm})));
    const SlicedObject cut = slice_parallel(build_mesh(soup), slice_frame({-3, 0, 0}, {0, 0, 1}), {0.5, 1.5, 2.5});
    EXPECT_GT(cut.centres()[0].x(), 1);
    EXPECT_NEAR(median_frame(cut).origin.x(), 0, 1e-12);
}
