#include "ostraka/transfer/transfer.h"
#include "ostraka/transfer/survival.h"

#include "meshes.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <gtest/gtest.h>

#include <set>

using namespace ostraka;
using ostraka::test::box;
using ostraka::test::joined;
using ostraka::test::moved;
using ostraka::test::octahedron_sphere;
using ostraka::test::patch;
using ostraka::test::torus;

namespace {

template <class Inside>
Annotation region(int id, const Mesh& mesh, Inside&& inside) {
    Annotation annotation;
    annotation.id = id;
    annotation.tag = "region " + std::to_string(id);
    for (const Face f : mesh.faces())
        if (inside(centroid(mesh, f))) annotation.faces.push_back(f);
    return annotation;
}

AnnotationSet set_of(std::vector<Annotation> annotations) {
    AnnotationSet set;
    set.annotations = std::move(annotations);
    return set;
}

const auto cap = [](const Point& p) { return p.z() > 0.6; };
const auto band = [](const Point& p) { return std::abs(p.x()) < 0.3; };

TransferResult transfer_to(AnnotatedMeshView source, const Mesh& target, const TransferOptions& options = {}) {
    const SurfaceSearch search(target);
    return transfer(source, search, options);
}

TriangleSoup rotated(TriangleSoup soup, double angle) {
    for (auto& p : soup.points)
        p = {std::cos(angle) * p[0] - std::sin(angle) * p[1], std::sin(angle) * p[0] + std::cos(angle) * p[1], p[2]};
    return soup;
}

}  // namespace

TEST(Transfer, OntoItselfIsTheIdentity) {
    for (const auto& [name, soup] : test::group()) {
        const Mesh mesh = build_mesh(soup);
        const CGAL::Bbox_3 bounds = bounding_box(mesh);
        const double middle = (bounds.xmin() + bounds.xmax()) / 2 + 0.013 * (bounds.xmax() - bounds.xmin());
        Annotation line;
        line.id = 2;
        line.type = AnnotationType::line;
        const Halfedge h = *mesh.halfedges().begin();
        line.polylines = {{mesh.source(h), mesh.target(h), mesh.target(mesh.next(h))}};
        Annotation points;
        points.id = 3;
        points.type = AnnotationType::point;
        points.points = {0, 7, 3};
        const AnnotationSet set = set_of({region(1, mesh, [&](const Point& p) { return p.x() < middle; }), line, points});
        for (const char* metric : {"euclidean", "segment", "combined"}) {
            TransferOptions options;
            set_option(options, "metric", metric);
            const TransferResult result = transfer_to({mesh, set}, mesh, options);
            ASSERT_EQ(result.annotations.annotations.size(), 3U) << name;
            EXPECT_EQ(result.annotations.annotations[0].faces, set.annotations[0].faces) << name << " " << metric;
            EXPECT_EQ(result.annotations.annotations[1].polylines, line.polylines) << name;
            EXPECT_EQ(result.annotations.annotations[2].points, points.points) << name;
            EXPECT_NEAR(*result.scores[0].overlap, 1, 1e-9) << name;
            EXPECT_NEAR(result.scores[0].hausdorff.value_or(-1), 0, 1e-9 * box_diagonal(mesh)) << name;
        }
    }
}

TEST(Transfer, RegionsKeepTheirAreaAcrossResolutions) {
    const Mesh coarse = build_mesh(octahedron_sphere(4)), fine = build_mesh(rotated(octahedron_sphere(5), 0.3));
    for (const auto& [source, target] : {std::pair{&coarse, &fine}, std::pair{&fine, &coarse}}) {
        const AnnotationSet set = set_of({region(1, *source, cap), region(2, *source, band)});
        const double edge = std::max(mean_edge_length(*source), mean_edge_length(*target));
        for (const char* metric : {"euclidean", "segment", "combined"})
            for (const char* spikes : {"prune", "avoid", "keep"}) {
                TransferOptions options;
                set_option(options, "metric", metric);
                set_option(options, "spikes", spikes);
                const TransferResult result = transfer_to({*source, set}, *target, options);
                for (const TransferScore& score : result.scores) {
                    EXPECT_EQ(score.outcome, TransferOutcome::kept);
                    EXPECT_FALSE(score.voted);
                    EXPECT_LT(*score.wrong_side, 0.5 * edge * score.source_length) << metric << " " << spikes;
                    EXPECT_LT(score.hausdorff.value_or(1e9), 2 * edge);
                    EXPECT_GT(*score.overlap, 0.9);
                }
            }
    }
}

