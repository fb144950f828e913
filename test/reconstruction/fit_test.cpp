#include "ostraka/reconstruction/reconstruct.h"

#include "pieces.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace ostraka {
namespace {

using namespace test;
using Eigen::Vector3d;

double worst_distance(const Mesh& mesh, const std::vector<Point>& points, const std::vector<bool>& which, const Mesh& surface) {
    const SurfaceSearch search(surface);
    double worst = 0;
    for (const Vertex v : mesh.vertices())
        if (which[v]) worst = std::max(worst, search.closest(points[v]).distance);
    return worst;
}

TEST(Fit, AFragmentOfTheTemplateItselfChangesNothing) {
    const Mesh original = body();
    const AnnotationSet set = landmarks_of(original);
    FragmentOptions options;
    options.share = 0.4;
    const Cut cut_piece = cut({original, set}, Point(0, 0, 1.8), options);
    const Reconstruction result = reconstruct({original, set}, {}, {&cut_piece.fragment});
    ASSERT_TRUE(result.placement.any()) << result.placement.fragments[0].problem;
    EXPECT_NEAR(result.placement.scale, 1, 1e-9);
    EXPECT_LT((result.placement.fragments[0].pose.rotation - cut_piece.piece.pose.rotation).norm(), 1e-9);
    for (const Vertex v : original.vertices())
        EXPECT_LT(std::sqrt(CGAL::squared_distance(result.points[v], original.point(v))), 1e-6 * box_diagonal(original));
    EXPECT_EQ(result.verdict, Compatibility::undecided) << "one fragment, no constraint";
}

TEST(Fit, TheObservedPartLiesOnTheFragmentAndTheRestFollows) {
    const Mesh mesh = body();
    const AnnotationSet set = landmarks_of(mesh);
    const double diagonal = box_diagonal(mesh);
    const Mesh original = deformed_by(
        mesh, [](const Vector3d& p) { return Vector3d(p.x() * (1 + 0.1 * p.z()), p.y() + 0.08 * p.z() * p.z(), 1.08 * p.z()); });
    FragmentOptions options;
    options.share = 0.5;
    const Cut cut_piece = cut({original, set}, Point(0, 0, 1.9), options);
    const Reconstruction result = reconstruct({mesh, set}, {}, {&cut_piece.fragment});
    ASSERT_TRUE(result.placement.any()) << result.placement.fragments[0].problem;
    EXPECT_NEAR(result.observed_share, 0.5, 0.08);
    std::vector<bool> observed(mesh.number_of_vertices(), false);
    for (std::size_t i = 0; i < observed.size(); ++i) observed[i] = result.distance[i] >= 0;
    const Mesh placed = moved(cut_piece.fragment.mesh, result.placement.fragments[0].pose);
    EXPECT_LT(worst_distance(mesh, result.points, observed, placed), 0.005 * diagonal);
    // The unobserved part is no farther from the truth than the registered template, apart from the effect of the edge.
    const Motion frame = result.placement.fragments[0].pose.after(cut_piece.piece.pose.inverse());
    double fitted = 0, rigid = 0;
    for (const Vertex v : mesh.vertices()) {
        if (observed[v]) continue;
        const Vector3d truth = frame(eigen(original.point(v)));
        fitted += (eigen(result.points[v]) - truth).squaredNorm();
        rigid += (result.placement.scale * eigen(mesh.point(v)) - truth).squaredNorm();
    }
    EXPECT_LT(fitted, 1.5 * rigid);
    EXPECT_EQ(result.crossings, 0U);
}

TEST(Fit, TheUnobservedPartKeepsItsSizeWhereTheFragmentIsNarrowAtTheFracture) {
    const Mesh mesh = body();
    const AnnotationSet set = landmarks_of(mesh);
    const Mesh original = deformed_by(mesh, [](const Vector3d& p) {
        const double waist = 1 - 0.25 * std::exp(-std::pow(p.z() / 0.6, 2));
        return Vector3d(waist * p.x(), waist * p.y(), p.z());
    });
    FragmentOptions options;
    options.share = 0.5;
    const Cut cut_piece = cut({original, set}, Point(0, 0, 1.9), options);
    const Reconstruction result = reconstruct({mesh, set}, {}, {&cut_piece.fragment});
    ASSERT_TRUE(result.placement.any()) << result.placement.fragments[0].problem;
    // Distances of the points of the missing end from their mean.
    std::vector<Vector3d> at_rest, fitted;
    for (const Vertex v : mesh.vertices())
        if (mesh.point(v).z() < -0.9) {
            at_rest.push_back(result.placement.scale * eigen(mesh.point(v)));
            fitted.push_back(eigen(result.points[v]));
        }
    const auto spread = [](const std::vector<Vector3d>& places) {
        Vector3d mean = Vector3d::Zero();
        for (const Vector3d& p : places) mean += p / static_cast<double>(places.size());
        double squares = 0;
        for (const Vector3d& p : places) squares += (p - mean).squaredNorm();
        return std::sqrt(squares / static_cast<double>(places.size()));
    };
    EXPECT_NEAR(spread(fitted) / spread(at_rest), 1, 0.1);
}

TEST(Fit, NoiseDoesNotSpreadIntoTheUnobservedPart) {
    const Mesh mesh = body();
    const AnnotationSet set = landmarks_of(mesh);
    FragmentOptions options;
    options.share = 0.3;
    options.noise = 0.005;
    options.erosion = 0.01;
    const Cut cut_piece = cut({mesh, set}, Point(0, 0, 1.9), options);
    const Reconstruction result = reconstruct({mesh, set}, {}, {&cut_piece.fragment});
    const Motion frame = result.placement.fragments[0].pose.after(cut_piece.piece.pose.inverse());
    for (const Vertex v : mesh.vertices())
        if (result.distance[v] < 0) {
            EXPECT_LT((eigen(result.points[v]) - frame(eigen(mesh.point(v)))).norm(), 0.03 * box_diagonal(mesh));
        }
}

TEST(Fit, PartsMatchTheirCounterpartsByPositionOrByEquation51) {
    const Mesh mesh = body();
    AnnotationSet set = landmarks_of(mesh);
    Annotation head;
    head.id = 100;
    head.tag = "head";
    for (const Face face : mesh.faces())
        if (centroid(mesh, face).z() > 1.2) head.faces.push_back(face);
    set.annotations.push_back(head);
    const double diagonal = box_diagonal(mesh);
    const Mesh original = deformed_by(mesh, [](const Vector3d& p) { return Vector3d(1.1 * p.x(), p.y(), p.z() + 0.05 * p.x()); });
    AnnotationSet points = landmarks_of(mesh);
    FragmentOptions options;
    options.share = 0.4;
    Cut cut_piece = cut({original, points}, Point(0, 0, 1.9), options);
    Annotation part = head;
    part.faces.clear();
    for (Index f = 0; f < cut_piece.piece.faces.size(); ++f)
        if (std::binary_search(head.faces.begin(), head.faces.end(), cut_piece.piece.faces[f])) part.faces.push_back(f);
    cut_piece.fragment.annotations.annotations.push_back(part);
    for (const std::string counterparts : {"surface", "best", "one-to-one"}) {
        ReconstructOptions fit_options;
        set_option(fit_options.fit, "counterparts", counterparts);
        const Reconstruction result = reconstruct({mesh, set}, {}, {&cut_piece.fragment}, fit_options);
        ASSERT_TRUE(result.placement.any());
        std::vector<bool> observed(mesh.number_of_vertices(), false);
        for (const Index f : head.faces)
            for (const Vertex v : corners(mesh, Face(f))) observed[v] = result.distance[v] >= 0;
        EXPECT_GT(std::count(observed.begin(), observed.end(), true), 50) << counterparts;
        const Mesh placed = moved(cut_piece.fragment.mesh, result.placement.fragments[0].pose);
        EXPECT_LT(worst_distance(mesh, result.points, observed, placed), 0.01 * diagonal) << counterparts;
        // The fit of the remaining surface does not become worse.
        EXPECT_NEAR(result.observed_share, 0.4, 0.1) << counterparts;
    }
}

TEST(Fit, NothingIsFittedToAFracture) {
    const Mesh mesh = body(3);
    const AnnotationSet set = landmarks_of(mesh);
    Cut cut_piece = cut({mesh, set}, Point(0, 0, 1.8), {});
    cut_piece.fragment.facets.assign(cut_piece.fragment.mesh.number_of_faces(), Facet::fracture);
    const Reconstruction result = reconstruct({mesh, set}, {}, {&cut_piece.fragment});
    EXPECT_EQ(result.observed_share, 0);
    for (const auto& match : result.fit.matches) EXPECT_EQ(match.fragment, -1);
}

TEST(Fit, TheSameForAnyNumberOfThreadsAndFarAway) {
    const Mesh mesh = body(3);
    const AnnotationSet set = landmarks_of(mesh);
    const Mesh original = deformed_by(mesh, [](const Vector3d& p) { return Vector3d(p.x(), p.y(), 1.1 * p.z()); });
    const Cut cut_piece = cut({original, set}, Point(0, 0, 1.9), {});
    const int before = threads();
    set_threads(1);
    const Reconstruction alone = reconstruct({mesh, set}, {}, {&cut_piece.fragment});
    set_threads(4);
    const Reconstruction many = reconstruct({mesh, set}, {}, {&cut_piece.fragment});
    set_threads(before);
    EXPECT_EQ(alone.points, many.points);
    Fragment far = cut_piece.fragment.facets.empty() ? Fragment{{}, "far", {}} : Fragment{};
    Motion away;
    away.translation = Vector3d(1e5, -1e5, 1e5);
    far.mesh = moved(cut_piece.fragment.mesh, away);
    for (const auto& annotation : cut_piece.fragment.annotations.annotations) far.annotations.annotations.push_back(annotation);
    const Reconstruction far_result = reconstruct({mesh, set}, {}, {&far});
    for (std::size_t i = 0; i < alone.points.size(); ++i)
        EXPECT_LT(std::sqrt(CGAL::squared_distance(alone.points[i], far_result.points[i])), 1e-4);
}

TEST(Fit, WithoutLandmarksItCannotDecide) {
    const Mesh mesh = body(3);
    const AnnotationSet set = landmarks_of(mesh);
    Cut cut_piece = cut({mesh, set}, Point(0, 0, 1.8), {});
    cut_piece.fragment.annotations.annotations.clear();
    ReconstructOptions never;
    never.search.search = SearchOptions::Search::never;
    const Reconstruction result = reconstruct({mesh, set}, {}, {&cut_piece.fragment}, never);
    EXPECT_EQ(result.verdict, Compatibility::undecided);
    EXPECT_NE(result.undecided, "");
    ASSERT_EQ(result.objections.size(), 1U);
    EXPECT_NE(result.objections[0].text.find("landmarks"), std::string::npos);
    EXPECT_TRUE(result.points.empty());
    EXPECT_THROW(reconstruct({mesh, set}, {}, {}), Error);
}

TEST(Fragments, HaveTheRequestedShareAndPose) {
    const Mesh original = body();
    FragmentOptions options;
    for (const double share : {0.1, 0.25, 0.5}) {
        options.share = share;
        const SyntheticFragment piece = generate_fragment(original, Point(0, 0, 1.8), options);
        EXPECT_NEAR(surface_area(piece.mesh), share * surface_area(original), 0.02 * surface_area(original));
        for (const Vertex v : piece.mesh.vertices())
            EXPECT_LT((piece.pose(eigen(piece.mesh.point(v))) - eigen(original.point(Vertex(piece.vertices[v])))).norm(), 1e-12);
        options.erosion = 0.03;
        EXPECT_LT(surface_area(generate_fragment(original, Point(0, 0, 1.8), options).mesh), surface_area(piece.mesh));
        options.erosion = 0;
    }
    options.share = 0.01;
    options.erosion = 0.5;
    EXPECT_THROW(generate_fragment(original, Point(0, 0, 1.8), options), Error);
    options.share = 2;
    EXPECT_THROW(generate_fragment(original, Point(0, 0, 1.8), options), Error);
}

}  // namespace
}  // namespace ostraka
