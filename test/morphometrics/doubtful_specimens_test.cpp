#include "ostraka/morphometrics/doubtful_specimens.h"

#include "ostraka/interchange/landmarks.h"
#include "samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

namespace ostraka {
namespace {

using test::random_sample;

/// The specimens with an error that explains them; without those that are merely far from the mean, as some of any sample are.
std::vector<Doubt> errors_of(const ShapeSample& sample) {
    std::vector<Doubt> doubts = doubtful_specimens(sample);
    std::erase_if(doubts, [](const Doubt& doubt) { return doubt.cause == DoubtCause::unexplained; });
    return doubts;
}

TEST(DoubtfulSpecimens, OneErrorIsNamed) {
    for (const int dimension : {2, 3}) {
        const ShapeSample clean = random_sample(11, 20, 12, dimension, 0.05);
        EXPECT_TRUE(errors_of(clean).empty()) << dimension;
        ShapeSample exchanged = clean;
        exchanged.configurations[4].row(2).swap(exchanged.configurations[4].row(9));
        auto doubts = errors_of(exchanged);
        ASSERT_EQ(doubts.size(), 1U);
        EXPECT_EQ(doubts[0].specimen, 4U);
        EXPECT_EQ(doubts[0].cause, DoubtCause::exchanged);
        EXPECT_EQ(doubts[0].landmarks, (std::vector<std::size_t>{2, 9}));
        EXPECT_LT(doubts[0].corrected, 0.3 * doubts[0].distance);
        ShapeSample mirrored = clean;
        mirrored.configurations[7].col(0) *= -1;
        doubts = errors_of(mirrored);
        ASSERT_EQ(doubts.size(), 1U);
        EXPECT_EQ(doubts[0].specimen, 7U);
        EXPECT_EQ(doubts[0].cause, DoubtCause::mirrored);
        ShapeSample displaced = clean;
        displaced.configurations[0].row(5) +=
            Eigen::RowVector3d(1, dimension == 2 ? 1 : 0, dimension == 3 ? 1 : 0) * 0.5 * centroid_size(clean.configurations[0]);
        doubts = errors_of(displaced);
        ASSERT_EQ(doubts.size(), 1U);
        EXPECT_EQ(doubts[0].cause, DoubtCause::displaced);
        EXPECT_EQ(doubts[0].landmarks, (std::vector<std::size_t>{5}));
        ShapeSample other = clean;
        other.configurations[19] = random_sample(99, 1, 12, dimension, 0).configurations[0];
        doubts = doubtful_specimens(other);
        const auto is_other = [](const Doubt& doubt) { return doubt.specimen == 19 && doubt.cause == DoubtCause::unexplained; };
        EXPECT_EQ(std::count_if(doubts.begin(), doubts.end(), is_other), 1);
    }
    ShapeSample few = random_sample(11, 4, 12, 3, 0.05);
    few.configurations[0].col(0) *= -1;
    EXPECT_TRUE(doubtful_specimens(few).empty()) << "four specimens are no sample";
}

TEST(DoubtfulSpecimens, SeveralErrorsDoNotHideEachOther) {
    ShapeSample sample = random_sample(3, 30, 15, 3, 0.06);
    for (const auto& [specimen, a, b] : {std::tuple{2, 0, 7}, {11, 3, 4}, {20, 0, 7}, {21, 9, 14}})
        sample.configurations[static_cast<std::size_t>(specimen)].row(a).swap(
            sample.configurations[static_cast<std::size_t>(specimen)].row(b));
    const auto doubts = doubtful_specimens(sample);
    ASSERT_EQ(doubts.size(), 4U);
    for (const Doubt& doubt : doubts) EXPECT_EQ(doubt.cause, DoubtCause::exchanged);
    EXPECT_EQ(doubts[2].landmarks, (std::vector<std::size_t>{0, 7}));
}

TEST(DoubtfulSpecimens, ExchangedLandmarksOfSkullsAreNamed) {
    const Path folder = Path(OSTRAKA_SHARED_DATA) / "landmarks-mouse-skulls" / "LMs";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder.string();
    ShapeSample sample;
    for (const std::string& name : files_in(folder)) {
        const LandmarkSet set = read_landmarks(folder / name, LandmarkFormat::mrk);
        Landmarks x(static_cast<Eigen::Index>(set.landmarks.size()), 3);
        for (std::size_t k = 0; k < set.landmarks.size(); ++k)
            x.row(static_cast<Eigen::Index>(k)) << set.landmarks[k].position[0], set.landmarks[k].position[1],
                set.landmarks[k].position[2];
        sample.specimens.push_back(name);
        sample.configurations.push_back(x);
    }
    for (Eigen::Index k = 0; k < sample.configurations[0].rows(); ++k) sample.landmarks.push_back(std::to_string(k + 1));
    int clean = 0;
    for (const Doubt& doubt : doubtful_specimens(sample)) clean += doubt.cause == DoubtCause::exchanged ? 1 : 0;
    EXPECT_EQ(clean, 0) << "no exchange is named in the data as they are";
    Random random(1);
    int named = 0;
    const int draws = 40;
    for (int draw = 0; draw < draws; ++draw) {
        ShapeSample changed = sample;
        const std::size_t s = random.below(sample.specimens.size()), a = random.below(sample.landmarks.size());
        std::size_t b = random.below(sample.landmarks.size() - 1);
        b += b >= a ? 1 : 0;
        changed.configurations[s]
            .row(static_cast<Eigen::Index>(a))
            .swap(changed.configurations[s].row(static_cast<Eigen::Index>(b)));
        for (const Doubt& doubt : doubtful_specimens(changed))
            named += doubt.specimen == s && doubt.cause == DoubtCause::exchanged &&
                             doubt.landmarks == std::vector<std::size_t>{std::min(a, b), std::max(a, b)}
                         ? 1
                         : 0;
    }
    EXPECT_GE(named, 38) << "of " << draws;
}

}  // namespace
}  // namespace ostraka
