// Self-intersecting meshes, and shells with inconsistent orientation: which values are reported and which are left out.
#include "ostraka/slicing/clay.h"
#include "ostraka/slicing/medial_axis.h"
#include "ostraka/slicing/slice_descriptors.h"
#include "slicing/curve_slices.h"

#include "meshes.h"
#include "prisms.h"

#include "ostraka/execution/parallel.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

TriangleSoup inside_out(TriangleSoup soup) {
    for (auto& t : soup.triangles) std::swap(t[1], t[2]);
    return soup;
}
Slice cut(const Mesh& mesh, double height, const Vector& normal = {0, 0, 1}) {
    return slice_mesh(mesh, slice_frame({0, 0, 0}, normal), {height}).slices.at(0);
}
double area(const Slice& slice) { return describe_slice(slice).area; }

TriangleSoup turned(TriangleSoup soup, double angle, double scale, const std::array<double, 3>& translation) {
    for (auto& p : soup.points) {
        const double x = std::cos(angle) * p[0] - std::sin(angle) * p[1], y = std::sin(angle) * p[0] + std::cos(angle) * p[1];
        p = {scale * (x + translation[0]), scale * (y + translation[1]), scale * (p[2] + translation[2])};
    }
    return soup;
}

}  // namespace

TEST(SliceSoundness, ShellsThatCrossHaveNoAreas) {
    for (const double scale : {1e-6, 1.0, 1e6})
        for (const double away : {0.0, 1e4}) {
            const Mesh mesh = build_mesh(turned(joined(octahedron_sphere(4), moved(octahedron_sphere(4), 0.9, {1, 0.1, 0.05})),
                                                0.3, scale, {away, -away, 0}));
            const Slice slice = cut(mesh, 0.1 * scale);
            ASSERT_EQ(slice.contours.size(), 2U);
            EXPECT_EQ(slice.completeness.crossing, 2);
            EXPECT_EQ(slice.completeness.reversed_contours, 0);
            EXPECT_GT(slice.completeness.doubtful, 0.1);
            EXPECT_FALSE(slice.completeness.has_areas());
            EXPECT_TRUE(slice.completeness.complete());
            const SliceDescriptors d = describe_slice(slice);
            for (const double value : {d.area, d.perimeter, d.solidity, d.compactness, d.barycentre.x(), d.outline_area,
                                       d.hole_area_ratio, d.equivalent_radius, d.fitted_radius, d.thickness_mean})
                EXPECT_TRUE(std::isnan(value));
            // The hull is that of both.
            EXPECT_NEAR(d.box_length / scale, 1 + 0.9 + std::hypot(1, 0.1), 0.05);
            EXPECT_FALSE(d.counted);
            EXPECT_GT(d.closed_length, 0);
            EXPECT_TRUE(thickness_profile(slice).empty());
            for (const auto& level : medial_axis(slice).levels) EXPECT_TRUE(level.branches.empty());
        }
}

TEST(SliceSoundness, AFoldTooSmallToMatterLeavesAreas) {
    // A small piece that crosses the surface: it is detected, and counts at most its own area twice.
    const Mesh mesh = build_mesh(joined(octahedron_sphere(5), moved(octahedron_sphere(2), 0.01, {1, 0.003, 0.002})));
    const Slice slice = cut(mesh, 0.001);
    EXPECT_EQ(slice.completeness.crossing, 2);
    EXPECT_GT(slice.completeness.doubtful, 0);
    EXPECT_LE(slice.completeness.doubtful, 1.001e-4);
    EXPECT_NEAR(area(slice), M_PI, 0.01);
}

