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

/// Landmarks of a template that is `scale` times as large in truth, on a fragment that `pose` would carry back.
std::vector<LandmarkPair> landmarks(Random& random, int count, double scale, const Motion& pose, double noise = 0) {
    std::vector<LandmarkPair> pairs;
    const Motion there = pose.inverse();
    for (int i = 0; i < count; ++i) {
        const Vector3d place = random_place(random);
        pairs.push_back({"landmark " + std::to_string(i), place, there(scale * place + noise * random_place(random))});
    }
    return pairs;
}

TEST(Placement, FindsOneScaleAndThePoseOfEachFragment) {
    for (const double scale : {1.0, 0.01, 250.0}) {
        Random random(3);
        const Motion first = random_motion(random), second = random_motion(random);
        const CommonPlacement found =
            place_by_landmarks({landmarks(random, 4, scale, first), landmarks(random, 7, scale, second)});
        EXPECT_NEAR(found.scale, scale, 1e-12 * scale);
        for (const auto& [one, pose] : {std::pair(found.fragments[0], first), std::pair(found.fragments[1], second)}) {
            EXPECT_EQ(one.problem, "");
            EXPECT_LT((one.pose.rotation - pose.rotation).norm(), 1e-12);
            EXPECT_LT((one.pose.translation - pose.translation).norm(), 1e-11 * (1 + scale));
            EXPECT_EQ(one.pose.scale, 1);
            EXPECT_NEAR(one.own_scale, scale, 1e-11 * scale);
            EXPECT_LT(one.residual, 1e-11 * (1 + scale));
        }
    }
}

// The sum of squares over scale and poses can only grow by going elsewhere.
TEST(Placement, IsTheLeastSumOfSquares) {
    Random random(5);
    const std::vector<std::vector<LandmarkPair>> pairs{landmarks(random, 4, 2, random_motion(random), 0.1),
                                                       landmarks(random, 4, 2, random_motion(random), 0.1)};
    const CommonPlacement found = place_by_landmarks(pairs);
    const auto cost = [&](double scale, const std::vector<Motion>& poses) {
        double sum = 0;
        for (std::size_t k = 0; k < 2; ++k)
            for (const LandmarkPair& pair : pairs[k])
                sum += (poses[k](pair.on_fragment) - scale * pair.on_template).squaredNorm();
        return sum;
    };
    const std::vector<Motion> best{found.fragments[0].pose, found.fragments[1].pose};
    const double minimum = cost(found.scale, best);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<Motion> other = best;
        for (Motion& pose : other) {
            const Vector3d axis = random_place(random).normalized();
            Motion step;
            step.rotation = Eigen::AngleAxisd(0.01 * random.normal(), axis).toRotationMatrix();
            step.translation = 0.01 * random_place(random);
            pose = step.after(pose);
        }
        EXPECT_GE(cost(found.scale * (1 + 0.01 * random.normal()), other), minimum);
    }
}

TEST(Placement, OneWrongPairInSixIsFound) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        const Motion pose = random_motion(random);
        auto pairs = landmarks(random, 6, 1, pose, 0.01);
        const std::size_t wrong = random.below(6);
        pairs[wrong].on_fragment = pose.inverse()(pairs[wrong].on_template + 1.5 * random_place(random).normalized());
        const CommonPlacement found = place_by_landmarks({pairs});
        for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(found.fragments[0].landmarks[i].used, i != wrong) << seed << ' ' << i;
        EXPECT_LT((found.fragments[0].pose.rotation - pose.rotation).norm(), 0.1);
    }
}

TEST(Placement, ExchangedTagsAreNamed) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        auto pairs = landmarks(random, 12, 1, random_motion(random), 0.01);
        const std::size_t first = random.below(11);
        std::swap(pairs[first].on_fragment, pairs[first + 1].on_fragment);
        if ((pairs[first].on_template - pairs[first + 1].on_template).norm() < 0.8) continue;
        const FragmentPlacement found = place_by_landmarks({pairs}).fragments[0];
        ASSERT_EQ(found.swapped.size(), 1U) << seed;
        EXPECT_EQ(found.swapped[0], std::pair(pairs[first].name, pairs[first + 1].name));
    }
}

// Another shape than the template's is no mistake.
TEST(Placement, ProportionsOfAnotherMemberAreNotLeftOut) {
    Random random(9);
    const Motion pose = random_motion(random);
    auto pairs = landmarks(random, 9, 1, pose);
    const Motion there = pose.inverse();
    for (LandmarkPair& pair : pairs) {
        Vector3d place = pair.on_template;
        place.z() *= place.z() > 0 ? 1.25 : 1;
        pair.on_fragment = there(place);
    }
    const CommonPlacement found = place_by_landmarks({pairs});
    for (const LandmarkResidual& landmark : found.fragments[0].landmarks) EXPECT_TRUE(landmark.used);
    EXPECT_TRUE(found.fragments[0].swapped.empty());
}

TEST(Placement, SaysWhyAFragmentIsNotPlaced) {
    Random random(4);
    const Motion pose = random_motion(random);
    const auto good = landmarks(random, 5, 1, pose);
    const auto problem = [&](std::vector<LandmarkPair> pairs) {
        const CommonPlacement found = place_by_landmarks({good, std::move(pairs), good});
        EXPECT_NEAR(found.scale, 1, 1e-12) << "who is not placed does not count";
        EXPECT_TRUE(found.any());
        return found.fragments[1].problem;
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

TEST(Placement, CommonLandmarksAreThoseOfOneTagOnEitherSide) {
    const Mesh mesh = build_mesh(test::octahedron_sphere(1));
    const auto set_of = [](const std::vector<std::pair<std::string, Index>>& points) {
        AnnotationSet set;
        for (const auto& [tag, vertex] : points) {
            Annotation one;
            one.id = static_cast<int>(set.annotations.size());
            one.tag = tag;
            one.type = AnnotationType::point;
            one.points = {vertex};
            set.annotations.push_back(one);
        }
        return set;
    };
    std::vector<std::string> notes;
    const auto pairs = common_landmarks(mesh, set_of({{"nose", 0}, {"eye", 1}, {"eye", 2}, {"chin", 3}, {"Ear", 5}}), mesh,
                                        set_of({{"chin", 5}, {"eye", 4}, {"nose", 3}, {"horn", 1}, {"ear", 2}}), &notes);
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
    EXPECT_EQ(common_landmarks(mesh, set_of({{"nose", 0}, {"chin", 3}}), mesh, path, &notes).size(), 1U);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("'chin' has several points"), std::string::npos);
}

}  // namespace
}  // namespace ostraka
