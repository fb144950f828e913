// Free annotations on other meshes.
#include "ostraka/transfer/project_curves.h"
#include "meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/annotation/fair_outlines.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/synthetic/make_mesh.h"
#include "ostraka/transfer/bound_mesh.h"
#include "ostraka/transfer/transfer.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace ostraka;
using namespace ostraka::test;

namespace {

Mesh object_mesh(const std::string& object, std::size_t vertices, std::uint64_t seed) {
    MakeOptions options;
    options.vertices = vertices;
    options.seed = seed;
    return make_mesh(synthetic_object(object), options).mesh;
}

/// The mesh partitioned along a direction into `count` slabs with fair outlines.
AnnotationSet slabs(const Mesh& mesh, const Vector& direction, int count) {
    double low = 1e300, high = -1e300;
    for (const Vertex v : mesh.vertices()) {
        const double height = (mesh.point(v) - CGAL::ORIGIN) * direction;
        low = std::min(low, height), high = std::max(high, height);
    }
    AnnotationSet set;
    set.annotations.resize(static_cast<std::size_t>(count));
    for (const Face f : mesh.faces()) {
        const double share = ((centroid(mesh, f) - CGAL::ORIGIN) * direction - low) / (high - low);
        set.annotations[static_cast<std::size_t>(std::clamp(static_cast<int>(count * share), 0, count - 1))].faces.push_back(f);
    }
    for (int i = 0; i < count; ++i) {
        set.annotations[static_cast<std::size_t>(i)].id = i;
        set.annotations[static_cast<std::size_t>(i)].tag = "slab " + std::to_string(i);
    }
    fair_outlines(mesh, set, {});
    return set;
}

double area_sum(AnnotatedMeshView object) {
    double sum = 0;
    for (const Annotation& annotation : object.annotations.annotations) sum += area_of(object.mesh, annotation);
    return sum;
}

/// Each face is assigned to the nearest of some points, spread over the mesh by a fixed rule: a partition with junctions.
AnnotationSet cells(const Mesh& mesh, std::size_t count) {
    AnnotationSet set;
    set.annotations.resize(count);
    std::vector<Point> seeds;
    for (std::size_t k = 0; k < count; ++k) {
        set.annotations[k].id = static_cast<int>(k);
        set.annotations[k].tag = "cell " + std::to_string(k);
        seeds.push_back(mesh.point(Vertex(static_cast<Index>((7919 * (k + 1)) % mesh.number_of_vertices()))));
    }
    for (const Face f : mesh.faces()) {
        const Point at = centroid(mesh, f);
        std::size_t best = 0;
        for (std::size_t k = 1; k < count; ++k)
            if (CGAL::squared_distance(at, seeds[k]) < CGAL::squared_distance(at, seeds[best])) best = k;
        set.annotations[best].faces.push_back(f);
    }
    return set;
}

}  // namespace

TEST(ProjectCurves, ThereAndBackIsTheSameCurve) {
    const Mesh coarse = object_mesh("teapot", 2500, 1), fine = object_mesh("teapot", 20000, 2);
    const AnnotationSet set = slabs(coarse, Vector(0.3, 0.2, 0.93), 4);
    const SurfaceSearch on_fine(fine), on_coarse(coarse);
    const TransferResult forward = transfer({coarse, set}, on_fine);
    const TransferResult back = transfer({fine, forward.annotations}, on_coarse);
    check_annotations({fine, forward.annotations}, "there");
    for (const Annotation& annotation : set.annotations) {
        ASSERT_TRUE(is_free(annotation));
        const Annotation *moved = forward.annotations.find(annotation.id), *again = back.annotations.find(annotation.id);
        ASSERT_TRUE(moved != nullptr && again != nullptr && is_free(*moved) && is_free(*again));
        const RegionMeasures a = measure_region(coarse, annotation), b = measure_region(coarse, *again);
        EXPECT_NEAR(b.area / a.area, 1, 2e-4) << annotation.tag;
        EXPECT_NEAR(b.perimeter / a.perimeter, 1, 1e-3) << annotation.tag;
    }
    for (const TransferResult* result : {&forward, &back})
        for (const TransferScore& score : result->scores) {
            EXPECT_EQ(score.outcome, TransferOutcome::kept);
            ASSERT_TRUE(score.overlap);
            EXPECT_GT(*score.overlap, 0.99) << score.tag;
        }
}