TEST(Transfer, RefinedTargetHoldsTheOutlineExactly) {
    const Mesh source = build_mesh(octahedron_sphere(4));
    for (const int level : {3, 5}) {
        const Mesh target = build_mesh(rotated(octahedron_sphere(level), 0.3));
        const AnnotationSet set = set_of({region(1, source, cap), region(2, source, band)});
        TransferOptions options;
        options.refine = true;
        const TransferResult result = transfer_to({source, set}, target, options);
        ASSERT_TRUE(result.refined);
        const Mesh& refined = result.refined->mesh;
        EXPECT_TRUE(refined.is_valid(false));
        EXPECT_NEAR(surface_area(refined), surface_area(target), 1e-9);
        for (Index v = 0; v < target.number_of_vertices(); ++v) EXPECT_EQ(refined.point(Vertex(v)), target.point(Vertex(v)));
        for (const TransferScore& score : result.scores) {
            // The surfaces differ by h^2 / 8 from the sphere, and lengths and areas accordingly.
            const double h = std::max(mean_edge_length(source), mean_edge_length(target));
            EXPECT_NEAR(score.target_length / score.source_length, 1, h * h / 2) << level;
            EXPECT_NEAR(score.target_area / score.source_area, 1, h * h) << level;
            EXPECT_GT(*score.overlap, 1 - h * h) << level;
        }
    }
}

TEST(Transfer, EnclosingContainsTheFacesThatEnclosedOmits) {
    const Mesh source = build_mesh(octahedron_sphere(5)), target = build_mesh(rotated(octahedron_sphere(4), 0.4));
    const AnnotationSet set = set_of({region(1, source, cap)});
    TransferOptions options;
    options.cover = TransferOptions::Cover::enclosing;
    const auto outer = transfer_to({source, set}, target, options).annotations.annotations.at(0).faces;
    options.cover = TransferOptions::Cover::enclosed;
    const auto inner = transfer_to({source, set}, target, options).annotations.annotations.at(0).faces;
    EXPECT_TRUE(std::includes(outer.begin(), outer.end(), inner.begin(), inner.end()));
    // The true border of the source region lies where its faces end; allow for the height of a source face.
    const double slack = 1.5 * mean_edge_length(source);
    for (const Index f : inner)
        for (const Vertex v : corners(target, Face(f))) EXPECT_GT(target.point(v).z(), 0.6 - slack);
    std::set<Index> enclosing(outer.begin(), outer.end());
    for (const Face f : target.faces()) {
        double top = -1;
        for (const Vertex v : corners(target, f)) top = std::max(top, target.point(v).z());
        if (top > 0.6 + slack) {
            EXPECT_EQ(enclosing.count(f), 1U);
        }
    }
}

TEST(Transfer, SmallRegionsBecomeAPointOrALineWithANote) {
    const Mesh source = build_mesh(octahedron_sphere(5)), target = build_mesh(octahedron_sphere(1));
    Annotation dot = region(1, source, [](const Point& p) { return p.z() > 0.995; });
    dot.tag = "dot";
    Annotation strip = region(2, source, [](const Point& p) { return std::abs(p.y() - 0.02) < 0.03 && p.x() > 0 && p.z() > 0; });
    const TransferResult result = transfer_to({source, set_of({dot, strip})}, target);
    ASSERT_EQ(result.annotations.annotations.size(), 2U);
    EXPECT_EQ(result.annotations.annotations[0].type, AnnotationType::point);
    EXPECT_EQ(result.annotations.annotations[0].tag, "dot");
    EXPECT_FALSE(result.annotations.annotations[0].note.empty());
    EXPECT_EQ(result.annotations.annotations[1].type, AnnotationType::line);
    EXPECT_EQ(result.scores[1].outcome, TransferOutcome::became_line);
}

