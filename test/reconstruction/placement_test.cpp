#include "ostraka/reconstruction/placement.h"

#include "meshes.h"

#include "ostraka/core/error.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

using Eigen::Vector3d;

Vector3d random_place(Random& random) { return {random.normal(), random.normal(), random.normal()}; }

Motion random_motion(Random& random, double scale = 1) {
    Motion motion;
    motion.rotation =
        Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal()).normalized().toRotationMatrix();
    motion.translation = 5 * random_place(random);
    motion.scale = scale;
    return motion;
}

/// Landmarks of a template that is `scale` times as large in truth, on a fragment that `pose` transforms back.
std::vector<LandmarkPair> landmarks(Random& random, int count, double scale, const Motion& pose, double noise = 0) {
    std::vector<LandmarkPair> pairs;
    const Motion inverse_pose = pose.inverse();
    for (int i = 0; i < count; ++i) {
        const Vector3d place = random_place(random);
        pairs.push_back({"landmark " + std::to_string(i), place, inverse_pose(scale * place + noise * random_place(random))});
    }
    return pairs;
}

TEST(Placement, FindsOneScaleAndThePoseOfEachFragment) {
    for (const double scale : {1.0, 0.01, 250.0}) {
        Random random(3);
        const Motion first = random_motion(random), second = random_motion(random);
        const CommonPlacement placement =
            place_by_landmarks({landmarks(random, 4, scale, first), landmarks(random, 7, scale, second)});
        EXPECT_NEAR(placement.scale, scale, 1e-12 * scale);
        for (const auto& [fragment, pose] :
             {std::pair(placement.fragments[0], first), std::pair(placement.fragments[1], second)}) {
            EXPECT_EQ(fragment.problem, "");
            EXPECT_LT((fragment.pose.rotation - pose.rotation).norm(), 1e-12);
            EXPECT_LT((fragment.pose.translation - pose.translation).norm(), 1e-11 * (1 + scale));
            EXPECT_EQ(fragment.pose.scale, 1);
            EXPECT_NEAR(fragment.own_scale, scale, 1e-11 * scale);
            EXPECT_LT(fragment.residual, 1e-11 * (1 + scale));
        }
    }
}

// Any other scale and poses increase the sum of squares.
TEST(Placement, MinimisesTheSumOfSquares) {
    Random random(5);
    const std::vector<std::vector<LandmarkPair>> pairs{landmarks(random, 4, 2, random_motion(random), 0.1),
                                                       landmarks(random, 4, 2, random_motion(random), 0.1)};
    const CommonPlacement placement = place_by_landmarks(pairs);
    const auto cost = [&](double scale, const std::vector<Motion>& poses) {
        double sum = 0;
        for (std::size_t k = 0; k < 2; ++k)
            for (const LandmarkPair& pair : pairs[k])
                sum += (poses[k](pair.on_fragment) - scale * pair.on_template).squaredNorm();
        return sum;
    };
    const std::vector<Motion> best{placement.fragments[0].pose, placement.fragments[1].pose};
    const double minimum = cost(placement.scale, best);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<Motion> other = best;
        for (Motion& pose : other) {
            const Vector3d axis = random_place(random).normalized();
            Motion step;
            step.rotation = Eigen::AngleAxisd(0.01 * random.normal(), axis).toRotationMatrix();
            step.translation = 0.01 * random_place(random);
            pose = step.after(pose);
        }
        EXPECT_GE(cost(placement.scale * (1 + 0.01 * random.normal()), other), minimum);
    }
}

TEST(Placement, OneOutlierInSixIsDetected) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        const Motion pose = random_motion(random);
        auto pairs = landmarks(random, 6, 1, pose, 0.01);
        const std::size_t wrong = random.below(6);
        pairs[wrong].on_fragment = pose.inverse()(pairs[wrong].on_template + 1.5 * random_place(random).normalized());
        const CommonPlacement placement = place_by_landmarks({pairs});
        for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(placement.fragments[0].landmarks[i].used, i != wrong) << seed << ' ' << i;
        EXPECT_LT((placement.fragments[0].pose.rotation - pose.rotation).norm(), 0.1);
    }
}

TEST(Placement, ExchangedTagsAreNamed) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        auto pairs = landmarks(random, 12, 1, random_motion(random), 0.01);
        const std::size_t first = random.below(11);
        std::swap(pairs[first].on_fragment, pairs[first + 1].on_fragment);
        if ((pairs[first].on_template - pairs[first + 1].on_template).norm() < 0.8) continue;
        const FragmentPlacement placement = place_by_landmarks({pairs}).fragments[0];
        ASSERT_EQ(placement.swapped.size(), 1U) << seed;
        EXPECT_EQ(placement.swapped[0], std::pair(pairs[first].name, pairs[first + 1].name));
    }
}