TEST(ProjectCurves, APartitionStaysAPartition) {
    const Mesh coarse = object_mesh("statuette", 3000, 1), fine = object_mesh("statuette", 12000, 5);
    const AnnotationSet set = slabs(fine, Vector(0.6, 0.64, 0.48), 5);
    ASSERT_NEAR(area_sum({fine, set}) / surface_area(fine), 1, 1e-9);
    const SurfaceSearch on_coarse(coarse);
    const TransferResult transferred = transfer({fine, set}, on_coarse);
    EXPECT_NEAR(area_sum({coarse, transferred.annotations}) / surface_area(coarse), 1, 1e-6);
    // On the cut mesh every piece of significant size is in exactly one region.
    const CutMesh cut = cut_along_curves({coarse, transferred.annotations});
    std::vector<int> holders(cut.mesh.number_of_faces(), 0);
    for (const Annotation& annotation : cut.annotations.annotations)
        for (const Index f : annotation.faces) ++holders[f];
    double wrong = 0;
    for (const Face f : cut.mesh.faces())
        if (holders[f] != 1) wrong += face_area(cut.mesh, f);
    EXPECT_LT(wrong / surface_area(coarse), 1e-6);
}

TEST(ProjectCurves, OutlinesAlongEdgesBecomeFreeIfRequested) {
    const Mesh coarse = object_mesh("teapot", 1500, 1), fine = object_mesh("teapot", 6000, 2);
    AnnotationSet set;
    set.annotations.resize(1);
    set.annotations[0].tag = "top";
    for (const Face f : coarse.faces())
        if (centroid(coarse, f).z() > 30) set.annotations[0].faces.push_back(f);
    const SurfaceSearch on_fine(fine);
    TransferOptions options;
    set.annotations[0].information = {{Information::Kind::text, "cracked", "", ""}};
    const TransferResult along_edges = transfer({coarse, set}, on_fine, options);
    EXPECT_FALSE(is_free(along_edges.annotations.annotations.at(0)));
    options.outlines = TransferOptions::Outlines::free;
    const TransferResult free = transfer({coarse, set}, on_fine, options);
    EXPECT_TRUE(is_free(free.annotations.annotations.at(0)));
    for (const TransferResult* result : {&along_edges, &free})
        EXPECT_EQ(result->annotations.annotations[0].information, set.annotations[0].information);
    EXPECT_NEAR(free.scores.at(0).target_length / free.scores.at(0).source_length, 1, 0.03);
    options.outlines = TransferOptions::Outlines::edges;
    EXPECT_FALSE(is_free(transfer({fine, free.annotations}, on_fine, options).annotations.annotations.at(0)));
}

TEST(ProjectCurves, LabelsOfAPartitionBecomeFree) {
    const Mesh fine = object_mesh("teapot", 6000, 1), coarse = object_mesh("teapot", 1500, 7);
    AnnotationSet set = cells(fine, 6);
    const SurfaceSearch on_coarse(coarse);
    TransferOptions options;
    options.overlap = false;
    const auto worst_perimeter = [&] {
        const TransferResult moved = transfer({fine, set}, on_coarse, options);
        double worst = 0;
        for (std::size_t i = 0; i < set.annotations.size(); ++i) {
            const double before = measure_region(fine, set.annotations[i]).perimeter;
            worst = std::max(worst, std::abs(measure_region(coarse, moved.annotations.annotations.at(i)).perimeter / before - 1));
        }
        return worst;
    };
    for (const Annotation& annotation : transfer({fine, set}, on_coarse, options).annotations.annotations)
        EXPECT_TRUE(is_free(annotation));
    const double free = worst_perimeter();
    EXPECT_LT(free, 0.03);  // of the two meshes, which share no vertex
    // Other regions stay along edges: if requested, and if they leave a gap.
    options.outlines = TransferOptions::Outlines::kept;
    for (const Annotation& annotation : transfer({fine, set}, on_coarse, options).annotations.annotations)
        EXPECT_FALSE(is_free(annotation));
    EXPECT_GT(worst_perimeter(), 5 * free);
    options.outlines = TransferOptions::Outlines::partitions;
    options.cover = TransferOptions::Cover::enclosing;
    for (const Annotation& annotation : transfer({fine, set}, on_coarse, options).annotations.annotations)
        EXPECT_FALSE(is_free(annotation));
    options.cover = TransferOptions::Cover::overlapping;
    set.annotations.pop_back();
    for (const Annotation& annotation : transfer({fine, set}, on_coarse, options).annotations.annotations)
        EXPECT_FALSE(is_free(annotation));
}