TEST(Transfer, ShortLinesBecomePointsAndLostPinsLeaveAStaleValue) {
    const Mesh source = build_mesh(octahedron_sphere(5)), target = build_mesh(octahedron_sphere(2));
    Annotation line;
    line.id = 4;
    line.type = AnnotationType::line;
    const Halfedge h = source.halfedge(Vertex(4));  // at a pole, which both meshes have
    line.polylines = {{source.source(h), source.target(h)}};
    const TransferResult result = transfer_to({source, set_of({line})}, target);
    ASSERT_EQ(result.annotations.annotations.size(), 1U);
    EXPECT_EQ(result.annotations.annotations[0].type, AnnotationType::point);
    EXPECT_EQ(result.scores[0].outcome, TransferOutcome::became_point);

    // A pin on a part that the target does not have.
    const Mesh two_balls = build_mesh(joined(octahedron_sphere(3), moved(octahedron_sphere(2), 1, {5, 0, 0}))),
               single_ball = build_mesh(octahedron_sphere(3));
    Annotation cap_region = region(1, two_balls, [](const Point& p) { return p.z() > 0.6 && p.x() < 2; });
    Attribute ruler;
    ruler.name = "width";
    ruler.value = Measure();
    ruler.measure()->tool = "ruler";
    ruler.measure()->points = {static_cast<Index>(two_balls.number_of_vertices() - 1), 4};
    ruler.measure()->value = 1.5;
    ruler.measure()->unit = "mm";
    cap_region.attributes = {ruler};
    TransferOptions force;
    force.force = true;
    const auto carried = transfer_to({two_balls, set_of({cap_region})}, single_ball, force).annotations.annotations;
    ASSERT_EQ(carried.size(), 1U);
    ASSERT_EQ(carried[0].attributes.size(), 1U);
    EXPECT_NE(carried[0].attributes[0].descriptor(), nullptr);
    EXPECT_TRUE(carried[0].attributes[0].descriptor()->stale);
    EXPECT_EQ(carried[0].attributes[0].descriptor()->values, std::vector<double>{1.5});
}

TEST(Transfer, RegionWhoseSmallHoleVanishesCoversItsComponent) {
    const Mesh source = build_mesh(octahedron_sphere(5)), target = build_mesh(octahedron_sphere(2));
    const AnnotationSet set = set_of({region(1, source, [](const Point& p) { return p.z() < 0.998; })});
    const TransferResult result = transfer_to({source, set}, target);
    EXPECT_EQ(result.scores[0].outcome, TransferOutcome::kept);
    EXPECT_EQ(result.annotations.annotations.at(0).faces.size(), target.number_of_faces());
    EXPECT_FALSE(result.scores[0].hausdorff);
}

TEST(Transfer, SeveralOutlinesAndPatches) {
    const Mesh source = build_mesh(torus(60, 30)), target = build_mesh(torus(90, 50));
    const AnnotationSet set = set_of(
        {region(1, source, [](const Point& p) { return std::abs(p.x()) > 1.5; }),  // two patches
         region(2, source, [](const Point& p) { return p.x() > 0 && !(p.y() > -0.6 && p.y() < 0.6 && p.z() > 0.3); }),  // a hole
         region(3, source, [](const Point& p) { return p.z() > 0; })});  // an annulus around the axis
    const TransferResult result = transfer_to({source, set}, target);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& faces = result.annotations.annotations[i].faces;
        EXPECT_EQ(extract_outlines(target, faces).size(), extract_outlines(source, set.annotations[i].faces).size()) << i;
        EXPECT_GT(*result.scores[i].overlap, 0.93) << i;
        EXPECT_FALSE(result.scores[i].voted);
    }
}

