// Segments by clusters of slices, on a body whose segments are known.
#include "ostraka/select/slice_segments.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace ostraka {
namespace {

/// A closed tube of rings: `ring(share of the height, angle)` is the distance from the axis; z from 0 to `height`.
Mesh lofted(const std::function<double(double, double)>& ring, double height, int rings = 121, int around = 72) {
    TriangleSoup soup;
    for (int i = 0; i < rings; ++i)
        for (int k = 0; k < around; ++k) {
            const double share = static_cast<double>(i) / (rings - 1), angle = 2 * std::numbers::pi * k / around;
            const double r = ring(share, angle);
            soup.points.push_back({r * std::cos(angle), r * std::sin(angle), share * height});
        }
    const auto at = [&](int i, int k) { return static_cast<Index>(i * around + (k + around) % around); };
    for (int i = 0; i + 1 < rings; ++i)
        for (int k = 0; k < around; ++k) {
            soup.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k)});
            soup.triangles.push_back({at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)});
        }
    const auto centre = static_cast<Index>(soup.points.size());
    soup.points.push_back({0, 0, 0});
    soup.points.push_back({0, 0, height});
    for (int k = 0; k < around; ++k) {
        soup.triangles.push_back({at(0, k + 1), at(0, k), centre});
        soup.triangles.push_back({at(rings - 1, k), at(rings - 1, k + 1), centre + 1});
    }
    return build_mesh(soup);
}

/// Distance to the outline of a rectangle of half sides a and b.
double rectangle(double angle, double a, double b) {
    return std::min(a / std::max(std::abs(std::cos(angle)), 1e-9), b / std::max(std::abs(std::sin(angle)), 1e-9));
}

/// A round foot, a flat board in the middle, a round head.
double three_parts(double share, double angle) { return share < 0.35 || share > 0.75 ? 10 : rectangle(angle, 20, 5); }

TEST(SliceSegments, ProposesTheNumberOfKindsAndFindsTheirBands) {
    // Rings are so dense that no slice lies between rings of different kinds.
    const Mesh mesh = lofted(three_parts, 60, 1201, 36);
    for (const char* criterion : {"silhouette", "gap"}) {
        SliceSegmentOptions options;
        set_option(options.count, "criterion", criterion);
        const SliceSegments segments = segment_by_slices(mesh, Vector(0, 0, 1), options);
        EXPECT_EQ(segments.count.proposed, 2) << criterion;
        ASSERT_EQ(segments.segments.size(), 3U) << criterion;
        EXPECT_EQ(segments.segments[0].cluster, segments.segments[2].cluster);
        EXPECT_NE(segments.segments[0].cluster, segments.segments[1].cluster);
        EXPECT_NEAR(segments.segments[0].high, 0.35 * 60, 1.5);
        EXPECT_NEAR(segments.segments[1].high, 0.75 * 60, 1.5);
        EXPECT_DOUBLE_EQ(segments.segments[0].low, 0);
        EXPECT_NEAR(segments.segments[2].high, 60, 1e-9);
    }
}

TEST(SliceSegments, RegionsPartitionTheMesh) {
    const Mesh mesh = lofted(three_parts, 60);
    const SliceSegments segments = segment_by_slices(mesh, Vector(0, 0, 1));
    const AnnotationSet set = annotate_segments(mesh, segments);
    ASSERT_EQ(set.annotations.size(), 3U);
    std::vector<int> covered(mesh.number_of_faces(), 0);
    for (const Annotation& region : set.annotations) {
        for (const Index face : region.faces) {
            ++covered[face];
            const SliceRun& segment = segments.segments[static_cast<std::size_t>(region.id)];
            EXPECT_GE(centroid(mesh, Face(face)).z(), segment.low - 1e-9);
            EXPECT_LE(centroid(mesh, Face(face)).z(), segment.high + 1e-9);
        }
    }
    EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), static_cast<std::ptrdiff_t>(covered.size()));
    EXPECT_EQ(set.annotations[0].tag, "segment 1");
    EXPECT_EQ(set.annotations[0].colour, set.annotations[2].colour);
    EXPECT_NE(set.annotations[0].colour, set.annotations[1].colour);
}

