#include "ostraka/reconstruction/search_placement.h"

#include "meshes.h"
#include "pieces.h"

#include "ostraka/geom/eigen.h"
#include "ostraka/reconstruction/reconstruct.h"
#include "ostraka/synthetic/fragments.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

using Eigen::Vector3d;

/// No two parts of it are similar.
Mesh potato() {
    Mesh mesh = build_mesh(test::octahedron_sphere(5));
    for (const Vertex v : mesh.vertices()) {
        const Vector3d p = eigen(mesh.point(v));
        const double r =
            1 + 0.15 * std::sin(3 * p.x() + 1) * std::cos(2 * p.y()) + 0.1 * p.z() * p.x() + 0.05 * std::sin(7 * p.z());
        mesh.point(v) = point_of(Vector3d(r * p.x(), 1.2 * r * p.y(), 1.8 * r * p.z()));
    }
    return mesh;
}

struct Cut {
    Fragment fragment;
    Motion pose;
};

Cut cut(const Mesh& original, const Point& centre) {
    FragmentOptions options;
    options.share = 0.35;
    SyntheticFragment piece = generate_fragment(original, centre, options);
    Cut cut_piece;
    cut_piece.fragment.name = "piece";
    cut_piece.fragment.mesh = std::move(piece.mesh);
    cut_piece.pose = piece.pose;
    return cut_piece;
}

std::vector<FragmentPlacement> without_landmarks(std::size_t count) {
    std::vector<FragmentPlacement> placed(count);
    for (FragmentPlacement& placement : placed) placement.problem = "has 0 landmarks";
    return placed;
}

TEST(SearchPlacement, PlacesAFragmentWithoutLandmarks) {
    const Mesh mesh = potato();
    Cut cut_piece = cut(mesh, Point(0, 0.5, 1.6));
    const Reconstruction result = reconstruct({mesh, {}}, {}, {&cut_piece.fragment});
    ASSERT_TRUE(result.placement.any()) << result.placement.fragments[0].problem;
    ASSERT_EQ(result.searched.size(), 1U);
    ASSERT_TRUE(result.searched[0].has_value());
    EXPECT_TRUE(result.searched[0]->decided);
    EXPECT_LT((result.placement.fragments[0].pose.rotation - cut_piece.pose.rotation).norm(), 0.01);
    EXPECT_EQ(result.placement.scale, 1);
    EXPECT_NEAR(result.observed_share, 0.35, 0.05);
    EXPECT_TRUE(std::isfinite(result.placement.fragments[0].residual));
    EXPECT_EQ(result.verdict, Compatibility::undecided) << "one fragment, no constraint";
}

TEST(SearchPlacement, RunsOnlyWhereRequested) {
    const Mesh mesh = potato();
    Cut cut_piece = cut(mesh, Point(0, 0.5, 1.6));
    SearchOptions options;
    double scale = 1;
    auto placed = without_landmarks(1);
    options.search = SearchOptions::Search::never;
    EXPECT_FALSE(place_by_search(mesh, {&cut_piece.fragment}, options, scale, placed)[0].has_value());
    EXPECT_EQ(placed[0].problem, "has 0 landmarks");
    // A mirror image, for example, has enough landmarks: another pose would not be an answer.
    options.search = SearchOptions::Search::automatic;
    placed[0].landmarks.resize(4);
    EXPECT_FALSE(place_by_search(mesh, {&cut_piece.fragment}, options, scale, placed)[0].has_value());
    placed[0].landmarks.clear();
    cut_piece.fragment.facets.assign(cut_piece.fragment.mesh.number_of_faces(), Facet::fracture);
    EXPECT_FALSE(place_by_search(mesh, {&cut_piece.fragment}, options, scale, placed)[0].has_value());
    EXPECT_NE(placed[0].problem.find("fracture"), std::string::npos);
}

TEST(SearchPlacement, TakesTheScaleOfLandmarks) {
    const Mesh mesh = potato();
    Cut with_landmarks = cut(mesh, Point(0, -0.5, -1.6)), cut_piece = cut(mesh, Point(0, 0.5, 1.6));
    Motion larger;
    larger.scale = 1.5;
    cut_piece.fragment.mesh = moved(cut_piece.fragment.mesh, larger);
    auto placed = without_landmarks(2);
    placed[0].problem.clear();
    double scale = 1.5;
    const auto results = place_by_search(mesh, {&with_landmarks.fragment, &cut_piece.fragment}, {}, scale, placed);
    EXPECT_FALSE(results[0].has_value());
    ASSERT_TRUE(results[1].has_value());
    EXPECT_EQ(scale, 1.5);
    ASSERT_TRUE(placed[1].problem.empty()) << placed[1].problem;
    EXPECT_LT((placed[1].pose.rotation - cut_piece.pose.rotation).norm(), 0.01);
}