TEST(ProjectCurves, FollowsSimplificationAndRefinement) {
    const Mesh mesh = object_mesh("teapot", 6000, 1);
    const AnnotationSet set = slabs(mesh, Vector(0.3, 0.2, 0.93), 3);
    MeshFile file;
    file.mesh = mesh;
    BoundMesh bound(std::move(file), set);
    RefineOptions refining;
    refining.levels = 1;
    bound.refine(refining);
    // Splitting faces into four changes neither the surface nor the curves.
    for (const Annotation& annotation : bound.annotations->annotations) {
        const RegionMeasures before = measure_region(mesh, *set.find(annotation.id)),
                             after = measure_region(bound.mesh, annotation);
        EXPECT_NEAR(after.area / before.area, 1, 1e-6);
        EXPECT_NEAR(after.perimeter / before.perimeter, 1, 1e-4);
    }
    SimplifyOptions simplifying;
    simplifying.vertices = 3000;
    bound.simplify(simplifying);
    check_annotations({bound.mesh, *bound.annotations}, "simplified");
    EXPECT_NEAR(area_sum({bound.mesh, *bound.annotations}) / surface_area(bound.mesh), 1, 1e-6);
    for (const Annotation& annotation : bound.annotations->annotations) {
        const RegionMeasures before = measure_region(mesh, *set.find(annotation.id)),
                             after = measure_region(bound.mesh, annotation);
        EXPECT_NEAR(after.perimeter / before.perimeter, 1, 0.02);
    }
}

TEST(ProjectCurves, SameToTheBitForAnyNumberOfThreads) {
    const Mesh coarse = object_mesh("statuette", 2000, 1), fine = object_mesh("statuette", 8000, 5);
    const AnnotationSet set = slabs(coarse, Vector(0, 0.6, 0.8), 3);
    const SurfaceSearch search(fine);
    const int before = threads();
    std::vector<std::vector<std::vector<SurfacePoint>>> curves;
    for (const int count : {1, 2, 3}) {
        set_threads(count);
        const TransferResult transferred = transfer({coarse, set}, search);
        curves.emplace_back();
        for (const Annotation& annotation : transferred.annotations.annotations)
            for (const auto& curve : annotation.curves) curves.back().push_back(curve);
    }
    set_threads(before);
    EXPECT_EQ(curves[0], curves[1]);
    EXPECT_EQ(curves[0], curves[2]);
}

namespace {

/// A plane of 10 by 10 units, or a surface on it with overhanging waves: below their crests a line along the normal of the plane
/// intersects it more than once.
Mesh waves(Index n, double over, double height) {
    TriangleSoup soup;
    for (Index i = 0; i <= n; ++i)
        for (Index j = 0; j <= n; ++j) {
            const double u = 10.0 * i / n, v = 10.0 * j / n, turn = 2 * CGAL_PI * u;
            soup.points.push_back({u + over * std::sin(turn), v, height * std::cos(turn)});
        }
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) {
            const Index a = i * (n + 1) + j, b = a + n + 1;
            soup.triangles.push_back({a, b, b + 1});
            soup.triangles.push_back({a, b + 1, a + 1});
        }
    return build_mesh(soup);
}

/// A free region around a circle on the plane.
Annotation disc_on(const Mesh& mesh, double x, double y, double radius) {
    const SurfaceSearch search(mesh);
    const auto node = [&](int k) {
        const double angle = 2 * CGAL_PI * k / 60;
        const SurfaceHit hit = search.closest(Point(x + radius * std::cos(angle), y + radius * std::sin(angle), 0));
        return surface_point(mesh, hit.face, hit.barycentric);
    };
    Annotation disc;
    disc.tag = "disc";
    auto& places = disc.curves.emplace_back(1, stored_point(mesh, node(0)));
    for (int k = 0; k < 60; ++k) {
        const auto line = trace_line(mesh, node(k), node((k + 1) % 60), Vector(0, 0, 1), 10);
        if (line)
            for (std::size_t i = 1; i < line->points.size(); ++i) places.push_back(stored_point(mesh, line->points[i]));
    }
    compute_elements(mesh, disc);
    return disc;
}

Mesh moved_and_scaled(const Mesh& mesh, double scale, const Vector& by, double noise) {
    Mesh result = mesh;
    double sense = 1;
    for (const Vertex v : result.vertices()) {
        const Point& p = mesh.point(v);
        const auto off = [&](double x) { return x * scale * (1 + (sense = -sense) * noise); };
        result.point(v) = Point(off(p.x()), off(p.y()), off(p.z())) + by;
    }
    return result;
}

}  // namespace

