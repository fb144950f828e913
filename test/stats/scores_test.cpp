#include "ostraka/stats/scores.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/inference.h"
#include "ostraka/stats/random.h"
#include "ostraka/stats/summary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace ostraka {
namespace {

TEST(AdjustedRandIndex, KnownExamples) {
    EXPECT_EQ(adjusted_rand_index({0, 0, 1, 1}, {5, 5, 2, 2}), 1) << "names do not matter";
    // Pairs: 1 together in both, 1 in the labels, 2 in the truth, of 6: (1 - 2/6) / (3/2 - 2/6).
    EXPECT_DOUBLE_EQ(adjusted_rand_index({0, 0, 1, 2}, {0, 0, 1, 1}), 4.0 / 7);
    EXPECT_DOUBLE_EQ(adjusted_rand_index({0, 0, 1, 1}, {0, 1, 0, 1}), -0.5);
    EXPECT_EQ(adjusted_rand_index({0, 0, 0, 0}, {0, 1, 2, 3}), 0);
    // Hubert and Arabie's contingency table as in Yeung and Ruzzo (2001): 0.313.
    std::vector<int> u, v;
    const int table[3][3] = {{1, 1, 0}, {1, 2, 1}, {0, 0, 4}};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < table[i][j]; ++k) u.push_back(i), v.push_back(j);
    EXPECT_NEAR(adjusted_rand_index(u, v), 0.313, 5e-4);
}

TEST(AdjustedRandIndex, OfTrivialGroupings) {
    EXPECT_EQ(adjusted_rand_index({0}, {3}), 1);
    EXPECT_EQ(adjusted_rand_index({1, 1, 1}, {2, 2, 2}), 1);
    EXPECT_EQ(adjusted_rand_index({0, 1, 2}, {2, 0, 1}), 1);
    EXPECT_EQ(adjusted_rand_index({-1, -1, -1}, {2, 0, 1}), 1) << "noise counts as groups of one";
    EXPECT_LT(adjusted_rand_index({-1, -1, 1, 1}, {0, 0, 1, 1}), 1);
    EXPECT_THROW(adjusted_rand_index({}, {}), Error);
    EXPECT_THROW(adjusted_rand_index({0}, {0, 1}), Error);
}

TEST(AdjustedRandIndex, OfChanceIsNearZero) {
    Random random(4);
    double sum = 0;
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<int> a, b;
        for (int i = 0; i < 60; ++i)
            a.push_back(static_cast<int>(random.below(4))), b.push_back(static_cast<int>(random.below(3)));
        sum += adjusted_rand_index(a, b);
    }
    EXPECT_NEAR(sum / 200, 0, 0.01);
}

TEST(Confusion, ByHand) {
    const ConfusionScores s = confusion({true, true, true, false, false, false}, {true, true, false, true, false, false});
    EXPECT_EQ(s.true_positive, 2u);
    EXPECT_EQ(s.false_positive, 1u);
    EXPECT_EQ(s.false_negative, 1u);
    EXPECT_EQ(s.true_negative, 2u);
    EXPECT_DOUBLE_EQ(s.precision(), 2.0 / 3);
    EXPECT_DOUBLE_EQ(s.recall(), 2.0 / 3);
    EXPECT_DOUBLE_EQ(s.f1(), 2.0 / 3);
    EXPECT_DOUBLE_EQ(s.accuracy(), 4.0 / 6);
    EXPECT_EQ(confusion({false}, {false}).f1(), 0);
    EXPECT_THROW(confusion({true}, {}), Error);
}

TEST(Roc, PerfectReversedAndTied) {
    EXPECT_EQ(roc_curve({1, 2, 3, 4}, {false, false, true, true}).area, 1);
    EXPECT_EQ(roc_curve({4, 3, 2, 1}, {false, false, true, true}).area, 0);
    const RocCurve tied = roc_curve({1, 1, 1, 1}, {false, true, false, true});
    EXPECT_EQ(tied.area, 0.5);
    ASSERT_EQ(tied.points.size(), 2u);
    EXPECT_EQ(tied.points.back().true_positive_rate, 1);
    EXPECT_EQ(tied.points.back().false_positive_rate, 1);
}

TEST(Roc, ByHandWithTies) {
    // Positives 3, 2, 2; negatives 2, 1: pairs won 1+1, 0.5+1, 0.5+1 of 6.
    const RocCurve curve = roc_curve({3, 2, 2, 2, 1}, {true, true, true, false, false});
    EXPECT_DOUBLE_EQ(curve.area, 5.0 / 6);
    ASSERT_EQ(curve.points.size(), 4u);
    EXPECT_TRUE(std::isinf(curve.points[0].threshold));
    EXPECT_EQ(curve.points[1].threshold, 3);
    EXPECT_DOUBLE_EQ(curve.points[1].true_positive_rate, 1.0 / 3);
    EXPECT_EQ(curve.points[1].false_positive_rate, 0);
    EXPECT_EQ(curve.points[2].true_positive_rate, 1);
    EXPECT_DOUBLE_EQ(curve.points[2].false_positive_rate, 0.5);
}

