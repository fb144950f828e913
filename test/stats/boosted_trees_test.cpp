#include "ostraka/stats/boosted_trees.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace ostraka {
namespace {

struct Samples {
    FeatureTable table;
    std::vector<bool> truth;
};

/// Yes where exactly one of the first two features is above 0; the third one is uninformative.
Samples either_or(std::size_t count, std::uint64_t seed, double mistaken = 0) {
    Samples samples;
    Random random(seed);
    for (std::size_t k = 0; k < count; ++k) {
        const std::array<float, 3> row{static_cast<float>(random.uniform(-1, 1)), static_cast<float>(random.uniform(-1, 1)),
                                       static_cast<float>(random.uniform(-1, 1))};
        samples.table.add(row);
        samples.truth.push_back(((row[0] > 0) != (row[1] > 0)) != (random.uniform() < mistaken));
    }
    return samples;
}

BoostOptions small() {
    BoostOptions options;
    options.trees = 60;
    options.depth = 3;
    options.rate = 0.3;
    options.leaf_weight = 10;
    options.ridge = 1;
    options.column_share = 1;
    return options;
}

TEST(BoostedTrees, LearnInteractionsOfFeatures) {
    const Samples training = either_or(4000, 1), test = either_or(4000, 2);
    const BoostedTrees model = boost(training.table, training.truth, {}, small());
    std::size_t right = 0;
    for (std::size_t r = 0; r < test.truth.size(); ++r) right += (model.log_odds(test.table.row(r)) > 0) == test.truth[r] ? 1 : 0;
    EXPECT_GT(static_cast<double>(right) / 4000, 0.95);
}

TEST(BoostedTrees, LogOddsMatchTheFrequencies) {
    const Samples training = either_or(20000, 3, 0.2), test = either_or(20000, 4, 0.2);
    const BoostedTrees model = boost(training.table, training.truth, {}, small());
    double expected = 0, yes = 0;
    for (std::size_t r = 0; r < test.truth.size(); ++r) {
        const double odds = model.log_odds(test.table.row(r));
        if (odds < 0.5) continue;
        expected += 1 / (1 + std::exp(-odds));
        yes += test.truth[r] ? 1 : 0;
    }
    EXPECT_GT(yes, 5000);
    EXPECT_NEAR(expected / yes, 1, 0.03);
    EXPECT_NEAR(yes / expected * 0.8, 0.8, 0.03);
}

TEST(BoostedTrees, AreTheSameForAnyNumberOfThreadsAndAfterReading) {
    const Samples training = either_or(3000, 5, 0.1);
    const int original_threads = threads();
    set_threads(1);
    const BoostedTrees single_thread = boost(training.table, training.truth, {}, small());
    set_threads(3);
    const BoostedTrees three = boost(training.table, training.truth, {}, small());
    set_threads(original_threads);
    Json document;
    document.SetObject();
    const std::string text = to_compact_text(single_thread.to_json(document.GetAllocator()));
    const BoostedTrees read = BoostedTrees::from_json(parse_json(text, "model"), 3);
    for (std::size_t r = 0; r < training.truth.size(); ++r) {
        const double odds = single_thread.log_odds(training.table.row(r));
        EXPECT_EQ(odds, three.log_odds(training.table.row(r)));
        EXPECT_EQ(odds, read.log_odds(training.table.row(r)));
    }
}

TEST(BoostedTrees, AWeightedSampleCountsLikeMany) {
    FeatureTable table;
    std::vector<bool> truth;
    std::vector<double> weights;
    for (int k = 0; k < 200; ++k) {
        table.add(std::array<float, 1>{0});
        truth.push_back(k % 2 == 0);
        weights.push_back(k % 2 == 0 ? 3 : 1);
    }
    const BoostedTrees model = boost(table, truth, weights, small());
    EXPECT_NEAR(model.log_odds(table.row(0)), std::log(3.0), 0.05);
}

TEST(BoostedTrees, InvalidInputIsReported) {
    Samples samples = either_or(100, 6);
    EXPECT_THROW(samples.table.add(std::array<float, 2>{1, 2}), Error);
    EXPECT_THROW(boost(samples.table, std::vector<bool>(99, true)), Error);
    EXPECT_THROW(boost(samples.table, std::vector<bool>(100, true)), Error) << "all of one class";
    EXPECT_THROW(boost(samples.table, samples.truth, std::vector<double>(3, 1.0)), Error);
    BoostOptions options;
    options.trees = 0;
    EXPECT_THROW(boost(samples.table, samples.truth, {}, options), Error);
    samples.table.values[5] = std::nanf("");
    EXPECT_THROW(boost(samples.table, samples.truth), Error);
    for (const char* text : {"{}", "3", R"({"bias": 0, "trees": [[0, 1]]})", R"({"bias": 0, "trees": [[-1, 1, 2]]})",
                             R"({"bias": 0, "trees": [[7, 1, -1, 1, -1, 2]]})", R"({"bias": 0, "trees": [3]})"})
        EXPECT_THROW(BoostedTrees::from_json(parse_json(text, "model"), 3), Error) << text;
}

}  // namespace
}  // namespace ostraka