TEST(Transfer, WholeComponentsAndTheWholeMesh) {
    const auto pair = [](int a, int b) {
        return build_mesh(joined(octahedron_sphere(a), moved(octahedron_sphere(b), 1, {3, 0, 0})));
    };
    const Mesh source = pair(3, 3), target = pair(4, 2);
    Annotation all = region(0, source, [](const Point&) { return true; });
    all.all = true;
    const TransferResult result =
        transfer_to({source, set_of({all, region(1, source, [](const Point& p) { return p.x() > 1.5; })})}, target);
    EXPECT_EQ(result.annotations.annotations[0].faces.size(), target.number_of_faces());
    for (const Face f : target.faces()) {
        const auto& faces = result.annotations.annotations[1].faces;
        EXPECT_EQ(std::binary_search(faces.begin(), faces.end(), static_cast<Index>(f)), centroid(target, f).x() > 1.5);
    }
}

TEST(Transfer, BorderOfAnOpenMeshBoundsTheRegion) {
    const Mesh source = build_mesh(patch(20, 20)), target = build_mesh(patch(33, 29));
    const AnnotationSet set = set_of(
        {region(1, source, [](const Point& p) { return p.x() < 0.5; }), region(2, source, [](const Point&) { return true; })});
    const TransferResult result = transfer_to({source, set}, target);
    EXPECT_EQ(result.annotations.annotations[1].faces.size(), target.number_of_faces());
    EXPECT_NEAR(result.scores[0].target_area / result.scores[0].source_area, 1, 0.02);
    EXPECT_GT(*result.scores[0].overlap, 0.95);
}

TEST(Transfer, ThinWallDoesNotAttractTheOutlineOfTheOtherSide) {
    // Two sheets, a tenth of an edge apart, facing away from each other, joined at the rim: a flat box.
    const auto flat = [](int n) {
        TriangleSoup soup = box(n);
        for (auto& p : soup.points) p[2] *= 0.01;
        return build_mesh(soup);
    };
    const Mesh source = flat(16), target = flat(23);
    const AnnotationSet set =
        set_of({region(1, source, [](const Point& p) { return p.z() > 0.0099 && std::hypot(p.x() - 0.5, p.y() - 0.5) < 0.3; })});
    for (const bool refine : {false, true}) {
        TransferOptions options;
        options.refine = refine;
        const TransferResult result = transfer_to({source, set}, target, options);
        const Mesh& mesh = refine ? result.refined->mesh : target;
        for (const Index f : result.annotations.annotations.at(0).faces) EXPECT_GT(centroid(mesh, Face(f)).z(), 0.0099);
        EXPECT_GT(*result.scores[0].overlap, refine ? 0.999 : 0.85);
    }
}

TEST(Transfer, SharedBorderStaysShared) {
    const Mesh source = build_mesh(octahedron_sphere(4)), target = build_mesh(rotated(octahedron_sphere(5), 0.3));
    const auto left = [](const Point& p) { return p.x() + 0.2 * p.y() < 0.1; };
    const AnnotationSet set = set_of({region(1, source, left), region(2, source, [&](const Point& p) { return !left(p); })});
    const TransferResult result = transfer_to({source, set}, target);
    std::vector<int> owners(target.number_of_faces(), 0);
    for (const Annotation& annotation : result.annotations.annotations)
        for (const Index f : annotation.faces) ++owners[f];
    for (const int count : owners) EXPECT_EQ(count, 1);
}