TEST(SliceSegments, AgreementIsOverTheFacesThatHaveALabel) {
    const Mesh mesh = lofted(three_parts, 60);
    const SliceSegments segments = segment_by_slices(mesh, Vector(0, 0, 1));
    std::vector<std::int32_t> labels = segments.face_segments;
    EXPECT_DOUBLE_EQ(*segment_agreement(segments, labels), 1);
    for (std::size_t f = 0; f < labels.size(); f += 2) labels[f] = -1;
    EXPECT_DOUBLE_EQ(*segment_agreement(segments, labels), 1);
    labels[1] = (labels[1] + 1) % 3;
    EXPECT_LT(*segment_agreement(segments, labels), 1);
    EXPECT_FALSE(segment_agreement(segments, {}));
}

TEST(SliceSegments, ShortRunsJoinTheirLongerNeighbour) {
    // A round foot, and a board with a round waist of two slices' height.
    const Mesh mesh = lofted(
        [](double share, double angle) { return share < 0.3 || (share > 0.6 && share < 0.625) ? 10 : rectangle(angle, 20, 5); },
        60, 401);
    SliceSegmentOptions options;
    options.clusters = 2;
    options.min_run = 1;
    EXPECT_EQ(segment_by_slices(mesh, Vector(0, 0, 1), options).segments.size(), 4U);
    options.min_run = 5;
    EXPECT_EQ(segment_by_slices(mesh, Vector(0, 0, 1), options).segments.size(), 2U);
}

TEST(SliceSegments, SameAfterScalingAndRotationAndForAnyNumberOfThreads) {
    Mesh mesh = lofted(three_parts, 60);
    const SliceSegments before = segment_by_slices(mesh, Vector(0, 0, 1));
    for (const Vertex v : mesh.vertices()) {
        const Point p = mesh.point(v);
        mesh.point(v) = Point(7 + 1e-3 * p.z(), -3 + 1e-3 * p.x(), 1e-3 * p.y());
    }
    set_threads(1);
    const SliceSegments single_threaded = segment_by_slices(mesh, Vector(1, 0, 0));
    set_threads(3);
    const SliceSegments three = segment_by_slices(mesh, Vector(1, 0, 0));
    set_threads(0);
    EXPECT_EQ(single_threaded.face_segments, three.face_segments);
    EXPECT_EQ(single_threaded.labels, before.labels);
}

TEST(SliceSegments, OneKindGivesOneSegmentIfRequested) {
    SliceSegmentOptions options;
    options.clusters = 1;
    const SliceSegments single_segment = segment_by_slices(lofted(three_parts, 60), Vector(0, 0, 1), options);
    EXPECT_EQ(single_segment.segments.size(), 1U);
    EXPECT_EQ(single_segment.clusters, 1);
}

TEST(SliceSegments, InvalidOptionsAreRefused) {
    const Mesh mesh = lofted(three_parts, 60);
    SliceSegmentOptions options;
    options.slices = 3;
    EXPECT_THROW(segment_by_slices(mesh, Vector(0, 0, 1), options), Error);
    EXPECT_THROW(segment_by_slices(Mesh(), Vector(0, 0, 1)), Error);
    EXPECT_THROW(segment_by_slices(mesh, Vector(0, 0, 0)), Error);
    // A sheet has no closed outline.
    TriangleSoup sheet;
    sheet.points = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}};
    sheet.triangles = {{0, 1, 2}, {1, 3, 2}};
    EXPECT_THROW(segment_by_slices(build_mesh(sheet), Vector(0, 0, 1)), Error);
}

}  // namespace
}  // namespace ostraka