TEST(Roc, NeedsBothClasses) {
    EXPECT_THROW(roc_curve({1, 2}, {true, true}), Error);
    EXPECT_THROW(roc_curve({1, 2}, {false, false}), Error);
    EXPECT_THROW(roc_curve({}, {}), Error);
    EXPECT_THROW(roc_curve({1, std::nan("")}, {true, false}), Error);
    EXPECT_THROW(roc_curve({1}, {true, false}), Error);
}

TEST(BestThreshold, LiesInTheMiddleOfTheWidestGap) {
    const Threshold t = best_threshold({1, 2, 8, 9}, {false, false, true, true});
    EXPECT_EQ(t.value, 5);
    EXPECT_TRUE(t.above);
    EXPECT_EQ(t.scores.f1(), 1);
    const Threshold below = best_threshold({1, 2, 8, 9}, {true, true, false, false}, Side::below);
    EXPECT_EQ(below.value, 5);
    EXPECT_FALSE(below.above);
    EXPECT_EQ(below.scores.f1(), 1);
    const Threshold either = best_threshold({1, 2, 8, 9}, {true, true, false, false}, Side::either);
    EXPECT_FALSE(either.above);
    EXPECT_EQ(either.scores.f1(), 1);
}

TEST(BestThreshold, HandlesTiesAndTheWrongSide) {
    // All equal: classifying all as positive is optimal.
    const Threshold same = best_threshold({3, 3, 3}, {true, false, true});
    EXPECT_DOUBLE_EQ(same.scores.f1(), 0.8);
    EXPECT_TRUE(same.positive(3));
    // Positives have the small values: for thresholds from above, classifying all as positive is optimal.
    const Threshold wrong = best_threshold({1, 2, 8, 9}, {true, true, false, false});
    EXPECT_DOUBLE_EQ(wrong.scores.f1(), 2.0 / 3);
    EXPECT_TRUE(wrong.positive(1));
}

TEST(BestThreshold, IsTheBestOfAll) {
    Random random(8);
    for (int trial = 0; trial < 50; ++trial) {
        std::vector<double> values;
        std::vector<bool> truth;
        for (int i = 0; i < 20; ++i) {
            truth.push_back(i % 3 == 0);
            values.push_back(std::floor(random.normal() * 4) + (truth.back() ? 3 : 0));
        }
        for (const Side side : {Side::above, Side::below, Side::either}) {
            const Threshold best = best_threshold(values, truth, side);
            std::vector<bool> predictions;
            for (const double v : values) predictions.push_back(best.positive(v));
            EXPECT_EQ(confusion(predictions, truth).f1(), best.scores.f1()) << "the counts are those of the rule";
            for (const double at : values)
                for (const bool above : {true, false}) {
                    if ((side == Side::above && !above) || (side == Side::below && above)) continue;
                    std::vector<bool> other;
                    for (const double v : values) other.push_back(above ? v >= at : v <= at);
                    EXPECT_LE(confusion(other, truth).f1(), best.scores.f1());
                }
        }
    }
}

TEST(CrossValidation, EverySampleIsTestedOncePerRepeatAndNeverTrainedOn) {
    std::vector<bool> truth(23);
    for (std::size_t i = 0; i < truth.size(); ++i) truth[i] = i < 7;
    const CrossValidation validation =
        cross_validate(truth,
                       [&](const auto& training, const auto& test) {
                           std::set<std::size_t> both_sets(training.begin(), training.end());
                           both_sets.insert(test.begin(), test.end());
                           if (both_sets.size() != truth.size() || training.size() + test.size() != truth.size())
                               throw std::logic_error("not a division");
                           const auto positives = std::count_if(test.begin(), test.end(), [&](auto i) { return truth[i]; });
                           if (positives < 1 || positives > 2) throw std::logic_error("not stratified");
                           std::vector<bool> predictions;
                           for (const auto i : test) predictions.push_back(truth[i]);
                           return predictions;
                       },
                       {.folds = 5, .repeats = 8});
    EXPECT_EQ(validation.mean_f1, 1);
    EXPECT_EQ(validation.deviation, 0);
    EXPECT_EQ(validation.f1.size(), 8u);
    EXPECT_EQ(validation.first.count(), truth.size());
    EXPECT_EQ(validation.positive[0], 1);
    EXPECT_EQ(validation.positive[22], 0);
}

