#include "ostraka/stats/summary.h"

#include "ostraka/core/error.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace ostraka {
namespace {

TEST(Summary, OfNumbersByHand) {
    const Summary s = summarise({2, 4, 4, 4, 5, 5, 7, 9});
    EXPECT_EQ(s.count, 8u);
    EXPECT_DOUBLE_EQ(s.mean, 5);
    EXPECT_DOUBLE_EQ(*s.standard_deviation, std::sqrt(32.0 / 7));
    EXPECT_DOUBLE_EQ(*s.coefficient_of_variation, std::sqrt(32.0 / 7) / 5);
    EXPECT_EQ(s.median, 4.5);
    EXPECT_EQ(s.min, 2);
    EXPECT_EQ(s.max, 9);
}

TEST(Summary, HandlesSingleAndEqualValues) {
    const Summary single_value = summarise({3});
    EXPECT_EQ(single_value.mean, 3);
    EXPECT_EQ(single_value.median, 3);
    EXPECT_FALSE(single_value.standard_deviation);
    EXPECT_FALSE(single_value.coefficient_of_variation);
    const Summary same = summarise({0.1, 0.1, 0.1});
    EXPECT_EQ(same.mean, 0.1);
    EXPECT_EQ(*same.standard_deviation, 0);
    EXPECT_EQ(*same.coefficient_of_variation, 0);
    EXPECT_FALSE(summarise({-1, 1}).coefficient_of_variation) << "no coefficient of variation about 0";
    EXPECT_DOUBLE_EQ(*summarise({-1, -3}).coefficient_of_variation, std::sqrt(2.0) / 2) << "of the magnitude of the mean";
}

TEST(Summary, ScalesAndShifts) {
    const std::vector<double> values{1.5, -2, 8, 0.25, 3, 3};
    const Summary original = summarise(values);
    for (const double scale : {0x1p-900, 0x1p-300, 0x1p600, 0x1p1000}) {
        std::vector<double> scaled = values;
        for (double& v : scaled) v *= scale;
        const Summary s = summarise(scaled);
        EXPECT_NEAR(s.mean / scale, original.mean, 1e-14 * 8);
        EXPECT_NEAR(*s.standard_deviation / scale, *original.standard_deviation, 1e-14 * 8);
    }
    std::vector<double> distant = values;
    for (double& v : distant) v += 0x1p40;
    EXPECT_NEAR(*summarise(distant).standard_deviation, *original.standard_deviation, 1e-12)
        << "values are multiples of 1/4: nothing is lost";
    const double huge = std::numeric_limits<double>::max();
    EXPECT_TRUE(std::isfinite(*summarise({-huge / 2, huge / 2}).standard_deviation));
}

TEST(Summary, DoesNotDependOnTheOrder) {
    std::vector<double> values;
    Random random(3);
    for (int i = 0; i < 1000; ++i) values.push_back(random.normal(10, 3));
    const Summary first = summarise(values);
    for (int trial = 0; trial < 5; ++trial) {
        random.shuffle(values);
        EXPECT_EQ(summarise(values).mean, first.mean);
        EXPECT_EQ(*summarise(values).standard_deviation, *first.standard_deviation);
    }
}

TEST(Summary, RefusesEmptyAndNonFiniteSamples) {
    EXPECT_THROW(summarise({}), Error);
    EXPECT_THROW(summarise({1, std::nan("")}), Error);
    EXPECT_THROW(summarise({1, std::numeric_limits<double>::infinity()}), Error);
    EXPECT_THROW(sample_quantile({1, 2}, 1.1), Error);
    EXPECT_THROW(sample_quantile({1, 2}, std::nan("")), Error);
    EXPECT_THROW(sample_quantile({}, 0.5), Error);
    try {
        summarise({1, std::nan("")}, "arm length");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.where(), "arm length");
        EXPECT_NE(error.problem().find("value 1"), std::string::npos);
    }
}

