#include "ostraka/registration/consistent.h"

#include "registration/heads.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/submesh.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

TEST(MeshSift, FeaturesMoveWithTheSurface) {
    const Mesh mesh = test::head(1, 1).mesh;
    const FeatureSet features = mesh_sift(mesh);
    ASSERT_GT(features.features.size(), 20U);
    for (const double scale : {1.0, 1e-3, 1e4}) {
        const Motion motion = test::motion(scale, 10 * scale);
        const FeatureSet moved_features = mesh_sift(test::moved(mesh, motion));
        ASSERT_EQ(moved_features.features.size(), features.features.size()) << scale;
        for (std::size_t i = 0; i < features.features.size(); ++i) {
            EXPECT_EQ(moved_features.features[i].vertex, features.features[i].vertex);
            EXPECT_NEAR(moved_features.features[i].scale, scale * features.features[i].scale,
                        1e-9 * moved_features.features[i].scale);
            EXPECT_LT((moved_features.features[i].direction - motion.rotation * features.features[i].direction).norm(), 0.01);
        }
        EXPECT_LT((moved_features.descriptors - features.descriptors).cwiseAbs().maxCoeff(), 0.02);
    }
}

TEST(MeshSift, DirectionsAreTangentUnitVectors) {
    const FeatureSet set = mesh_sift(test::head(2, 1).mesh);
    for (const Feature& feature : set.features) {
        EXPECT_NEAR(feature.normal.norm(), 1, 1e-12);
        EXPECT_NEAR(feature.direction.norm(), 1, 1e-12);
        EXPECT_NEAR(feature.direction.dot(feature.normal), 0, 1e-12);
    }
    // Each histogram was cut off at 1 / sqrt(8).
    EXPECT_LE(set.descriptors.maxCoeff(), 1 / std::sqrt(8.0F) + 1e-6F);
    EXPECT_GE(set.descriptors.minCoeff(), 0);
}

TEST(MeshSift, ABallHasNoSalientPoints) {
    // Curvature is constant up to the triangulation.
    EXPECT_EQ(mesh_sift(build_mesh(test::octahedron_sphere(5))).features.size(), 0U);
}

TEST(MeshSift, AnIndependentMeshOfTheSameSurfaceHasTheSameFeatures) {
    const HeadCast a = test::head(1, 1), b = test::head(1, 2);
    SiftOptions options;
    options.size = 66;
    const FeatureSet fa = mesh_sift(a.mesh, options), fb = mesh_sift(b.mesh, options);
    // Most front features have a counterpart of similar scale within half their sigma.
    int front = 0, matched = 0;
    for (const Feature& feature : fa.features) {
        const auto part = a.face_labels[a.mesh.face(a.mesh.halfedge(Vertex(feature.vertex)))];
        if (part != static_cast<int>(HeadPart::nose) && part != static_cast<int>(HeadPart::mouth)) continue;
        ++front;
        for (const Feature& other : fb.features) {
            if ((other.point - feature.point).norm() > 0.75 * feature.scale) continue;
            if (std::abs(std::log2(other.scale / feature.scale)) > 0.5) continue;
            ++matched;
            break;
        }
    }
    ASSERT_GT(front, 4);
    EXPECT_GT(matched, 0.6 * front);
}

TEST(MeshSift, HasNoFeaturesAtTheBorder) {
    const HeadCast head = test::head(1, 1);
    std::vector<bool> keep;
    for (const auto label : head.face_labels) keep.push_back(label != static_cast<int>(HeadPart::back));
    const Mesh open = keep_faces(head.mesh, keep, true).mesh;
    SiftOptions options;
    options.border = 2;
    const FeatureSet set = mesh_sift(open, options);
    ASSERT_GT(set.features.size(), 10U);
    for (const Feature& feature : set.features) {
        for (const Vertex v : open.vertices()) {
            if (!open.is_border(v)) continue;
            EXPECT_GT((eigen(open.point(v)) - eigen(open.point(Vertex(feature.vertex)))).norm(), 0.5 * feature.scale);
        }
    }
    options.border = 10;
    options.first_scale = 0.1;
    EXPECT_TRUE(mesh_sift(open, options).features.empty());
}