/// Answers of the best threshold, one value per sample.
Learner by_threshold(const std::vector<double>& values, const std::vector<bool>& truth) {
    return [&](const std::vector<std::size_t>& training, const std::vector<std::size_t>& test) {
        std::vector<double> v;
        std::vector<bool> t, answers;
        for (const std::size_t i : training) v.push_back(values[i]), t.push_back(truth[i]);
        const Threshold threshold = best_threshold(v, t);
        for (const std::size_t i : test) answers.push_back(threshold.positive(values[i]));
        return answers;
    };
}

TEST(CrossValidation, OfAThreshold) {
    Random random(6);
    std::vector<double> apart, same;
    std::vector<bool> truth;
    for (int i = 0; i < 60; ++i) {
        truth.push_back(i % 2 == 0);
        same.push_back(random.normal());
        apart.push_back(random.normal() + (truth.back() ? 20 : 0));
    }
    const int original_threads = threads();
    set_threads(1);
    const CrossValidation single_thread = cross_validate(truth, by_threshold(same, truth));
    set_threads(3);
    const CrossValidation three = cross_validate(truth, by_threshold(same, truth));
    set_threads(original_threads);
    EXPECT_EQ(single_thread.f1, three.f1);
    EXPECT_EQ(cross_validate(truth, by_threshold(apart, truth)).mean_f1, 1);
    EXPECT_LT(single_thread.mean_f1, 0.75) << "chance gives 2/3 at most: all called positive";
    EXPECT_THROW(cross_validate({true, false, false}, by_threshold(same, truth)), Error)
        << "one positive cannot be learned and asked";
    EXPECT_THROW(cross_validate(truth, by_threshold(apart, truth), {.folds = 1}), Error);
}

TEST(FalseDiscoveries, TheExampleOfBenjaminiAndHochberg) {
    // Benjamini and Hochberg 1995, section 3.2: of these 15, the first four are discoveries at 0.05.
    const std::vector<double> p{0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                                0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0000};
    const std::vector<double> q = benjamini_hochberg(p);
    for (std::size_t i = 0; i < p.size(); ++i) EXPECT_EQ(q[i] <= 0.05, i < 4) << i;
    EXPECT_DOUBLE_EQ(q[3], 0.0095 * 15 / 4);
    EXPECT_DOUBLE_EQ(q[14], 1);
    const std::vector<double> dependent = benjamini_yekutieli(p);
    double sum = 0;
    for (int i = 1; i <= 15; ++i) sum += 1.0 / i;
    EXPECT_DOUBLE_EQ(dependent[0], 0.0001 * 15 * sum);
    EXPECT_EQ(dependent[14], 1);
}

TEST(FalseDiscoveries, RiseWithTheirPValuesInAnyOrder) {
    EXPECT_EQ(benjamini_hochberg({0.04, 0.01, 0.03}), (std::vector<double>{0.04, 0.03, 0.04}));
    EXPECT_TRUE(benjamini_hochberg({}).empty());
    EXPECT_EQ(benjamini_hochberg({0.2}), std::vector<double>{0.2});
    EXPECT_THROW(benjamini_hochberg({1.5}), Error);
    EXPECT_THROW(benjamini_hochberg({std::nan("")}), Error);
}

TEST(PermutationTest, IsNeverZero) {
    EXPECT_EQ(permutation_p_value(5, {1, 2, 3}), 0.25);
    EXPECT_EQ(permutation_p_value(2, {1, 2, 3}), 0.75) << "equal ones count";
    EXPECT_EQ(permutation_p_value(2, {}), 1);
}

TEST(NormalDistribution, KnownQuantiles) {
    EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14);
    EXPECT_EQ(normal_quantile(0.5), 0);
    for (const double p : {1e-12, 0.01, 0.3, 0.9, 0.999})
        EXPECT_NEAR(0.5 * std::erfc(-normal_quantile(p) / std::numbers::sqrt2), p, 1e-14);
    EXPECT_THROW(normal_quantile(0), Error);
    EXPECT_THROW(normal_quantile(1), Error);
}

TEST(DeviationInterval, HasTheNominalCoverage) {
    for (const std::size_t n : {6U, 12U, 40U}) {
        int normal = 0, skewed = 0, relative = 0;
        const int trials = 1000;
        for (int trial = 0; trial < trials; ++trial) {
            Random random(200 + n, static_cast<std::uint64_t>(trial));
            std::vector<double> values(n), logs(n);
            for (double& v : values) v = random.normal(50, 4);
            for (double& v : logs) v = std::exp(random.normal(0, 0.2));
            const double truth = std::sqrt(std::expm1(0.04)) * std::exp(0.02);
            const auto d = deviation_interval(values, false), v = deviation_interval(values, true),
                       l = deviation_interval(logs, false);
            ASSERT_TRUE(d && v && l);
            normal += d->low <= 4 && 4 <= d->high ? 1 : 0;
            relative += v->low <= 0.08 && 0.08 <= v->high ? 1 : 0;
            skewed += l->low <= truth && truth <= l->high ? 1 : 0;
        }
        // 950 with a deviation of 7, minus 1 % since the formula is asymptotic; few values give wider intervals than necessary.
        for (const int covered : {normal, skewed, relative}) EXPECT_GE(covered, 913) << n;
        if (n == 40) {
            EXPECT_LE(normal, 971);
        }
    }
}

