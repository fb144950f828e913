#include "ostraka/morphometrics/missing_landmarks.h"

#include "ostraka/core/error.h"
#include "samples.h"

#include <gtest/gtest.h>

#include <limits>

namespace ostraka {
namespace {

using test::moved;
using test::random_configuration;
using test::random_sample;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

TEST(MissingLandmarks, LeavingOutNamesEveryOne) {
    ShapeSample sample = random_sample(1, 5, 6, 3, 0.1);
    sample.configurations[1].row(2).setConstant(none);
    sample.configurations[4].row(2).setConstant(none);
    sample.configurations[4].row(5).setConstant(none);
    const CompletedSample completed = complete_landmarks(sample, MissingMethod::leave_out);
    EXPECT_EQ(completed.sample.landmarks, (std::vector<std::string>{"L1", "L2", "L4", "L5"}));
    ASSERT_EQ(completed.missing.size(), 3U);
    EXPECT_EQ(completed.missing[2].specimen, 4U);
    EXPECT_EQ(completed.missing[2].landmark, 5U);
    EXPECT_EQ(completed.missing[2].how, "left out");
    EXPECT_TRUE(is_complete(completed.sample.configurations[4]));
}

TEST(MissingLandmarks, SplineIsExactForAffineImagesOfTheMean) {
    for (const int dimension : {2, 3}) {
        Random random(2);
        ShapeSample sample = random_sample(7, 1, 9, dimension, 0);
        for (int s = 0; s < 4; ++s) {
            sample.specimens.push_back("copy");
            sample.configurations.push_back(moved(sample.configurations[0], random, dimension));
        }
        Eigen::Matrix3d a = Eigen::Matrix3d::Identity();
        a(0, 1) = 0.3, a(0, 0) = 1.4;
        const Landmarks truth = sample.configurations[0] * a.transpose();
        sample.specimens.push_back("broken");
        sample.configurations.push_back(truth);
        sample.configurations.back().row(3).setConstant(none);
        sample.configurations.back().row(8).setConstant(none);
        const CompletedSample completed = complete_landmarks(sample, MissingMethod::tps);
        EXPECT_LT((completed.sample.configurations.back() - truth).norm(), 1e-7 * truth.norm()) << dimension;
        ASSERT_EQ(completed.missing.size(), 2U);
        EXPECT_EQ(completed.missing[1].landmark, 8U);
        EXPECT_EQ(completed.missing[1].how, "tps");
    }
}

TEST(MissingLandmarks, RegressionFollowsTheVariationOfTheCompleteSpecimens) {
    Random random(4);
    const Landmarks mean = random_configuration(random, 10, 3), mode = random_configuration(random, 10, 3, 0.1);
    ShapeSample sample;
    for (int k = 0; k < 10; ++k) sample.landmarks.push_back(std::to_string(k));
    for (int s = 0; s < 20; ++s) {
        sample.specimens.push_back(std::to_string(s));
        sample.configurations.push_back(moved(mean + random.normal() * mode, random, 3));
    }
    const Landmarks truth = sample.configurations[6];
    sample.configurations[6].row(0).setConstant(none);
    const auto error = [&](MissingMethod method) {
        return (complete_landmarks(sample, method).sample.configurations[6] - truth).norm() / centroid_size(truth);
    };
    EXPECT_LT(error(MissingMethod::regression), 0.2 * error(MissingMethod::tps)) << "the mode moves the missing landmark";
    sample.configurations.resize(4);
    sample.specimens.resize(4);
    sample.configurations[3].row(0).setConstant(none);
    EXPECT_THROW(error(MissingMethod::regression), Error) << "three complete specimens";
}

TEST(MissingLandmarks, MirrorUsesTheOtherSide) {
    Random random(9);
    ShapeSample sample;
    sample.landmarks = {"left eye", "right eye", "left ear", "right ear", "nose", "chin", "crown"};
    const LandmarkPairs pairs = pairs_by_name(sample.landmarks);
    ASSERT_EQ(pairs.pairs.size(), 2U);
    EXPECT_EQ(pairs.pairs[1], (std::array<std::size_t, 2>{2, 3}));
    Landmarks face(7, 3);
    face << 1, 2, 0, -1, 2, 0, 3, 1, -2, -3, 1, -2, 0, 0, 2, 0, -3, 1, 0, 5, -1;
    EXPECT_LT((relabelled_mirror(face, pairs) - face).norm(), 1e-12);
    for (int s = 0; s < 3; ++s) {
        sample.specimens.push_back(std::to_string(s));
        sample.configurations.push_back(moved(face, random, 3));
    }
    const Landmarks truth = sample.configurations[1];
    sample.configurations[1].row(2).setConstant(none);
    sample.configurations[1].row(5).setConstant(none);
    const CompletedSample completed = complete_landmarks(sample, MissingMethod::mirror, pairs);
    EXPECT_LT((completed.sample.configurations[1] - truth).norm(), 1e-8 * truth.norm());
    ASSERT_EQ(completed.missing.size(), 2U);
    EXPECT_EQ(completed.missing[0].how, "mirror");
    EXPECT_EQ(completed.missing[1].how, "tps") << "a landmark of the midline has no counterpart";
    EXPECT_THROW(complete_landmarks(sample, MissingMethod::mirror), Error) << "no pairs";
    EXPECT_THROW(relabelled_mirror(face, {{{0, 1}, {1, 2}}}), Error);
    EXPECT_THROW(relabelled_mirror(face, {{{0, 9}}}), Error);
}

TEST(MissingLandmarks, TooFewLandmarksAreRefusedByName) {
    ShapeSample sample = random_sample(1, 3, 6, 3, 0.1);
    for (int k = 0; k < 3; ++k) sample.configurations[1].row(k).setConstant(none);
    try {
        complete_landmarks(sample, MissingMethod::tps);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.where(), "s2");
    }
    for (Landmarks& x : sample.configurations) x.row(0).setConstant(none);
    EXPECT_THROW(complete_landmarks(sample, MissingMethod::tps), Error) << "no complete specimen";
    for (int k = 0; k < 4; ++k) sample.configurations[0].row(k).setConstant(none);
    EXPECT_THROW(complete_landmarks(sample, MissingMethod::leave_out), Error) << "two landmarks are left";
}

}  // namespace
}  // namespace ostraka