TEST(ProjectCurves, FoldsLeaveNoSpikesOnTheWayBack) {
    const Mesh coarse = waves(20, 0, 0), fine = waves(200, 0.25, 0.12);
    AnnotationSet set;
    set.annotations.push_back(disc_on(coarse, 5.03, 4.91, 2.37));
    const RegionMeasures before = measure_region(coarse, set.annotations[0]);
    ASSERT_NEAR(before.area / (CGAL_PI * 2.37 * 2.37), 1, 3e-3);
    const SurfaceSearch on_fine(fine), on_coarse(coarse);
    TransferOptions options;
    options.force = true;
    const TransferResult forward = transfer({coarse, set}, on_fine, options);
    const TransferResult back = transfer({fine, forward.annotations}, on_coarse, options);
    ASSERT_EQ(back.annotations.annotations.size(), 1U);
    const Annotation& again = back.annotations.annotations[0];
    EXPECT_EQ(again.curves.size(), 1U);
    const RegionMeasures after = measure_region(coarse, again);
    EXPECT_NEAR(after.perimeter / before.perimeter, 1, 1e-3);
    EXPECT_NEAR(after.area / before.area, 1, 2e-4);
}

TEST(ProjectCurves, APartitionWithJunctionsStaysAPartitionOnACoarserMesh) {
    for (const char* object : {"teapot", "statuette"}) {
        const Mesh fine = object_mesh(object, 6000, 1), coarse = object_mesh(object, 1500, 7);
        const AnnotationSet set = cells(fine, 12);
        TransferOptions options;
        options.outlines = TransferOptions::Outlines::free;
        options.overlap = false;
        const SurfaceSearch on_coarse(coarse);
        const TransferResult transferred = transfer({fine, set}, on_coarse, options);
        check_annotations({coarse, transferred.annotations}, "there");
        EXPECT_NEAR(area_sum({coarse, transferred.annotations}) / surface_area(coarse), 1, 1e-9) << object;
        const CutMesh cut = cut_along_curves({coarse, transferred.annotations});
        std::vector<int> holders(cut.mesh.number_of_faces(), 0);
        for (const Annotation& annotation : cut.annotations.annotations)
            for (const Index f : annotation.faces) ++holders[f];
        double wrong = 0;
        for (const Face f : cut.mesh.faces())
            if (holders[f] != 1) wrong += face_area(cut.mesh, f);
        EXPECT_LT(wrong / surface_area(coarse), 1e-9) << object;
    }
}

TEST(ProjectCurves, UnitPositionAndRoundingChangeNothing) {
    const Mesh coarse = object_mesh("statuette", 1500, 1), fine = object_mesh("statuette", 6000, 5);
    const AnnotationSet set = slabs(coarse, Vector(0.3, 0.2, 0.93), 3);
    const auto measured = [&](double scale, const Vector& by, double noise) {
        const Mesh from = moved_and_scaled(coarse, scale, by, noise), to = moved_and_scaled(fine, scale, by, noise);
        const SurfaceSearch on_to(to), on_from(from);
        const TransferResult forward = transfer({from, set}, on_to), back = transfer({to, forward.annotations}, on_from);
        std::vector<double> values;
        for (const auto& [mesh, result] : {std::pair(&to, &forward), std::pair(&from, &back)})
            for (const Annotation& annotation : result->annotations.annotations) {
                const RegionMeasures measures = measure_region(*mesh, annotation);
                values.push_back(measures.perimeter / scale);
                values.push_back(measures.area / (scale * scale));
            }
        return values;
    };
    const std::vector<double> as_it_is = measured(1, Vector(0, 0, 0), 0);
    for (const auto& other : {measured(1000, Vector(0, 0, 0), 0), measured(0.001, Vector(0, 0, 0), 0),
                              measured(1, Vector(0, 0, 0), 1e-16), measured(1, Vector(50, -70, 30), 0)}) {
        ASSERT_EQ(other.size(), as_it_is.size());
        for (std::size_t i = 0; i < other.size(); ++i) EXPECT_NEAR(other[i] / as_it_is[i], 1, 1e-6) << i;
    }
}

TEST(ProjectCurves, AnotherNumberOfOutlinesIsReported) {
    // One of two discs lies on a component that the target does not have.
    const Mesh whole = waves(20, 0, 0);
    TriangleSoup half = to_soup(whole);
    std::erase_if(half.triangles, [&](const auto& t) { return half.points[t[0]][0] > 5.4; });
    const Mesh target = build_mesh(half);
    AnnotationSet set;
    Annotation both = disc_on(whole, 2.53, 4.91, 1.37);
    both.curves.push_back(disc_on(whole, 8.03, 4.91, 1.12).curves.front());
    compute_elements(whole, both);
    set.annotations.push_back(both);
    const SurfaceSearch search(target);
    TransferOptions options;
    options.force = true;
    const TransferResult transferred = transfer({whole, set}, search, options);
    ASSERT_EQ(transferred.annotations.annotations.size(), 1U);
    EXPECT_EQ(transferred.annotations.annotations[0].curves.size(), 1U);
    EXPECT_EQ(transferred.scores.at(0).note, "2 outlines became 1");
}