TEST(Transfer, SameForAnyNumberOfThreadsAndScale) {
    const auto at = [](int level, double scale, const std::array<double, 3>& by) {
        return build_mesh(moved(rotated(octahedron_sphere(level), 0.2 * level), scale, by));
    };
    const Mesh source = at(4, 1, {0, 0, 0}), target = at(5, 1, {0, 0, 0});
    const AnnotationSet set = set_of({region(1, source, cap)});
    set_threads(1);
    const TransferResult single_threaded = transfer_to({source, set}, target);
    set_threads(2);
    const TransferResult two_threaded = transfer_to({source, set}, target);
    set_threads(0);
    EXPECT_EQ(single_threaded.annotations.annotations[0].faces, two_threaded.annotations.annotations[0].faces);
    EXPECT_EQ(*single_threaded.scores[0].overlap, *two_threaded.scores[0].overlap);
    for (const double scale : {1e-9, 1e9}) {
        const TransferResult scaled = transfer_to({at(4, scale, {0, 0, 0}), set}, at(5, scale, {0, 0, 0}));
        EXPECT_EQ(scaled.annotations.annotations[0].faces.size(), single_threaded.annotations.annotations[0].faces.size())
            << scale;
        EXPECT_NEAR(*scaled.scores[0].overlap, *single_threaded.scores[0].overlap, 1e-3);
    }
    const TransferResult far = transfer_to({at(4, 1, {1e6, 0, 0}), set}, at(5, 1, {1e6, 0, 0}));
    EXPECT_NEAR(*far.scores[0].overlap, *single_threaded.scores[0].overlap, 1e-3);
}

TEST(Transfer, RoundingPutsLessOnTheWrongSideAndMeetsAreaAndPerimeter) {
    const Mesh source = build_mesh(octahedron_sphere(5)), target = build_mesh(rotated(octahedron_sphere(6), 0.3));
    const AnnotationSet set = set_of({region(1, source, cap), region(2, source, band)});
    const auto scores = [&](const char* rounding) {
        TransferOptions options;
        set_option(options, "rounding", rounding);
        return transfer_to({source, set}, target, options).scores;
    };
    const auto path = scores("path"), area = scores("area"), balanced = scores("balanced");
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_LT(*area[i].wrong_side, *path[i].wrong_side);
        EXPECT_LE(*balanced[i].wrong_side, *path[i].wrong_side);
        EXPECT_LT(distortions(balanced[i]).area + distortions(balanced[i]).perimeter,
                  distortions(path[i]).area + distortions(path[i]).perimeter);
        EXPECT_LT(distortions(balanced[i]).area, 1e-3);
    }
}

TEST(Transfer, RoundingKeepsThePartitionOfThreeRegions) {
    const Mesh source = build_mesh(octahedron_sphere(4)), target = build_mesh(rotated(octahedron_sphere(5), 0.3));
    const auto third = [](int k) {
        return [k](const Point& p) {
            return static_cast<int>(std::floor((std::atan2(p.y(), p.x()) + M_PI) / (2 * M_PI) * 2.9999)) == k;
        };
    };
    const AnnotationSet set = set_of({region(1, source, third(0)), region(2, source, third(1)), region(3, source, third(2))});
    for (const char* rounding : {"path", "area", "balanced"}) {
        TransferOptions options;
        set_option(options, "rounding", rounding);
        options.outlines = TransferOptions::Outlines::kept;
        std::vector<int> owners(target.number_of_faces(), 0);
        for (const Annotation& annotation : transfer_to({source, set}, target, options).annotations.annotations)
            for (const Index f : annotation.faces) ++owners[f];
        for (const int count : owners) EXPECT_EQ(count, 1) << rounding;
    }
}

TEST(Transfer, MeasuresMoveWithTheirPinsAndAreRecomputed) {
    const Mesh source = build_mesh(octahedron_sphere(4)), target = build_mesh(rotated(octahedron_sphere(5), 0.3));
    Annotation top = region(1, source, cap);
    Attribute ruler;
    ruler.name = "axis";
    ruler.value = Measure();
    ruler.measure()->tool = "ruler";
    ruler.measure()->points = {4, 5};  // the poles
    ruler.measure()->value = 99.0;
    ruler.measure()->unit = "mm";
    Attribute area;
    area.id = 1;
    area.name = "area";
    area.value = Descriptor();
    area.descriptor()->values = {99.0};
    top.attributes = {ruler, area};
    const Annotation moved = transfer_to({source, set_of({top})}, target).annotations.annotations.at(0);
    ASSERT_EQ(moved.attributes.size(), 2U);
    EXPECT_FALSE(moved.attributes[0].measure()->stale);
    EXPECT_NEAR(moved.attributes[0].measure()->value.value(), 2, 1e-9);
    EXPECT_EQ(moved.attributes[0].measure()->locations.size(), 2U);
    EXPECT_NEAR(moved.attributes[1].descriptor()->values.at(0), measure_region(target, moved.faces).area, 1e-12);
}