TEST(MeshSift, SameForAnyNumberOfThreads) {
    const Mesh mesh = test::head(1, 1).mesh;
    set_threads(1);
    const FeatureSet single_threaded = mesh_sift(mesh);
    set_threads(2);
    const FeatureSet two = mesh_sift(mesh);
    set_threads(0);
    EXPECT_TRUE(single_threaded.descriptors == two.descriptors);
}

TEST(MeshSift, DegenerateMeshes) {
    EXPECT_THROW((void)mesh_sift(Mesh()), Error);
    TriangleSoup flat;
    flat.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    flat.triangles = {{0, 1, 2}};
    EXPECT_THROW((void)mesh_sift(build_mesh(flat)), Error);
    flat.points[2] = {0, 1, 0};
    EXPECT_TRUE(mesh_sift(build_mesh(flat)).features.empty());
}

TEST(Matches, ASurfaceMatchesItself) {
    const FeatureSet set = mesh_sift(test::head(1, 1).mesh);
    const auto matches = match_features(set, set);
    EXPECT_GT(static_cast<double>(matches.size()), 0.9 * static_cast<double>(set.features.size()));
    for (const auto& match : matches) EXPECT_EQ(match.a, match.b);
    EXPECT_TRUE(match_features(FeatureSet(), set).empty());
    EXPECT_TRUE(match_features(set, FeatureSet()).empty());
}

TEST(Matches, ConsistentMatchesDetermineTheMotion) {
    const Mesh a = test::head(1, 1).mesh;
    for (const double scale : {1.0, 0.93}) {
        const Motion truth = test::motion(scale);
        const Mesh b = test::moved(test::head(1, 2).mesh, truth);
        SiftOptions options;
        options.size = 66;
        const FeatureSet fa = mesh_sift(a, options), fb = mesh_sift(b, options);
        ConsistentOptions consistent;
        consistent.shrinkage = scale < 1 ? 0.15 : 0;
        const auto result = consistent_matches(fa, fb, match_features(fa, fb), consistent);
        EXPECT_GT(result.matches.size(), 8U);
        EXPECT_LT(test::rotation_between(result.motion.rotation, truth.rotation), 4);
        EXPECT_NEAR(result.motion.scale, scale, 0.03);
        for (const auto& match : result.matches)
            EXPECT_LT((result.motion(fa.features[match.a].point) - fb.features[match.b].point).norm(), 0.0201 * 66);
    }
}

TEST(Matches, MatchesOfOneMouldAreMoreConsistentThanThoseOfTwo) {
    std::vector<FeatureSet> sets;
    SiftOptions options;
    options.size = 66;
    for (const auto& [mould, seed] : {std::pair<int, int>{1, 1}, {1, 2}, {2, 3}, {2, 4}})
        sets.push_back(mesh_sift(test::head(static_cast<std::uint64_t>(mould), static_cast<std::uint64_t>(seed)).mesh, options));
    const auto count = [&](std::size_t i, std::size_t j) {
        return consistent_matches(sets[i], sets[j], match_features(sets[i], sets[j])).matches.size();
    };
    const auto other = std::max({count(0, 2), count(0, 3), count(1, 2), count(1, 3)});
    EXPECT_GT(2 * count(0, 1), 3 * other);
    EXPECT_GT(2 * count(2, 3), 3 * other);
}

TEST(Matches, EmptySetsHaveNoMatches) {
    const ConsistentMatches none = consistent_matches(FeatureSet(), FeatureSet(), {});
    EXPECT_TRUE(none.matches.empty());
    EXPECT_TRUE(none.motion.rotation.isIdentity());
}

}  // namespace
}  // namespace ostraka
