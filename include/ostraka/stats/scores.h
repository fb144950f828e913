// Agreement of groupings and binary classifications with the ground truth.
#pragma once

#include "ostraka/core/options.h"

#include <functional>
#include <vector>

namespace ostraka {

/// Adjusted Rand index (Hubert and Arabie 1985) of two groupings: 1 for equal groupings, 0 on average for random ones. Labels
/// are arbitrary integers; samples with labels below 0 (noise) count as separate groups. 1 if both groupings have a single
/// group, or both have one group per sample. Throws Error (input) for no sample, Error (usage) for lists of different lengths.
double adjusted_rand_index(const std::vector<int>& labels, const std::vector<int>& truth);

/// Confusion matrix of a binary classification.
struct ConfusionScores {
    std::size_t true_positive = 0, false_positive = 0, false_negative = 0, true_negative = 0;

    [[nodiscard]] std::size_t count() const { return true_positive + false_positive + false_negative + true_negative; }
    /// TP / (TP + FP); 0 if nothing is classified as positive.
    [[nodiscard]] double precision() const;
    /// TP / (TP + FN); 0 if there are no positives.
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
    double threshold = 0;  ///< values of at least this threshold are classified as positive; infinite at the first point (0, 0)
};
struct RocCurve {
    std::vector<RocPoint> points;  ///< from (0, 0) to (1, 1), one point per distinct value
    double area = 0;               ///< trapezoidal: probability that a positive has the larger value, ties count half
};
/// ROC curve of values that are expected to be larger for positives. Throws Error (input) for values that are not finite or
/// without both positives and negatives, Error (usage) for lists of different lengths.
RocCurve roc_curve(const std::vector<double>& values, const std::vector<bool>& truth);

/// Which side of a threshold is positive.
enum class Side { above, below, either };

struct Threshold {
    double value = 0;
    bool above = true;       ///< positive if at least `value`; otherwise positive if at most `value`
    ConfusionScores scores;  ///< scores on the samples from which it was chosen
    [[nodiscard]] bool positive(double x) const { return above ? x >= value : x <= value; }
};
/// The threshold with the largest F1: midway between consecutive values (the min or max value itself if all are classified as
/// positive). Ties: the widest gap, then `above` before `below`, then the lowest. Throws the errors of roc_curve.
Threshold best_threshold(const std::vector<double>& values, const std::vector<bool>& truth, Side side = Side::above);

struct CrossValidationOptions {
    int folds = 10;
    int repeats = 10;
    std::uint64_t seed = 1;
    void list_options(OptionList& list);
};

struct CrossValidation {
    std::vector<double> f1;                                         ///< one per repeat, over all held-out answers
    double mean_f1 = 0, deviation = 0;                              ///< over the repeats; deviation 0 for a single repeat
    double mean_precision = 0, mean_recall = 0, mean_accuracy = 0;  ///< over the same repeats
    ConfusionScores first;                                          ///< scores of the first repeat
    std::vector<std::vector<bool>> answers;                         ///< one list per repeat: the answer for each sample
    std::vector<double> positive;  ///< one per sample: fraction of repeats that classified it as positive
};

/// Trains on the `training` samples and classifies the `test` samples.
using Learner = std::function<std::vector<bool>(const std::vector<std::size_t>& training, const std::vector<std::size_t>& test)>;

/// Stratified cross-validation: positives and negatives are assigned to the folds in random order, in equal proportions; the
/// number of folds is at most the size of the rarer class. F1 is computed from all held-out answers of a repeat together
/// (Forman and Scholz 2010). Repeats run in parallel: `learn` must not modify shared data. Throws Error (input) unless there
/// are at least two positives and two negatives.
CrossValidation cross_validate(const std::vector<bool>& truth, const Learner& learn, const CrossValidationOptions& options = {});

}  // namespace ostraka