TEST(SliceSoundness, AContourThatCrossesItself) {
    // A bow tie has no area at all.
    const Slice bow = cut(walls({{{0, 0}, {4, 0.1}, {4, 2}, {0, 2.2}, {2.9, -1}}}), 0.5);
    ASSERT_EQ(bow.contours.size(), 1U);
    EXPECT_EQ(bow.completeness.crossing, 1);
    EXPECT_FALSE(bow.completeness.has_areas());
    const Slice convex = cut(walls({{{0, 0}, {4, 0.1}, {4, 2}, {0, 2.2}, {-1, 1}}}), 0.5);
    EXPECT_EQ(convex.completeness.crossing, 0);
    EXPECT_EQ(convex.completeness.doubtful, 0);
}

TEST(SliceSoundness, CrossingThroughVerticesAndWithoutThem) {
    // Bars of a cross, whose sides meet at vertices of both, and plain ones whose corners are all outside the other.
    const auto cross = [](int pieces) {
        return cut(walls({refined(rectangle(3, 1), pieces), refined(rectangle(1, 3), pieces)}), 0.5);
    };
    const Polygon across{{-1.5, -0.5}, {-0.5, -0.5}, {0.5, -0.5}, {1.5, -0.5}, {1.5, 0.5}, {0.5, 0.5}, {-0.5, 0.5}, {-1.5, 0.5}};
    Polygon along;
    for (const auto& p : across) along.push_back({-p.y(), p.x()});
    for (const Slice& slice : {cross(1), cross(3), cut(walls({across, along}), 0.5)}) {
        EXPECT_EQ(slice.completeness.crossing, 2);
        EXPECT_FALSE(slice.completeness.has_areas());
    }
    // A duplicated shell counts twice; with opposite orientations it cancels.
    const Polygon round = ellipse(90, 3, 2);
    EXPECT_FALSE(cut(walls({round, round}), 0.5).completeness.has_areas());
    const Slice sheet = cut(walls({round, reversed(round)}), 0.5);
    EXPECT_EQ(sheet.completeness.crossing, 0);
    EXPECT_EQ(sheet.completeness.reversed_contours, 0);
}

TEST(SliceSoundness, TouchingContoursDoNotCross) {
    for (const double angle : {0.0, 0.1, 1.0, 2.5})
        for (const double scale : {1e-5, 1.0, 1e5}) {
            const auto placed = [&](const Polygon& polygon) {
                return transformed(polygon, scale, angle, {7 * scale, -3 * scale});
            };
            const Polygon outer = rectangle(4, 4);
            for (const Polygon& other :
                 {rectangle(2, 2, {3, 3}), rectangle(2, 2, {3, 0}), refined(rectangle(2, 2, {3, 0.3}), 5),
                  reversed(rectangle(2, 2, {1, 0})), reversed(refined(rectangle(2, 2, {1, 0.1}), 3)), rectangle(2, 9, {3, 0})}) {
                const Slice slice = cut(walls({placed(outer), placed(other)}), 0.5);
                EXPECT_EQ(slice.completeness.crossing, 0);
                EXPECT_EQ(slice.completeness.reversed_contours, 0);
                EXPECT_EQ(slice.completeness.doubtful, 0);
            }
        }
    // Boxes side by side, in any rotation.
    for (const double angle : {0.0, 0.7}) {
        const Mesh mesh = build_mesh(turned(joined(box(5), moved(box(3), 1, {1, 0, 0})), angle, 1, {0, 0, 0}));
        EXPECT_EQ(cut(mesh, 0.41).completeness.crossing, 0);
        EXPECT_NEAR(area(cut(mesh, 0.41)), 2, 1e-9);
    }
}

