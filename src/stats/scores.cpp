#include "ostraka/stats/scores.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/random.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

namespace ostraka {

namespace {

void require_same_length(std::size_t a, std::size_t b) {
    if (a != b) fail_usage(fmt::format("the lists have {} and {} entries", a, b), "give one entry per sample in both lists");
}

double pairs(double count) { return count * (count - 1) / 2; }

double ratio(std::size_t numerator, std::size_t denominator) {
    return denominator == 0 ? 0.0 : static_cast<double>(numerator) / static_cast<double>(denominator);
}

std::size_t require_both(const std::vector<double>& values, const std::vector<bool>& truth) {
    require_same_length(values.size(), truth.size());
    require_finite(values, "scores");
    const auto positives = static_cast<std::size_t>(std::count(truth.begin(), truth.end(), true));
    if (positives == 0 || positives == truth.size())
        fail_input("scores", positives == 0 ? "no sample is positive" : "no sample is negative",
                   "give positive and negative samples");
    return positives;
}

/// A distinct value and the number of samples that have it.
struct Step {
    double value;
    std::size_t positives = 0, negatives = 0;
};

std::vector<Step> steps_up(const std::vector<double>& values, const std::vector<bool>& truth) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return values[a] < values[b]; });
    std::vector<Step> steps;
    for (const std::size_t i : order) {
        if (steps.empty() || steps.back().value != values[i]) steps.push_back({values[i]});
        ++(truth[i] ? steps.back().positives : steps.back().negatives);
    }
    return steps;
}

}  // namespace

double adjusted_rand_index(const std::vector<int>& labels, const std::vector<int>& truth) {
    require_same_length(labels.size(), truth.size());
    if (labels.empty()) fail_input("adjusted Rand index", "no sample is given", "give at least one sample");
    std::map<std::pair<long, long>, double> joint;
    std::map<long, double> rows, columns;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const long own_group = -1 - static_cast<long>(i);
        const long a = labels[i] < 0 ? own_group : labels[i], b = truth[i] < 0 ? own_group : truth[i];
        joint[{a, b}] += 1;
        rows[a] += 1;
        columns[b] += 1;
    }
    double agreeing_pairs = 0, in_rows = 0, in_columns = 0;
    for (const auto& [key, count] : joint) agreeing_pairs += pairs(count);
    for (const auto& [key, count] : rows) in_rows += pairs(count);
    for (const auto& [key, count] : columns) in_columns += pairs(count);
    const double total_pairs = pairs(static_cast<double>(labels.size()));
    const double expected = total_pairs > 0 ? in_rows * in_columns / total_pairs : 0, maximum = (in_rows + in_columns) / 2;
    return maximum == expected ? 1.0 : (agreeing_pairs - expected) / (maximum - expected);
}

double ConfusionScores::precision() const { return ratio(true_positive, true_positive + false_positive); }
double ConfusionScores::recall() const { return ratio(true_positive, true_positive + false_negative); }
double ConfusionScores::f1() const { return ratio(2 * true_positive, 2 * true_positive + false_positive + false_negative); }
double ConfusionScores::accuracy() const { return ratio(true_positive + true_negative, count()); }

void ConfusionScores::add(bool predicted, bool truth) {
    ++(predicted ? (truth ? true_positive : false_positive) : (truth ? false_negative : true_negative));
}

ConfusionScores confusion(const std::vector<bool>& predicted, const std::vector<bool>& truth) {
    require_same_length(predicted.size(), truth.size());
    ConfusionScores scores;
    for (std::size_t i = 0; i < truth.size(); ++i) scores.add(predicted[i], truth[i]);
    return scores;
}

RocCurve roc_curve(const std::vector<double>& values, const std::vector<bool>& truth) {
    const std::size_t positives = require_both(values, truth), negatives = truth.size() - positives;
    std::vector<Step> steps = steps_up(values, truth);
    std::reverse(steps.begin(), steps.end());
    RocCurve curve;
    curve.points.push_back({0, 0, std::numeric_limits<double>::infinity()});
    std::size_t tp = 0, fp = 0;
    double doubled = 0;  // twice the number of pairs below the curve: an integer, so that nothing is rounded
    for (const Step& step : steps) {
        doubled += static_cast<double>(step.negatives) * static_cast<double>(2 * tp + step.positives);
        tp += step.positives;
        fp += step.negatives;
        curve.points.push_back({ratio(fp, negatives), ratio(tp, positives), step.value});
    }
    curve.area = doubled / 2 / static_cast<double>(positives) / static_cast<double>(negatives);
    return curve;
}

