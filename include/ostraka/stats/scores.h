// Agreement of groupings and binary classifications with the ground truth.
#pragma once

#include "ostraka/core/options.h"

#include <functional>
#include <vector>

namespace ostraka {

/// Adjusted Rand index (Hubert and Arabie 1985) of two groupings of the same samples: 1 for equal groupings, 0 on average for
/// random groupings. Labels are arbitrary integers; samples with labels below 0 (noise) count as separate groups. 1 if both
/// groupings have a single group, or both have one group per sample. Throws Error (input) for no sample, Error (usage) for lists
/// of different lengths.
double adjusted_rand_index(const std::vector<int>& labels, const std::vector<int>& truth);

/// Confusion matrix of a binary classification, and scores computed from the matrix.
struct ConfusionScores {
    std::size_t true_positive = 0, false_positive = 0, false_negative = 0, true_negative = 0;  ///< number of samples of each kind

    /// Number of samples.
    [[nodiscard]] std::size_t count() const { return true_positive + false_positive + false_negative + true_negative; }
    /// Share of the samples classified as positive that are positive: TP / (TP + FP); 0 if nothing is classified as positive.
    [[nodiscard]] double precision() const;
    /// Share of the positive samples that are classified as positive: TP / (TP + FN); 0 if there are no positive samples.
    [[nodiscard]] double recall() const;
    /// Harmonic mean of precision and recall, 2 TP / (2 TP + FP + FN); 0 without positive samples.
    [[nodiscard]] double f1() const;
    [[nodiscard]] double accuracy() const;  ///< share of the samples that are classified correctly
    void add(bool predicted, bool truth);   ///< adds a sample
};

/// Confusion matrix of predictions and ground truth. Throws Error (usage) for lists of different lengths.
ConfusionScores confusion(const std::vector<bool>& predicted, const std::vector<bool>& truth);

/// A point of an ROC curve.
struct RocPoint {
    double false_positive_rate = 0, true_positive_rate = 0;
    double threshold = 0;  ///< values of at least this threshold are classified as positive; infinite at the first point (0, 0)
};
/// Receiver operating characteristic of a quantity that separates two classes.
struct RocCurve {
    std::vector<RocPoint> points;  ///< points from (0, 0) to (1, 1), one per distinct value
    /// Area under the curve: the probability that a positive sample has a larger value than a negative sample, plus half the
    /// probability of equal values.
    double area = 0;
};
/// ROC curve of values that are expected to be larger for positive samples; `truth`: for each value, true if its sample is
/// positive. Throws Error (input) for values that are not finite, and unless there are both positive and negative samples;
/// Error (usage) for lists of different lengths.
RocCurve roc_curve(const std::vector<double>& values, const std::vector<bool>& truth);

/// The side of a threshold on which values are classified as positive.
enum class Side { above, below, either };

/// A threshold that classifies values.
struct Threshold {
    double value = 0;        ///< value of the threshold
    bool above = true;       ///< true: values of at least `value` are positive; false: values of at most `value` are
    ConfusionScores scores;  ///< scores on the samples from which the threshold was chosen
    /// True if the threshold classifies the value x as positive.
    [[nodiscard]] bool positive(double x) const { return above ? x >= value : x <= value; }
};
/// The threshold with the largest F1. The threshold lies midway between consecutive values (or is the min or max value if all
/// values are classified as positive). Among thresholds of equal F1, the one in the widest gap between values is chosen, then
/// `above` before `below`, then the lowest threshold. Throws the errors of roc_curve.
Threshold best_threshold(const std::vector<double>& values, const std::vector<bool>& truth, Side side = Side::above);

struct CrossValidationOptions {
    int folds = 10;                          ///< number of folds
    int repeats = 10;                        ///< number of repeats with other random folds
    std::uint64_t seed = 1;                  ///< random seed
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Scores of a cross-validation.
struct CrossValidation {
    std::vector<double> f1;             ///< for each repeat, the F1 computed from the answers for all held-out samples
    double mean_f1 = 0, deviation = 0;  ///< mean and standard deviation over the repeats of F1; deviation 0 for a single repeat
    double mean_precision = 0, mean_recall = 0, mean_accuracy = 0;  ///< means over the repeats
    ConfusionScores first;                                          ///< scores of the first repeat
    std::vector<std::vector<bool>> answers;                         ///< for each repeat, the answer for each sample
    std::vector<double> positive;  ///< for each sample, the share of the repeats that classified it as positive
};

/// Function that trains a classifier on the `training` samples (indices) and returns for each `test` sample true if it is
/// classified as positive.
using Learner = std::function<std::vector<bool>(const std::vector<std::size_t>& training, const std::vector<std::size_t>& test)>;

/// Stratified cross-validation: positive and negative samples are assigned to the folds in random order, in equal proportions;
/// the number of folds is at most the number of samples of the rarer class. F1 is computed from all held-out answers of a repeat
/// together (Forman and Scholz 2010). Repeats run in parallel: `learn` must not modify shared data. Throws Error (input) unless
/// there are at least two positive and two negative samples.
CrossValidation cross_validate(const std::vector<bool>& truth, const Learner& learn, const CrossValidationOptions& options = {});

}  // namespace ostraka
