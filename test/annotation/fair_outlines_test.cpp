// Fairing of stepped outlines.
#include "ostraka/annotation/fair_outlines.h"
#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// The sphere divided into a cap around an axis not aligned with the mesh, a band and the rest, by the faces' centroids.
AnnotationSet parted(const Mesh& mesh) {
    const Vector axis(0.36, 0.48, 0.8);
    AnnotationSet set;
    set.annotations.resize(3);
    for (int i = 0; i < 3; ++i) {
        set.annotations[i].id = i;
        set.annotations[i].tag = "part " + std::to_string(i);
    }
    for (const Face f : mesh.faces()) {
        const double height = (centroid(mesh, f) - CGAL::ORIGIN) * axis;
        set.annotations[height > 0.6 ? 0 : height > -0.1 ? 1 : 2].faces.push_back(f);
    }
    return set;
}

}  // namespace

TEST(FairOutlines, PartsOfASphereBecomeCircles) {
    const Mesh mesh = build_mesh(octahedron_sphere(5));
    AnnotationSet set = parted(mesh);
    const AnnotationSet before = set;
    const auto faired = fair_outlines(mesh, set, {});
    check_annotations({mesh, set}, "faired");
    ASSERT_EQ(faired.size(), 3U);
    const double limit = 1.3 * mean_edge_length(mesh);  // edges along the outline may be longer than the mean
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_TRUE(faired[i].note.empty());
        EXPECT_LE(faired[i].moved, limit);
        EXPECT_NEAR(faired[i].area_after / faired[i].area_before, 1, 1e-3);
        EXPECT_EQ(faired[i].area_before, measure_region(mesh, before.annotations[i].faces).area);
        EXPECT_EQ(faired[i].area_after, area_of(mesh, set.annotations[i]));
        sum += faired[i].area_after;
    }
    EXPECT_NEAR(sum / surface_area(mesh), 1, 1e-9);  // neighbours share their border
    // The perimeter of a circle around the cap's area: along edges it is a fifth too long.
    const double height = 1 - faired[0].area_after / (2 * std::numbers::pi),
                 circle = 2 * std::numbers::pi * std::sqrt(1 - height * height);
    EXPECT_GT(faired[0].length_before / circle, 1.1);
    EXPECT_NEAR(faired[0].length_after / circle, 1, 0.02);
    EXPECT_NEAR(faired[1].length_after / (faired[0].length_after + faired[2].length_after), 1, 1e-9);
}

TEST(FairOutlines, StaysWithinTheDistance) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    for (const double share : {0.1, 0.3, 1.0}) {
        AnnotationSet set = parted(mesh);
        FairOptions options;
        options.distance = share * mean_edge_length(mesh);
        for (const auto& faired : fair_outlines(mesh, set, {}, options)) EXPECT_LE(faired.moved, options.distance) << share;
        check_annotations({mesh, set}, "faired");
    }
}

TEST(FairOutlines, OnlyRequestedAnnotationsAreFaired) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    AnnotationSet set = parted(mesh);
    const auto faired = fair_outlines(mesh, set, {0});
    ASSERT_EQ(faired.size(), 1U);
    EXPECT_TRUE(is_free(set.annotations[0]));
    EXPECT_FALSE(is_free(set.annotations[1]));
    EXPECT_THROW(fair_outlines(mesh, set, {77}), Error);
    FairOptions options;
    options.distance = -1;
    EXPECT_THROW(fair_outlines(mesh, set, {}, options), Error);
    AnnotationSet none;
    EXPECT_TRUE(fair_outlines(mesh, none, {}).empty());
}

TEST(FairOutlines, SmallRegionsAreUnchanged) {
    const Mesh mesh = build_mesh(octahedron_sphere(3));
    AnnotationSet set;
    set.annotations.resize(1);
    set.annotations[0].tag = "triangle";
    set.annotations[0].faces = {17};
    const auto faired = fair_outlines(mesh, set, {});
    ASSERT_EQ(faired.size(), 1U);
    EXPECT_LT(faired[0].moved, 1e-12);
    EXPECT_NEAR(faired[0].area_after, faired[0].area_before, 1e-12);
    EXPECT_EQ(set.annotations[0].faces, std::vector<Index>{17});
}

TEST(FairOutlines, RoundingUnitAndPositionChangeNothing) {
    const Mesh mesh = build_mesh(octahedron_sphere(4));
    const auto measured = [&](double scale, const Vector& by, double noise) {
        Mesh other = mesh;
        double sense = 1;
        for (const Vertex v : other.vertices()) {
            const Point& p = mesh.point(v);
            const auto off = [&](double x) { return x * scale * (1 + (sense = -sense) * noise); };
            other.point(v) = Point(off(p.x()), off(p.y()), off(p.z())) + by;
        }
        AnnotationSet set = parted(mesh);
        std::vector<double> values;
        for (const FairedAnnotation& faired : fair_outlines(other, set, {})) {
            values.push_back(faired.length_after / scale);
            values.push_back(faired.area_after / (scale * scale));
        }
        return values;
    };
    const Vector nowhere(0, 0, 0);
    const std::vector<double> as_it_is = measured(1, nowhere, 0);
    for (const auto& other : {measured(1000, nowhere, 0), measured(0.001, nowhere, 0), measured(1, nowhere, 4e-16),
                              measured(1, nowhere, 1e-16), measured(3, Vector(5, -7, 3), 0)}) {
        ASSERT_EQ(other.size(), as_it_is.size());
        for (std::size_t i = 0; i < other.size(); ++i) EXPECT_NEAR(other[i] / as_it_is[i], 1, 1e-6) << i;
    }
}