Threshold best_threshold(const std::vector<double>& values, const std::vector<bool>& truth, Side side) {
    const std::size_t positives = require_both(values, truth), negatives = truth.size() - positives;
    const std::vector<Step> steps = steps_up(values, truth);
    Threshold best;
    double best_gap = -1;
    const auto consider = [&](double value, double gap, bool above, const ConfusionScores& scores) {
        // Compares scores without division, f1 = 2 tp / (tp + fp + positives).
        const double score_now = static_cast<double>(scores.true_positive) *
                                 static_cast<double>(best.scores.true_positive + best.scores.false_positive + positives),
                     best_score = static_cast<double>(best.scores.true_positive) *
                                  static_cast<double>(scores.true_positive + scores.false_positive + positives);
        if (best_gap >= 0 && (score_now < best_score || (score_now == best_score && gap <= best_gap))) return;
        best = {value, above, scores};
        best_gap = gap;
    };
    for (const bool above : {true, false}) {
        if (side == (above ? Side::below : Side::above)) continue;
        // Steps 0 to i - 1 lie below the threshold.
        std::size_t p = 0, n = 0;
        for (std::size_t i = 0; i <= steps.size(); ++i) {
            const bool inside = i > 0 && i < steps.size();
            const double value = i == 0   ? steps.front().value
                                 : inside ? steps[i - 1].value + (steps[i].value - steps[i - 1].value) / 2
                                          : steps.back().value;
            const double gap = inside ? steps[i].value - steps[i - 1].value : 0;
            const bool all_or_none = above ? i == steps.size() : i == 0;
            if (!all_or_none)
                consider(value, gap, above,
                         above ? ConfusionScores{positives - p, negatives - n, p, n}
                               : ConfusionScores{p, n, positives - p, negatives - n});
            if (i < steps.size()) p += steps[i].positives, n += steps[i].negatives;
        }
    }
    return best;
}

CrossValidation cross_validate(const std::vector<bool>& truth, const Learner& learn, const CrossValidationOptions& options) {
    check_options(options, "cross-validation");
    std::vector<std::size_t> class_samples[2];
    for (std::size_t i = 0; i < truth.size(); ++i) class_samples[truth[i] ? 1 : 0].push_back(i);
    const std::size_t rarer = std::min(class_samples[0].size(), class_samples[1].size());
    if (rarer < 2)
        fail_input("cross-validation",
                   fmt::format("there are {} positive and {} negative samples", class_samples[1].size(), class_samples[0].size()),
                   "give at least two of each class");
    const std::size_t folds = std::min(static_cast<std::size_t>(options.folds), rarer);
    const auto repeats = static_cast<std::size_t>(options.repeats);
    std::vector<std::vector<bool>> answers(repeats, std::vector<bool>(truth.size()));
    parallel_for(repeats, 1, [&](std::size_t r) {
        Random random(options.seed, r);
        std::vector<std::size_t> fold(truth.size());
        std::size_t assigned = 0;
        for (const auto& samples_of_class : class_samples) {
            std::vector<std::size_t> order = samples_of_class;
            random.shuffle(order);
            for (const std::size_t i : order) fold[i] = assigned++ % folds;
        }
        for (std::size_t f = 0; f < folds; ++f) {
            std::vector<std::size_t> training, test;
            for (std::size_t i = 0; i < truth.size(); ++i) (fold[i] == f ? test : training).push_back(i);
            const std::vector<bool> predictions = learn(training, test);
            require_same_length(predictions.size(), test.size());
            for (std::size_t k = 0; k < test.size(); ++k) answers[r][test[k]] = predictions[k];
        }
    });
    CrossValidation result;
    result.positive.assign(truth.size(), 0.0);
    for (const auto& predictions : answers) {
        const ConfusionScores scores = confusion(predictions, truth);
        if (result.f1.empty()) result.first = scores;
        result.f1.push_back(scores.f1());
        result.mean_precision += scores.precision() / static_cast<double>(repeats);
        result.mean_recall += scores.recall() / static_cast<double>(repeats);
        result.mean_accuracy += scores.accuracy() / static_cast<double>(repeats);
        for (std::size_t i = 0; i < truth.size(); ++i) result.positive[i] += predictions[i] ? 1 : 0;
    }
    for (double& positive_fraction : result.positive) positive_fraction /= static_cast<double>(repeats);
    const Summary summary = summarise(result.f1, "F1");
    result.mean_f1 = summary.mean;
    result.deviation = summary.standard_deviation.value_or(0);
    result.answers = std::move(answers);
    return result;
}

void CrossValidationOptions::declare_options(OptionList& list) {
    list("folds", folds, "number of folds that are held out in turn", Range{2, 100000});
    list("repeats", repeats, "number of times the division into folds is repeated", Range{1, 100000});
    list("seed", seed, "random seed", Range{0, 1e18});
}

}  // namespace ostraka
