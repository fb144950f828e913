// How well groups and yes-or-no answers agree with the truth.
#pragma once

#include "ostraka/core/options.h"

#include <functional>
#include <vector>

namespace ostraka {

/// Adjusted Rand index (Hubert and Arabie 1985) of two groupings: 1 for the same one, 0 on average for chance. Labels are any
/// numbers; samples labelled below 0 (noise) count as groups of one each. 1 where both put all samples in one group, or each in
/// its own. Throws Error (input) for no sample, Error (usage) for lists of different lengths.
double adjusted_rand_index(const std::vector<int>& labels, const std::vector<int>& truth);

/// Counts of right and wrong answers.
struct ConfusionScores {
    std::size_t true_positive = 0, false_positive = 0, false_negative = 0, true_negative = 0;

    [[nodiscard]] std::size_t count() const { return true_positive + false_positive + false_negative + true_negative; }
    /// Of what was called positive, the share that is; 0 if nothing was.
    [[nodiscard]] double precision() const;
    /// Of what is positive, the share that was called so; 0 if nothing is.
    [[nodiscard]] double recall() const;
    /// Harmonic mean of precision and recall, 2 TP / (2 TP + FP + FN); 0 without positives.
    [[nodiscard]] double f1() const;
    [[nodiscard]] double accuracy() const;
    void add(bool predicted, bool truth);
};

/// Throws Error (usage) for lists of different lengths.
ConfusionScores confusion(const std::vector<bool>& predicted, const std::vector<bool>& truth);

struct RocPoint {
    double false_positive_rate = 0, true_positive_rate = 0;
    double threshold = 0;  ///< values from here up are called positive; infinite at the first point (0, 0)
};
struct RocCurve {
    std::vector<RocPoint> points;  ///< from (0, 0) to (1, 1), a point for each distinct value
    double area = 0;  ///< under the straight lines between them: the chance that a positive has the larger value, ties by half
};
/// Values that shall be larger for positives. Throws Error (input) for values that are not finite or without both positives and
/// negatives, Error (usage) for lists of different lengths.
RocCurve roc_curve(const std::vector<double>& values, const std::vector<bool>& truth);

/// Which side of a threshold is positive.
enum class Side { above, below, either };

struct Threshold {
    double value = 0;
    bool above = true;       ///< positive from `value` up; else up to `value`
    ConfusionScores scores;  ///< on the samples it was chosen by
    [[nodiscard]] bool positive(double x) const { return above ? x >= value : x <= value; }
};
/// The threshold with the largest F1: halfway between neighbouring values (the least or largest value itself where all are called
/// positive); of equally good ones the one in the widest gap, then `above` before `below`, then the lowest. Throws as roc_curve.
Threshold best_threshold(const std::vector<double>& values, const std::vector<bool>& truth, Side side = Side::above);

struct CrossValidationOptions {
    int folds = 10;
    int repeats = 10;
    std::uint64_t seed = 1;
    void describe(OptionList& visit);
};

struct CrossValidation {
    std::vector<double> f1;             ///< of each repeat, over all samples, each answered when it was left out
    double mean_f1 = 0, deviation = 0;  ///< over the repeats; deviation 0 for one
    double mean_precision = 0, mean_recall = 0, mean_accuracy = 0;  ///< over the same repeats
    ConfusionScores first;                                          ///< of the first repeat
    std::vector<std::vector<bool>> answers;                         ///< a list a repeat: what each sample was called
    std::vector<double> positive;  ///< a share of repeats a sample: how often it was called positive
};

/// Answers for `asked` samples of what was learned from `known` ones.
using Learner = std::function<std::vector<bool>(const std::vector<std::size_t>& known, const std::vector<std::size_t>& asked)>;

/// Stratified cross-validation: positives and negatives are dealt out to the folds in random order, so that each fold has its
/// share of both; never more folds than there are of the rarer kind. F1 is that of all left-out answers of a repeat together
/// (Forman and Scholz 2010). Repeats run in parallel: `learn` must not change what it shares. Throws Error (input) unless there
/// are at least two positives and two negatives.
CrossValidation cross_validate(const std::vector<bool>& truth, const Learner& learn, const CrossValidationOptions& options = {});

}  // namespace ostraka