TEST(SliceSoundness, NestedShellsAreOrientedByTheirNesting) {
    const double outer = area(cut(build_mesh(octahedron_sphere(4)), 0.1)),
                 inner = area(cut(build_mesh(moved(octahedron_sphere(4), 0.5, {0, 0, 0})), 0.1));
    const TriangleSoup big = octahedron_sphere(4), small = moved(octahedron_sphere(4), 0.5, {0, 0, 0});
    struct Case {
        TriangleSoup soup;
        int turned;
        bool reversed;
    };
    for (const Case& expected :
         {Case{joined(big, inside_out(small)), 0, false}, Case{joined(big, small), 1, false},
          Case{joined(inside_out(big), small), 0, true}, Case{joined(inside_out(big), inside_out(small)), 1, true}}) {
        const Mesh mesh = build_mesh(expected.soup);
        const SliceStack stack = slice_mesh(mesh, slice_frame({0, 0, 0}, {0, 0, 1}), {0.1, 0.7});
        const Slice& slice = stack.slices[0];
        EXPECT_EQ(stack.reversed, expected.reversed);
        EXPECT_EQ(slice.completeness.reversed_contours, expected.turned);
        EXPECT_EQ(slice.completeness.crossing, 0);
        ASSERT_EQ(slice.contours.size(), 2U);
        EXPECT_FALSE(slice.contours[0].hole);
        EXPECT_TRUE(slice.contours[1].hole);
        const SliceDescriptors d = describe_slice(slice);
        EXPECT_NEAR(d.area, outer - inner, 1e-12);
        EXPECT_NEAR(d.hole_area, inner, 1e-12);
        EXPECT_LE(d.solidity, 1);
        EXPECT_EQ(d.euler_number, 0);
        EXPECT_NEAR(d.thickness_min, std::sqrt(0.99) - std::sqrt(0.24), 0.02);
    }
    // A body next to another, inside out: its area is the same.
    const Mesh pair = build_mesh(joined(big, inside_out(moved(small, 1, {4, 0, 0}))));
    EXPECT_NEAR(area(cut(pair, 0.1)), outer + inner, 1e-12);
    EXPECT_EQ(cut(pair, 0.1).completeness.reversed_contours, 1);
    // Open meshes are not checked, since parts may be missing.
    EXPECT_EQ(cut(walls({reversed(rectangle(2, 2))}), 0.5).completeness.reversed_contours, 0);
    EXPECT_TRUE(std::isnan(area(cut(walls({reversed(rectangle(2, 2))}), 0.5))));
}

TEST(SliceSoundness, TheSameBitsForAnyNumberOfThreads) {
    const Mesh mesh = build_mesh(joined(joined(octahedron_sphere(4), moved(octahedron_sphere(4), 1, {0.9, 0.1, 0.05})),
                                        moved(octahedron_sphere(3), 0.2, {-0.5, 0, 0})));
    const auto heights = slice_heights(-1, 1, 31);
    set_threads(1);
    const SliceStack sequential = slice_mesh(mesh, slice_frame({0, 0, 0}, {0, 0, 1}), heights);
    set_threads(3);
    const SliceStack parallel = slice_mesh(mesh, slice_frame({0, 0, 0}, {0, 0, 1}), heights);
    set_threads(0);
    for (std::size_t i = 0; i < heights.size(); ++i) {
        EXPECT_EQ(sequential.slices[i].completeness.doubtful, parallel.slices[i].completeness.doubtful);
        EXPECT_EQ(sequential.slices[i].completeness.reversed_contours, parallel.slices[i].completeness.reversed_contours);
        ASSERT_EQ(sequential.slices[i].contours.size(), parallel.slices[i].contours.size());
        for (std::size_t c = 0; c < sequential.slices[i].contours.size(); ++c)
            EXPECT_EQ(sequential.slices[i].contours[c].points, parallel.slices[i].contours[c].points);
    }
}

