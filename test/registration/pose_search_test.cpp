#include "ostraka/registration/pose_search.h"

#include "meshes.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/synthetic/fragments.h"
#include "registration/pair_votes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ostraka {
namespace {

using Eigen::Vector3d;

Mesh shaped(const Mesh& mesh, const std::function<Vector3d(const Vector3d&)>& map) {
    Mesh result = mesh;
    for (const Vertex v : result.vertices()) result.point(v) = point_of(map(eigen(mesh.point(v))));
    return result;
}

Mesh ball(int levels = 5) { return build_mesh(test::octahedron_sphere(levels)); }

/// No two parts of it are similar.
Mesh potato() {
    return shaped(ball(), [](const Vector3d& p) {
        const double r =
            1 + 0.15 * std::sin(3 * p.x() + 1) * std::cos(2 * p.y()) + 0.1 * p.z() * p.x() + 0.05 * std::sin(7 * p.z());
        return Vector3d(r * p.x(), 1.2 * r * p.y(), 1.8 * r * p.z());
    });
}

double degrees_between(const Motion& a, const Motion& b) {
    return Eigen::AngleAxisd(Eigen::Matrix3d(a.rotation.transpose() * b.rotation)).angle() * 180 / std::numbers::pi;
}

Vector3d middle_of(const Mesh& mesh) {
    Vector3d sum = Vector3d::Zero();
    for (const Vertex v : mesh.vertices()) sum += eigen(mesh.point(v)) / double(mesh.number_of_vertices());
    return sum;
}

SyntheticFragment broken(const Mesh& whole, const Point& centre, double share, double noise = 0, std::uint64_t seed = 1) {
    FragmentOptions options;
    options.share = share;
    options.noise = noise;
    options.seed = seed;
    return generate_fragment(whole, centre, options);
}

TEST(PoseSearch, FindsThePoseOfAPiece) {
    const Mesh whole = potato();
    const double diagonal = box_diagonal(whole);
    const SurfaceSearch surface(whole);
    const PoseSearch search(surface);
    for (const double noise : {0.0, 0.005})
        for (const std::uint64_t seed : {1, 2}) {
            const SyntheticFragment piece = broken(whole, seed == 1 ? Point(0, 0.5, 1.6) : Point(1, 0, 0), 0.25, noise, seed);
            const PoseSearchResult result = search.find(piece.mesh);
            ASSERT_TRUE(result.decided) << result.reason;
            const PoseCandidate& best = result.candidates.front();
            const Vector3d middle = middle_of(piece.mesh);
            EXPECT_LT(degrees_between(best.pose, piece.pose), noise > 0 ? 3 : 0.5);
            EXPECT_LT((best.pose(middle) - piece.pose(middle)).norm(), (noise > 0 ? 0.01 : 0.002) * diagonal);
            EXPECT_GT(best.share, 0.9);
            EXPECT_LT(best.inside, 0.1);
            EXPECT_EQ(best.scale, 1);
            EXPECT_EQ(best.pose.scale, 1);
            EXPECT_EQ(result.slippable.kind, SlippableKind::none);
            for (std::size_t k = 1; k < result.candidates.size(); ++k)
                EXPECT_LE(result.candidates[k].score, result.candidates[k - 1].score);
        }
}

TEST(PoseSearch, DoesNotDependOnUnitOrPosition) {
    const Mesh start = potato();
    for (const double size : {1e-6, 1e6})
        for (const double far : {0.0, 1e4}) {
            const Mesh whole = shaped(start, [&](const Vector3d& p) { return Vector3d(size * (p + far * Vector3d(1, -1, 1))); });
            const SurfaceSearch surface(whole);
            const SyntheticFragment piece =
                broken(whole, point_of(size * (Vector3d(0, 0.5, 1.6) + far * Vector3d(1, -1, 1))), 0.25);
            const PoseSearchResult result = PoseSearch(surface).find(piece.mesh);
            ASSERT_TRUE(result.decided) << result.reason;
            EXPECT_LT(degrees_between(result.candidates.front().pose, piece.pose), 1);
        }
}

TEST(PoseSearch, FindsTheScaleToo) {
    const Mesh whole = potato();
    const SurfaceSearch surface(whole);
    const SyntheticFragment piece = broken(whole, Point(0, 0.5, 1.6), 0.4);
    const Mesh larger = shaped(piece.mesh, [](const Vector3d& p) { return Vector3d(1.37 * p); });
    PoseSearchOptions options;
    options.min_scale = 1.1;
    options.max_scale = 1.8;
    const PoseSearchResult result = PoseSearch(surface, options).find(larger);
    ASSERT_TRUE(result.decided) << result.reason;
    const PoseCandidate& best = result.candidates.front();
    EXPECT_NEAR(best.scale, 1.37, 0.02);
    EXPECT_LT(degrees_between(best.pose, piece.pose), 2);
    // Onto the scaled whole.
    const Vector3d middle = middle_of(piece.mesh);
    EXPECT_LT((best.pose(1.37 * middle) - best.scale * piece.pose(middle)).norm(), 0.05);
}

TEST(PoseSearch, OnlyMarkedFacesCount) {
    const Mesh whole = potato();
    const SurfaceSearch surface(whole);
    SyntheticFragment piece = broken(whole, Point(0, 0.5, 1.6), 0.3);
    // A third of the piece is damaged, and not marked.
    const Vector3d middle = middle_of(piece.mesh);
    std::vector<bool> marks(piece.mesh.number_of_faces(), true);
    std::vector<bool> spoilt(piece.mesh.number_of_vertices());
    for (const Vertex v : piece.mesh.vertices()) spoilt[v] = (eigen(piece.mesh.point(v)) - middle).x() > 0.25;
    for (const Face f : piece.mesh.faces())
        for (const Vertex v : corners(piece.mesh, f))
            if (spoilt[v]) marks[f] = false;
    for (const Vertex v : piece.mesh.vertices())
        if (spoilt[v]) piece.mesh.point(v) = point_of(middle + 3 * (eigen(piece.mesh.point(v)) - middle));
    const PoseSearchResult result = PoseSearch(surface).find(piece.mesh, marks);
    ASSERT_TRUE(result.decided) << result.reason;
    EXPECT_LT(degrees_between(result.candidates.front().pose, piece.pose), 1);
    EXPECT_GT(result.candidates.front().share, 0.95);
}

TEST(PoseSearch, ReportsTheSlippableMotionsOfABall) {
    const Mesh whole = shaped(ball(), [](const Vector3d& p) { return Vector3d(2 * p + Vector3d(1, 2, 3)); });
    const SurfaceSearch surface(whole);
    const SyntheticFragment piece = broken(whole, Point(1, 2, 5), 0.2);
    const PoseSearchResult result = PoseSearch(surface).find(piece.mesh);
    EXPECT_EQ(result.slippable.kind, SlippableKind::sphere);
    EXPECT_LT((result.slippable.point - Vector3d(1, 2, 3)).norm(), 0.05);
    EXPECT_EQ(result.slippable_ranges.size(), 3u);
    for (const SlippableRange& range : result.slippable_ranges) {
        EXPECT_TRUE(range.rotates);
        EXPECT_GT(range.maximum - range.minimum, 6);  // all around
    }
    // Up to that rotation, the piece has its true pose.
    ASSERT_TRUE(result.decided) << result.reason;
    EXPECT_TRUE(
        result.slippable.contains(result.candidates.front().pose.after(piece.pose.inverse()), Vector3d(1, 2, 3), 0.05, 0.05));
}

TEST(PoseSearch, ReportsTheOpenRotationOfAVessel) {
    const Mesh whole = shaped(ball(), [](const Vector3d& p) {
        const double z = 2 * p.z(), r = std::hypot(p.x(), p.y()), wide = 1 + 0.3 * std::sin(2.5 * z + 0.5) + 0.15 * z;
        return r > 0 ? Vector3d(wide * p.x(), wide * p.y(), z) : Vector3d(0, 0, z);
    });
    const SurfaceSearch surface(whole);
    const SyntheticFragment piece = broken(whole, Point(1, 0, 0.3), 0.2);
    const PoseSearchResult result = PoseSearch(surface).find(piece.mesh);
    ASSERT_TRUE(result.decided) << result.reason;
    EXPECT_EQ(result.slippable.kind, SlippableKind::rotation);
    EXPECT_GT(std::abs(result.slippable.direction.z()), 0.999);
    EXPECT_LT(result.slippable.point.head<2>().norm(), 0.02);
    const Motion between = result.candidates.front().pose.after(piece.pose.inverse());
    EXPECT_TRUE(result.slippable.contains(between, Vector3d::Zero(), 0.03, 0.03));
    EXPECT_LT(std::abs(between(Vector3d(0, 0, 1)).z() - 1), 0.02);
}

TEST(PoseSearch, ReportsWhenItCannotDecide) {
    // An unrelated object: as large as a piece of the potato, but of another shape.
    const Mesh whole = potato();
    const SurfaceSearch surface(whole);
    const PoseSearch search(surface);
    const Mesh torus = shaped(build_mesh(test::torus(120, 60)), [](const Vector3d& p) {
        return Vector3d((0.5 + 0.1 * std::sin(5 * p.y())) * p.x(), 0.4 * p.y(), 0.5 * p.z());
    });
    const PoseSearchResult unrelated = search.find(torus);
    EXPECT_FALSE(unrelated.decided);
    EXPECT_FALSE(unrelated.reason.empty());
    EXPECT_LT(unrelated.confidence, 0.5);

    // A lens: its two ends are identical.
    const Mesh lens = shaped(ball(), [](const Vector3d& p) {
        return Vector3d((1 + 0.2 * p.x() * p.x()) * p.x(), (0.6 + 0.1 * p.x() * p.x()) * p.y(), 0.35 * p.z());
    });
    const SurfaceSearch both(lens);
    const SyntheticFragment piece = broken(lens, Point(1.2, 0, 0), 0.25);
    const PoseSearchResult twice = PoseSearch(both).find(piece.mesh);
    EXPECT_FALSE(twice.decided);
    ASSERT_GE(twice.candidates.size(), 2u);
    EXPECT_NEAR(twice.candidates[0].score, twice.candidates[1].score, 0.02);
    EXPECT_NE(twice.reason.find("equally well"), std::string::npos) << twice.reason;
}

TEST(PoseSearch, SameForAnyNumberOfThreads) {
    const Mesh whole = potato();
    const SurfaceSearch surface(whole);
    const SyntheticFragment piece = broken(whole, Point(0, 0.5, 1.6), 0.2, 0.003);
    const int before = threads();
    std::vector<PoseSearchResult> results;
    for (const int count : {1, 3}) {
        set_threads(count);
        results.push_back(PoseSearch(surface).find(piece.mesh));
    }
    set_threads(before);
    ASSERT_EQ(results[0].candidates.size(), results[1].candidates.size());
    for (std::size_t k = 0; k < results[0].candidates.size(); ++k) {
        EXPECT_EQ(results[0].candidates[k].pose.rotation, results[1].candidates[k].pose.rotation);
        EXPECT_EQ(results[0].candidates[k].pose.translation, results[1].candidates[k].pose.translation);
        EXPECT_EQ(results[0].candidates[k].score, results[1].candidates[k].score);
    }
    EXPECT_EQ(results[0].confidence, results[1].confidence);
}

TEST(PoseSearch, RefusesInvalidInput) {
    const Mesh whole = potato();
    const SurfaceSearch surface(whole);
    const PoseSearch search(surface);
    EXPECT_THROW((void)search.find(Mesh()), Error);
    EXPECT_THROW((void)search.find(whole, std::vector<bool>(3, true)), Error);
    EXPECT_THROW((void)search.find(whole, std::vector<bool>(whole.number_of_faces(), false)), Error);
    EXPECT_THROW((void)search.find(whole, {}, 2, 1), Error);
    EXPECT_THROW((void)search.find(whole, {}, 0, 1), Error);
    PoseSearchOptions wrong;
    wrong.min_scale = 2;
    EXPECT_THROW(PoseSearch(surface, wrong), Error);
    // One triangle fits anywhere: the pose is undetermined.
    Mesh triangle;
    triangle.add_face(triangle.add_vertex(Point(0, 0, 0)), triangle.add_vertex(Point(0.3, 0, 0)),
                      triangle.add_vertex(Point(0, 0.3, 0)));
    const PoseSearchResult flat = search.find(triangle);
    EXPECT_FALSE(flat.decided);
    EXPECT_FALSE(flat.reason.empty());
}

TEST(SurfacePoints, AreEvenAndSmooth) {
    const Mesh mesh = ball();
    const double spacing = 0.1;
    const SurfacePoints points = spread_points(mesh, {}, spacing, spacing);
    // Discs of half the spacing do not overlap, those of the spacing leave nothing bare.
    EXPECT_GT(points.size(), 4 * std::numbers::pi / (std::numbers::pi * spacing * spacing));
    EXPECT_LT(points.size(), 4 * std::numbers::pi / (std::numbers::pi * spacing * spacing / 4));
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(points.places[i].norm(), 1, 0.01);
        EXPECT_GT(points.normals[i].dot(points.places[i].normalized()), 0.999);
    }
    // A rough copy gives nearly the same normals.
    std::uint64_t state = 1;
    const Mesh rough = shaped(mesh, [&](const Vector3d& p) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        return Vector3d((1 + 0.02 * (double(state >> 40) / double(1 << 24) - 0.5)) * p);
    });
    const SurfacePoints same = spread_points(rough, {}, spacing, 2 * spacing);
    for (std::size_t i = 0; i < same.size(); ++i) EXPECT_GT(same.normals[i].dot(same.places[i].normalized()), 0.98);
    // Points are also spread over a large triangle; unmarked faces are left out.
    Mesh triangle;
    triangle.add_face(triangle.add_vertex(Point(0, 0, 0)), triangle.add_vertex(Point(3, 0, 0)),
                      triangle.add_vertex(Point(0, 3, 0)));
    EXPECT_GT(spread_points(triangle, {}, 0.3, 0.3).size(), 30u);
    EXPECT_EQ(spread_points(triangle, {false}, 0.3, 0.3).size(), 0u);
    EXPECT_EQ(spread_points(Mesh(), {}, 0.3, 0.3).size(), 0u);
    EXPECT_THROW((void)spread_points(triangle, {}, 0, 0.3), Error);
    EXPECT_THROW((void)spread_points(triangle, {true, true}, 0.3, 0.3), Error);
}

TEST(PairTable, VotesForTheMotion) {
    const Mesh whole = potato();
    const SurfacePoints points = spread_points(whole, {}, 0.12, 0.12);
    const PairTable table(points, 4, 0.1);
    Motion away;
    away.rotation = Eigen::AngleAxisd(2, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    away.translation = Vector3d(5, 6, 7);
    SurfacePoints part;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (points.places[i].z() > 0.5) {
            part.places.push_back(away(points.places[i]));
            part.normals.push_back(away.rotation * points.normals[i]);
        }
    const auto voted = table.vote(part, 10, 100, 1, 1);
    ASSERT_EQ(voted.size(), 10u);
    std::size_t near = 0;
    for (const VotedMotion& candidate : voted)
        if (degrees_between(candidate.motion, away.inverse()) < 12) ++near;
    EXPECT_GE(near, 8u);
    EXPECT_TRUE(table.vote({}, 10, 100, 1, 1).empty());
    EXPECT_TRUE(PairTable({}, 1, 0.1).vote(part, 10, 100, 1, 1).empty());
    EXPECT_THROW(PairTable(points, 0, 0.1), Error);
}

}  // namespace
}  // namespace ostraka