TEST(SearchPlacement, AnUnrelatedFragmentIsNotPlaced) {
    const Mesh mesh = potato();
    Fragment stranger;
    stranger.mesh = build_mesh(test::torus(120, 60));
    for (const Vertex v : stranger.mesh.vertices()) {
        const Vector3d p = eigen(stranger.mesh.point(v));
        stranger.mesh.point(v) = point_of(Vector3d((0.5 + 0.1 * std::sin(5 * p.y())) * p.x(), 0.4 * p.y(), 0.5 * p.z()));
    }
    double scale = 1;
    auto placed = without_landmarks(1);
    (void)place_by_search(mesh, {&stranger}, {}, scale, placed);
    EXPECT_NE(placed[0].problem.find("cannot decide"), std::string::npos) << placed[0].problem;
}

TEST(SearchPlacement, OneLandmarkDecidesTheRotationOfAVessel) {
    // A rotated vase: its pieces are found up to the rotation about its axis.
    const Mesh mesh = test::deformed_by(build_mesh(test::octahedron_sphere(5)), [](const Vector3d& p) {
        const double r = 1 + 0.3 * std::sin(3 * p.z()) + 0.1 * p.z();
        return Vector3d(r * p.x(), r * p.y(), 2 * p.z());
    });
    Cut cut_piece = cut(mesh, Point(0.9, 0.3, 0.9));
    Index far = 0;
    for (const Vertex v : cut_piece.fragment.mesh.vertices()) {
        const Point p = point_of(cut_piece.pose(eigen(cut_piece.fragment.mesh.point(v))));
        const Point q = point_of(cut_piece.pose(eigen(cut_piece.fragment.mesh.point(Vertex(far)))));
        if (std::hypot(p.x(), p.y()) > std::hypot(q.x(), q.y())) far = v;
    }
    const Vector3d moved_place = cut_piece.pose(eigen(cut_piece.fragment.mesh.point(Vertex(far))));
    Index same = 0;
    for (const Vertex v : mesh.vertices())
        if ((eigen(mesh.point(v)) - moved_place).norm() < (eigen(mesh.point(Vertex(same))) - moved_place).norm()) same = v;
    AnnotationSet set;
    set.annotations.push_back(test::landmark(0, "mark", same));
    const Reconstruction without_landmark = reconstruct({mesh, set}, {}, {&cut_piece.fragment});
    ASSERT_TRUE(without_landmark.searched[0].has_value() && without_landmark.searched[0]->decided);
    EXPECT_EQ(without_landmark.searched[0]->slippable.kind, SlippableKind::rotation);
    cut_piece.fragment.annotations.annotations.push_back(test::landmark(0, "mark", far));
    const Reconstruction with_landmark = reconstruct({mesh, set}, {}, {&cut_piece.fragment});
    EXPECT_EQ(with_landmark.searched[0]->slippable.kind, SlippableKind::none);
    EXPECT_LT((with_landmark.placement.fragments[0].pose.rotation - cut_piece.pose.rotation).norm(), 0.02);
    ASSERT_EQ(with_landmark.placement.fragments[0].landmarks.size(), 1U);
    EXPECT_TRUE(with_landmark.placement.fragments[0].landmarks[0].used);
    ASSERT_FALSE(with_landmark.notes[0].empty());
    EXPECT_NE(with_landmark.notes[0].back().find("decided by its landmarks"), std::string::npos);
}

TEST(SearchPlacement, AnotherUnitIsReported) {
    const Mesh mesh = potato();
    for (const double factor : {1e-4, 1e-3, 100.0, 1e6}) {
        Cut cut_piece = cut(mesh, Point(0, 0.5, 1.6));
        for (const Vertex v : cut_piece.fragment.mesh.vertices())
            cut_piece.fragment.mesh.point(v) = point_of(factor * eigen(cut_piece.fragment.mesh.point(v)));
        const Reconstruction result = reconstruct({mesh, {}}, {}, {&cut_piece.fragment});
        EXPECT_FALSE(result.placement.any());
        EXPECT_NE(result.placement.fragments[0].problem.find("another unit"), std::string::npos) << factor;
    }
    Fragment triangle;
    triangle.name = "triangle";
    triangle.mesh = build_mesh({{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}, {{0, 1, 2}}});
    EXPECT_FALSE(reconstruct({mesh, {}}, {}, {&triangle}).placement.any());
}

}  // namespace
}  // namespace ostraka