TEST(DeviationInterval, HasTheValuesUnit) {
    const std::vector<double> values{1, 2, 4, 4, 5, 7, 9, 3};
    const auto absolute = deviation_interval(values, false), relative = deviation_interval(values, true);
    for (const double unit : {1e-200, 1e200, -1.0}) {
        std::vector<double> scaled = values;
        for (double& v : scaled) v *= unit;
        EXPECT_NEAR(deviation_interval(scaled, false)->high / std::abs(unit), absolute->high, 1e-9);
        EXPECT_NEAR(deviation_interval(scaled, true)->low, relative->low, 1e-9);
    }
    EXPECT_LT(absolute->low, *summarise(values).standard_deviation);
    EXPECT_GT(absolute->high, *summarise(values).standard_deviation);
    const auto wider = deviation_interval(values, false, 0.99);
    EXPECT_LT(wider->low, absolute->low);
    EXPECT_GT(wider->high, absolute->high);
    EXPECT_FALSE(deviation_interval({1, 2}, false));
    EXPECT_FALSE(deviation_interval({3, 3, 3, 3}, false)) << "nothing varies";
    EXPECT_FALSE(deviation_interval({-1, 0, 1}, true)) << "no mean to compare with";
    EXPECT_THROW(deviation_interval(values, false, 1), Error);
}

TEST(ClusterStability, DistinguishesRealFromArbitraryClusters) {
    Random random(9);
    std::vector<double> values;
    std::vector<int> labels;
    for (int i = 0; i < 40; ++i) values.push_back(random.normal() + (i < 20 ? 0 : 100)), labels.push_back(i < 20 ? 0 : 1);
    const auto by_place = [&](const std::vector<std::size_t>& chosen) {
        std::vector<int> new_labels;
        for (const auto i : chosen) new_labels.push_back(values[i] > 50 ? 0 : 1);
        return new_labels;
    };
    for (const ClusterStability& s : cluster_stability(labels, by_place)) {
        EXPECT_EQ(s.jaccard, 1);
        EXPECT_EQ(s.recovered, 1);
        EXPECT_EQ(s.dissolved, 0);
        EXPECT_EQ(s.size, 20u);
        EXPECT_EQ(s.resamples, 100);
    }
    const auto by_chance = [&](const std::vector<std::size_t>& chosen) {
        std::vector<int> new_labels;
        for (const auto i : chosen) new_labels.push_back(static_cast<int>(i % 5));
        return new_labels;
    };
    for (const ClusterStability& s : cluster_stability(labels, by_chance)) {
        EXPECT_LT(s.jaccard, 0.5);
        EXPECT_EQ(s.dissolved, 1);
    }
    EXPECT_TRUE(cluster_stability({-1, -1}, [](const auto& c) { return std::vector<int>(c.size(), -1); }).empty());
    EXPECT_TRUE(cluster_stability({}, by_place).empty());
    const auto noise = [](const auto& c) { return std::vector<int>(c.size(), -1); };
    EXPECT_EQ(cluster_stability({0, 0}, noise).front().jaccard, 0);
    EXPECT_THROW(cluster_stability({0, 0}, [](const auto&) { return std::vector<int>(); }), Error);
}

TEST(CrossValidation, PrecisionAndRecallAreMeansOverTheRepeats) {
    std::vector<double> values;
    std::vector<bool> truth;
    for (int i = 0; i < 30; ++i) values.push_back((i * 7) % 30 + (i % 2) * 6), truth.push_back(i % 2 == 1);
    const CrossValidation result = cross_validate(truth, by_threshold(values, truth));
    ASSERT_EQ(result.answers.size(), 10u);
    double precision = 0, recall = 0, accuracy = 0;
    for (std::size_t r = 0; r < result.answers.size(); ++r) {
        const ConfusionScores scores = confusion(result.answers[r], truth);
        EXPECT_EQ(scores.f1(), result.f1[r]);
        precision += scores.precision() / 10, recall += scores.recall() / 10, accuracy += scores.accuracy() / 10;
    }
    EXPECT_NEAR(result.mean_precision, precision, 1e-12);
    EXPECT_NEAR(result.mean_recall, recall, 1e-12);
    EXPECT_NEAR(result.mean_accuracy, accuracy, 1e-12);
}

}  // namespace
}  // namespace ostraka