TEST(SliceSoundness, SlicesAlongACurveMatchPlanes) {
    // Along a straight curve the planes are those of slice_mesh; the ends are faces of a box, one of them its lowest place.
    const Mesh mesh = build_mesh(joined(box(6), moved(box(4), 0.4, {0.3, 0.3, 0.3})));
    for (const std::vector<Index>& faces :
         {std::vector<Index>{}, std::vector<Index>{0, 1, 2, 30, 31, 32, 70, 71, 100, 101, 150}}) {
        const CurveSlices across = slice_along(mesh, {{0.5, 0.5, 0}, {0.5, 0.5, 0.4}, {0.5, 0.5, 1}}, 12, faces);
        ASSERT_EQ(across.slices.size(), 12U);
        for (std::size_t i = 0; i < across.slices.size(); ++i) {
            const Slice parallel = slice_mesh(mesh, across.frames[i], {0}, faces).slices[0];
            std::vector<std::vector<Eigen::Vector2d>> contours;
            for (const auto& contour : parallel.contours) contours.push_back(contour.points);
            for (const auto& contour : across.slices[i].contours)
                EXPECT_NE(std::find(contours.begin(), contours.end(), contour.points), contours.end()) << i;
            EXPECT_EQ(across.slices[i].contours.empty(), parallel.contours.empty()) << i;
        }
    }
    // On the lowest plane the base counts; a plane below meets nothing.
    const CurveSlices base = slice_along(mesh, {{0.5, 0.5, -0.5}, {0.5, 0.5, 0.5}}, 1);
    ASSERT_EQ(base.slices[0].contours.size(), 1U);
    EXPECT_NEAR(area(base.slices[0]), 1, 1e-12);
    EXPECT_TRUE(slice_along(mesh, {{0.5, 0.5, -3}, {0.5, 0.5, -2}}, 1).slices[0].contours.empty());
    // Inside out it is the same.
    const CurveSlices reversed = slice_along(build_mesh(inside_out(box(6))), {{0.5, 0.5, 0}, {0.5, 0.5, 1}}, 5);
    EXPECT_TRUE(reversed.reversed);
    for (const Slice& slice : reversed.slices) EXPECT_NEAR(area(slice), 1, 1e-12);
}

TEST(ClaySoundness, CrossingShellsAreNotCountedTwice) {
    const SliceFrame upright = slice_frame({0, 0, 0}, {0, 0, 1});
    // Two balls that intersect around their centres: the maximum is a bound, not below that of both separately.
    const double ball = clay_volume(build_mesh(octahedron_sphere(5)), upright).maximum;
    const ClayVolume clay =
        clay_volume(build_mesh(joined(octahedron_sphere(5), moved(octahedron_sphere(5), 1, {1, 0, 0}))), upright);
    EXPECT_GT(clay.crossing, clay.slices / 2);
    EXPECT_LT(clay.crossing, clay.slices);
    EXPECT_GE(clay.maximum, 2 * ball - 5 * M_PI / 12);  // minus the intersection
    EXPECT_LT(clay.maximum, 2 * ball);
    EXPECT_TRUE(std::isnan(clay.envelope));
    const ClayVolume tubes = clay_volume(build_mesh(joined(tube(90, 5), moved(tube(90, 5), 1, {0.5, 0, 0}))), upright);
    EXPECT_EQ(tubes.crossing, tubes.slices);
    EXPECT_NEAR(tubes.maximum, 3 * (M_PI + 1), 0.02);  // the hull
    EXPECT_EQ(tubes.without_outline, 0);
    // A cavity oriented outwards, and all of it inside out.
    const TriangleSoup big = octahedron_sphere(4), small = moved(octahedron_sphere(4), 0.5, {0, 0, 0});
    const ClayVolume reference = clay_volume(build_mesh(joined(big, inside_out(small))), upright);
    for (const TriangleSoup& soup : {joined(big, small), joined(inside_out(big), small)}) {
        const ClayVolume other = clay_volume(build_mesh(soup), upright);
        EXPECT_NEAR(other.maximum, reference.maximum, 1e-12);
        EXPECT_NEAR(other.minimum, reference.minimum, 1e-12);
        EXPECT_NEAR(other.envelope, reference.envelope, 1e-12);
        EXPECT_TRUE(other.reversed || other.reversed_slices > 0);
    }
    EXPECT_FALSE(reference.reversed);
    EXPECT_EQ(reference.reversed_slices, 0);
    EXPECT_EQ(reference.crossing, 0);
}