// A shape that differs from the template's is not an error.
TEST(Placement, ProportionsOfAnotherMemberAreNotLeftOut) {
    Random random(9);
    const Motion pose = random_motion(random);
    auto pairs = landmarks(random, 9, 1, pose);
    const Motion inverse_pose = pose.inverse();
    for (LandmarkPair& pair : pairs) {
        Vector3d place = pair.on_template;
        place.z() *= place.z() > 0 ? 1.25 : 1;
        pair.on_fragment = inverse_pose(place);
    }
    const CommonPlacement placement = place_by_landmarks({pairs});
    for (const LandmarkResidual& landmark : placement.fragments[0].landmarks) EXPECT_TRUE(landmark.used);
    EXPECT_TRUE(placement.fragments[0].swapped.empty());
}

TEST(Placement, ReportsWhyAFragmentIsNotPlaced) {
    Random random(4);
    const Motion pose = random_motion(random);
    const auto good = landmarks(random, 5, 1, pose);
    const auto problem = [&](std::vector<LandmarkPair> pairs) {
        const CommonPlacement placement = place_by_landmarks({good, std::move(pairs), good});
        EXPECT_NEAR(placement.scale, 1, 1e-12) << "fragments that are not placed do not count";
        EXPECT_TRUE(placement.any());
        return placement.fragments[1].problem;
    };
    EXPECT_EQ(problem(good), "");
    EXPECT_NE(problem({}).find("0 landmarks"), std::string::npos);
    EXPECT_NE(problem({good[0], good[1]}).find("2 landmarks"), std::string::npos);
    auto line = good;
    for (std::size_t i = 0; i < line.size(); ++i) {
        line[i].on_template = Vector3d(1, 2, 3) + static_cast<double>(i) * Vector3d(1, 1, 0);
        line[i].on_fragment = pose.inverse()(line[i].on_template);
    }
    EXPECT_NE(problem(line).find("on a line"), std::string::npos);
    auto one_place = good;
    for (auto& pair : one_place) pair.on_template = pair.on_fragment = Vector3d(1, 1, 1);
    EXPECT_NE(problem(one_place).find("on a line"), std::string::npos);
    auto mirrored = good;
    for (auto& pair : mirrored) pair.on_fragment.x() *= -1;
    EXPECT_NE(problem(mirrored).find("mirror"), std::string::npos);
    auto inches = good;
    for (auto& pair : inches) pair.on_fragment /= 25.4;
    EXPECT_NE(problem(inches).find("another unit"), std::string::npos) << problem(inches);
    EXPECT_FALSE(place_by_landmarks({{}}).any());
    auto broken = good;
    broken[2].on_fragment.x() = std::nan("");
    EXPECT_THROW(place_by_landmarks({broken}), Error);
}

TEST(Placement, CommonLandmarksHaveAUniqueTagOnEitherSide) {
    const Mesh mesh = build_mesh(test::octahedron_sphere(1));
    const auto set_of = [](const std::vector<std::pair<std::string, Index>>& points) {
        AnnotationSet set;
        for (const auto& [tag, vertex] : points) {
            Annotation annotation;
            annotation.id = static_cast<int>(set.annotations.size());
            annotation.tag = tag;
            annotation.type = AnnotationType::point;
            annotation.points = {vertex};
            set.annotations.push_back(annotation);
        }
        return set;
    };
    std::vector<std::string> notes;
    const auto pairs = common_landmarks({mesh, set_of({{"nose", 0}, {"eye", 1}, {"eye", 2}, {"chin", 3}, {"Ear", 5}})},
                                        {mesh, set_of({{"chin", 5}, {"eye", 4}, {"nose", 3}, {"horn", 1}, {"ear", 2}})}, &notes);
    ASSERT_EQ(pairs.size(), 2U);
    EXPECT_EQ(pairs[0].name, "chin");
    EXPECT_EQ(pairs[1].name, "nose");
    EXPECT_EQ(pairs[1].on_template, Vector3d(1, 0, 0));
    EXPECT_EQ(pairs[1].on_fragment, Vector3d(0, -1, 0));
    ASSERT_EQ(notes.size(), 3U);
    EXPECT_NE(notes[0].find("'ear' is not on the template, which has 'Ear'"), std::string::npos);
    EXPECT_NE(notes[1].find("'eye' occurs more than once"), std::string::npos);
    EXPECT_NE(notes[2].find("'horn' is not on the template"), std::string::npos);
    AnnotationSet path = set_of({{"chin", 5}, {"nose", 3}});
    path.annotations[0].points.push_back(4);
    notes.clear();
    EXPECT_EQ(common_landmarks({mesh, set_of({{"nose", 0}, {"chin", 3}})}, {mesh, path}, &notes).size(), 1U);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("'chin' has several points"), std::string::npos);
}

}  // namespace
}  // namespace ostraka
