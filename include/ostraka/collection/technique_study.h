// Which objects of a collection are wheel-made and which hand-made: learnt from objects of known technique, or found without
// labels (thesis, section 3.2.1).
#pragma once

#include "ostraka/collection/technique.h"
#include "ostraka/core/options.h"
#include "ostraka/stats/inference.h"
#include "ostraka/stats/scores.h"

#include <optional>

namespace ostraka {

struct TechniqueObject {
    std::string name;
    std::string label;  ///< the known technique; empty if unknown
    TechniqueMeasures measures;
};

/// A classifier trained on labelled objects: one descriptor with the threshold of the best F1, or several descriptors
/// (logarithms of positive ones, standardised) with Fisher's linear discriminant, also thresholded at the best F1.
struct TechniqueClassifier {
    std::string name;
    std::vector<std::string> descriptors;
    std::string words;  ///< text for messages: the descriptors used
};
/// Classifiers of the thesis: "roundness", "roundness variance", "roundness mean and variance", the same for "eccentricity",
/// "both means", "both" (means and variances of both). Others: "equivalent roundness", "ovality", "marks", "coherence",
/// "straightness", "upright straightness", "wall variation", "outside" (ovality, marks, coherence and straightness), "outside
/// and wall".
const std::vector<TechniqueClassifier>& technique_classifiers();

struct TechniqueStudyOptions {
    std::string positive;
    std::string answer_by = "both";
    int folds = 10, repeats = 10;
    int resamples = 300;
    int simulations = 999;
    double unlike_from = 6;
    std::uint64_t seed = 1;

    void describe(OptionList& visit);
};

struct ClassifierResult {
    TechniqueClassifier classifier;
    std::size_t objects = 0;  ///< number of labelled objects that have all descriptors of the classifier
    bool validated = false;   ///< false if a label has fewer than two objects; the members below are then undefined
    CrossValidation validation;
    double trivial_f1 = 0;               ///< F1 of classifying every object as positive
    Interval f1_interval;                ///< 95 % interval of the F1 when objects are resampled within each label
    bool better = false;                 ///< whether the interval lies above the trivial F1
    double error = 1;                    ///< (wrong + 1) / (answers + 2) of held-out objects, mean over the repeats (Laplace)
    RocCurve roc;                        ///< one descriptor: its values; several: held-out scores of the objects
    std::optional<Threshold> threshold;  ///< one descriptor only: learnt from all objects, in the descriptor's unit
};

/// A split into two groups by a single variable: the split with the smallest within-group variance (Otsu 1979).
struct TechniqueSplit {
    std::string descriptor;              ///< or "first component": of all descriptors of the outside, logarithms, standardised
    std::size_t objects = 0, lower = 0;  ///< total number, and number in the lower group
    double threshold = 0;                ///< midpoint between the groups
    double share = 0;          ///< fraction of the variance (of logarithms, where positive) that lies between the groups
    double p_value = 1;        ///< fraction of collections simulated from one normal distribution that split at least as well
    std::vector<int> group;    ///< one per object of the study: 0 lower, 1 upper, -1 unknown
    std::optional<double> f1;  ///< the better of the two assignments of labels to groups, if both labels occur
};

/// The descriptor by which an object is out-of-class.
struct TechniqueOutlier {
    std::string descriptor;
    double value = 0;
    double low = 0, high = 0;  ///< min and max of the labelled objects, excluding the object itself
    double distance = 0;       ///< beyond the nearer of the two class medians, in robust standard deviations
};

struct TechniqueAnswer {
    std::string name, label;
    std::string answer;     ///< empty if there is no answer
    std::string certainty;  ///< clear, likely or doubtful; no answer: undecided, unlike, not told apart; empty: unknown
    std::optional<TechniqueOutlier> unlike;
    bool positive = false;
    double score = 0;                   ///< positive if at least 0; in standard deviations of the labelled objects' scores
    double agreement = 0;               ///< fraction of the resampled collections without this object that give the same answer
    int asked = 0;                      ///< number of the resampled collections without this object
    std::optional<Interval> roundness;  ///< 95 % interval of the mean roundness, from resampled blocks of slices
    std::string words;                  ///< the reason, in one sentence
    [[nodiscard]] bool wrong() const { return !answer.empty() && !label.empty() && answer != label; }
};

struct TechniqueStudy {
    std::string positive, negative;  ///< labels; "rounder" and "less round" in a study without labels
    bool learned = false;            ///< true if trained on labels, false if split without labels
    std::string answered_by;
    std::vector<ClassifierResult> classifiers;  ///< empty without labels
    std::vector<TechniqueSplit> splits;
    /// Whether the answering classifier is better than trivial; without labels, whether the split has p <= 0.05.
    bool separated = false;
    std::vector<TechniqueAnswer> answers;  ///< one per object, in their order
};

/// Trains, validates and applies the classifiers. A labelled object is classified by a model trained without it. There is no
/// answer if the classifier is not better than classifying every object as positive, if the object is out-of-class (see
/// `unlike_from`: outward distance from the nearer of the two class medians, over the median absolute deviation from them times
/// 1.4826), or if fewer than half of the resampled collections agree. An answer is clear with an agreement of at least 0.95 and
/// an error of at most 0.05, likely with 0.8 and 0.2, otherwise doubtful. Without labels the objects are split by the first
/// descriptor of `answer_by` ("outside": by the first principal component), and answers are given only if the split is better
/// than splits of a single group (p at most 0.05). Throws Error (usage) for an unknown classifier or label; Error (input)
/// without objects or with more than two distinct labels.
TechniqueStudy study_technique(const std::vector<TechniqueObject>& objects, const TechniqueStudyOptions& options = {});

/// The split of `values` with the smallest within-group variance: its threshold and its between-group fraction of the variance;
/// 0 if all values are equal.
struct TwoGroups {
    double threshold = 0, share = 0;
};
TwoGroups divide_in_two(std::vector<double> values);

}  // namespace ostraka