TEST(Survival, SmallerRegionsNeedMoreVertices) {
    const Mesh mesh = build_mesh(octahedron_sphere(5));
    const AnnotationSet set = set_of({region(1, mesh, [](const Point& p) { return p.z() > 0; }),
                                      region(2, mesh, [](const Point& p) { return p.z() > 0.8; }),
                                      region(3, mesh, [](const Point& p) { return p.z() > 0.99; })});
    const auto survivals = smallest_resolutions({mesh, set});
    ASSERT_EQ(survivals.size(), 3U);
    EXPECT_LE(survivals[0].vertices, survivals[1].vertices);
    EXPECT_LT(survivals[1].vertices, survivals[2].vertices);
    EXPECT_FALSE(survivals[2].end.empty());
}

TEST(Transfer, OtherUnitsAndPositionsAreRefusedWithTheirSize) {
    const Mesh source = build_mesh(torus(40, 20));
    const auto refusal = [&](const TriangleSoup& soup) {
        try {
            transfer_to({source, set_of({})}, build_mesh(soup));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(refusal(moved(torus(40, 20), 1000, {0, 0, 0})).find("1000 times"), std::string::npos);
    EXPECT_NE(refusal(moved(torus(40, 20), 1000, {0, 0, 0})).find("metres and millimetres"), std::string::npos);
    EXPECT_NE(refusal(moved(torus(40, 20), 1, {1, 0, 0})).find("not aligned"), std::string::npos);
    TriangleSoup turned = torus(40, 20);
    for (auto& p : turned.points) p = {p[0], 0.8 * p[1] - 0.6 * p[2], 0.6 * p[1] + 0.8 * p[2]};
    EXPECT_NE(refusal(turned).find("degrees"), std::string::npos);
    EXPECT_EQ(refusal(torus(50, 30)), "");
}

TEST(Transfer, MeshesThatAreInsideOutAreTurnedOverAndMirroredTargetsRefused) {
    TriangleSoup lopsided = octahedron_sphere(4);
    for (auto& p : lopsided.points) p[0] += 0.5 * p[0] * p[0];
    const Mesh source = build_mesh(lopsided);
    TriangleSoup flipped = lopsided, mirrored = lopsided;
    for (auto& t : flipped.triangles) std::swap(t[0], t[1]);
    for (auto& p : mirrored.points) p[0] = 0.3333 - p[0];
    for (auto& t : mirrored.triangles) std::swap(t[0], t[1]);
    EXPECT_THROW(transfer_to({source, set_of({})}, build_mesh(mirrored)), Error);
    const Mesh turned = build_mesh(flipped);
    const AnnotationSet caps = set_of({region(1, source, cap)});
    EXPECT_FALSE(transfer_to({source, caps}, source).turned_over);
    for (const auto& [from, onto] : {std::pair{&source, &turned}, {&turned, &source}}) {
        const TransferResult result = transfer_to({*from, caps}, *onto);
        EXPECT_TRUE(result.turned_over);
        EXPECT_EQ(result.annotations.annotations.at(0).faces, caps.annotations.at(0).faces);
        EXPECT_EQ(result.scores.at(0).outcome, TransferOutcome::kept);
    }
}

TEST(Transfer, AnnotationOfAnotherMeshIsRefused) {
    const Mesh mesh = build_mesh(octahedron_sphere(2));
    Annotation wrong;
    wrong.type = AnnotationType::point;
    wrong.points = {100000};
    EXPECT_THROW(transfer_to({mesh, set_of({wrong})}, mesh), Error);
}
