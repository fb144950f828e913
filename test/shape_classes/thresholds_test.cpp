#include "ostraka/shape_classes/thresholds.h"

#include "ostraka/core/error.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ostraka {
namespace {

std::vector<double> draws(Random& random, std::size_t count, double deviation = 1) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(random.normal(0, deviation));
    return values;
}

TEST(Predict, MatchesTheTabulatedStudentInterval) {
    // Student's t, 97.5 %, nine degrees of freedom: 2.26216; 95 %: 1.83311.
    const SampleMoments moments{10, 3, 4, 9};
    const PredictionInterval two_sided = predict(moments, false, 0.05);
    EXPECT_NEAR(two_sided.high, 3 + 2.26216 * 2 * std::sqrt(1.1), 1e-4);
    EXPECT_NEAR(two_sided.low, 3 - 2.26216 * 2 * std::sqrt(1.1), 1e-4);
    EXPECT_NEAR(predict(moments, true, 0.05).high, 3 + 1.83311 * 2 * std::sqrt(1.1), 1e-4);
    // The resolution widens it, also for identical values.
    EXPECT_NEAR(predict({10, 3, 0, 9}, true, 0.05, 0.5).high, 3 + 1.83311 * 0.5 * std::sqrt(1.1), 1e-4);
    EXPECT_EQ(predict({10, 3, 0, 9}, true, 0.05).high, 3);
    EXPECT_NEAR(predict({10, 3, 4, 1e9}, true, 0.05).high, predict({10, 3, 4, 1e5}, true, 0.05).high, 1e-4);
    EXPECT_THROW(static_cast<void>(predict({1, 3, 0, 0}, true, 0.05)), Error);
    EXPECT_THROW(static_cast<void>(predict(moments, true, 1)), Error);
}

TEST(Predict, RejectsAtTheGivenRateForAnySampleSize) {
    Random random(7);
    constexpr int rounds = 20000;
    for (const std::size_t count : {3, 4, 6, 20})
        for (const bool one_sided : {false, true}) {
            int refused = 0;
            for (int i = 0; i < rounds; ++i) {
                const PredictionInterval interval = predict(moments_of(draws(random, count)), one_sided, 0.05);
                const double x = random.normal();
                refused += x > interval.high || (!one_sided && x < interval.low) ? 1 : 0;
            }
            const double rate = static_cast<double>(refused) / rounds;
            EXPECT_NEAR(rate, 0.05, 5 * std::sqrt(0.05 * 0.95 / rounds)) << count << " known";
        }
}

TEST(VariancePrior, EqualVariancesArePooledAndOthersAreNot) {
    Random random(11);
    std::vector<SampleMoments> equal, spread;
    for (int i = 0; i < 400; ++i) {
        equal.push_back(moments_of(draws(random, 4, 0.3)));
        // Variances from a scaled inverse chi-squared distribution of four degrees of freedom about 0.09.
        double chi = 0;
        for (int k = 0; k < 4; ++k) {
            const double z = random.normal();
            chi += z * z;
        }
        spread.push_back(moments_of(draws(random, 4, 0.3 * std::sqrt(4 / chi))));
    }
    const auto same = variance_prior(equal), other = variance_prior(spread);
    ASSERT_TRUE(same && other);
    EXPECT_NEAR(std::sqrt(same->variance), 0.3, 0.02);
    EXPECT_GT(same->freedom, 20);
    EXPECT_NEAR(std::sqrt(other->variance), 0.3, 0.04);
    EXPECT_NEAR(other->freedom, 4, 1.5);
    // Between its own variance and that of all, and never with less freedom than it has.
    const SampleMoments sample{4, 1, 1, 3}, moderated = other->moderate(sample);
    EXPECT_LT(moderated.variance, 1);
    EXPECT_GT(moderated.variance, other->variance);
    EXPECT_GT(moderated.freedom, 3);
    EXPECT_EQ(moderated.mean, 1);
    EXPECT_FALSE(variance_prior(std::vector<SampleMoments>(2, sample)).has_value());
    EXPECT_FALSE(variance_prior(std::vector<SampleMoments>(5, {4, 1, 0, 3})).has_value()) << "nothing varies";
    const auto equal_variances = variance_prior(std::vector<SampleMoments>(5, sample));
    ASSERT_TRUE(equal_variances.has_value());
    EXPECT_TRUE(std::isinf(equal_variances->freedom));
    EXPECT_TRUE(std::isfinite(predict(equal_variances->moderate(sample), true, 0.05).high));
}

}  // namespace
}  // namespace ostraka