TEST(Summary, QuantilesAreInterpolated) {
    // Type 7 of four values: at 1 + 3 share.
    EXPECT_DOUBLE_EQ(sample_quantile({4, 1, 3, 2}, 0.25), 1.75);
    EXPECT_DOUBLE_EQ(sample_quantile({4, 1, 3, 2}, 0.5), 2.5);
    EXPECT_EQ(sample_quantile({4, 1, 3, 2}, 0), 1);
    EXPECT_EQ(sample_quantile({4, 1, 3, 2}, 1), 4);
    EXPECT_EQ(sample_quantile({7}, 0.3), 7);
}

TEST(Summary, WeightedOnesAgreeWithRepeatedValues) {
    const Statistics weighted = statistics({1, 2, 5}, {1, 3, 2}),
                     repeated = statistics({1, 2, 2, 2, 5, 5}, std::vector<double>(6, 1.0));
    EXPECT_DOUBLE_EQ(weighted.mean, repeated.mean);
    EXPECT_DOUBLE_EQ(weighted.deviation, repeated.deviation);
    EXPECT_EQ(weighted.median, repeated.median);
    EXPECT_EQ(weighted.percentile_95, repeated.percentile_95);
    EXPECT_EQ(quantile({1, 2, 5}, {1, 3, 2}, 0.5), 2);
}

TEST(UpperMedian, OfOddAndEvenNumbers) {
    EXPECT_EQ(upper_median({4}), 4);
    EXPECT_EQ(upper_median({9, 1, 5}), 5);
    EXPECT_EQ(upper_median({9, 1, 5, 2}), 5) << "the upper one of 2 and 5";
    EXPECT_EQ(upper_median({3, 3, 3, -1}), 3);
}

TEST(RandomNumbers, OfACounterAreFixed) {
    EXPECT_EQ(random_share(0, 0), 0x1.3faa35593b596p-1);
    EXPECT_EQ(random_share(7, 1000000), 0x1.a48826bfb959ap-1);
    EXPECT_EQ(random_share(~0ULL, ~0ULL), 0x1.2a0bb911f81e2p-1);
    double sum = 0;
    for (std::uint64_t i = 0; i < 10000; ++i) sum += random_share(3, i);
    EXPECT_NEAR(sum / 10000, 0.5, 4 / std::sqrt(12.0 * 10000));
}

TEST(RandomNumbers, MatchTheStandardEngine) {
    // The engine's numbers are fixed by the standard; these laws would not hold if draws were mapped badly.
    Random random(42);
    double sum = 0, square = 0, cube = 0;
    const int count = 200000;
    for (int i = 0; i < count; ++i) {
        const double x = random.normal();
        sum += x, square += x * x, cube += x * x * x;
    }
    // Four standard errors.
    EXPECT_NEAR(sum / count, 0, 4 / std::sqrt(count));
    EXPECT_NEAR(square / count, 1, 4 * std::sqrt(2.0 / count));
    EXPECT_NEAR(cube / count, 0, 4 * std::sqrt(15.0 / count));
    std::vector<int> hits(7);
    for (int i = 0; i < 70000; ++i) ++hits[random.below(7)];
    for (const int h : hits) EXPECT_NEAR(h, 10000, 4 * 93);
    for (int i = 0; i < 1000; ++i) {
        const double u = random.uniform(-2, 3);
        EXPECT_GE(u, -2);
        EXPECT_LT(u, 3);
    }
    EXPECT_EQ(random.below(1), 0u);
}

TEST(RandomNumbers, StreamsDifferAndRepeat) {
    EXPECT_EQ(Random(1, 2).bits(), Random(1, 2).bits());
    EXPECT_NE(Random(1, 2).bits(), Random(2, 1).bits());
    EXPECT_NE(Random(1, 0).bits(), Random(0, 1).bits());
    const std::vector<std::size_t> order = Random(5).permutation(50);
    std::vector<std::size_t> sorted = order, expected(50);
    std::iota(expected.begin(), expected.end(), std::size_t{0});
    EXPECT_NE(order, expected);
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, expected);
    EXPECT_TRUE(Random(5).permutation(0).empty());
    for (const std::size_t i : Random(5).resample(9)) EXPECT_LT(i, 9u);
}

}  // namespace
}  // namespace ostraka
