// Classifies the objects of a collection as wheel-made or hand-made. The classifier is trained on objects of known technique;
// without such objects the collection is split into two groups (thesis, section 3.2.1).
#pragma once

#include "ostraka/collection/technique.h"
#include "ostraka/core/options.h"
#include "ostraka/stats/inference.h"
#include "ostraka/stats/scores.h"

#include <optional>

namespace ostraka {

/// One object of a study of forming techniques.
struct TechniqueObject {
    std::string name;   ///< name of the object
    std::string label;  ///< the known technique; empty if unknown
    TechniqueMeasures measures;
};

/// A classifier to be trained on labelled objects: one descriptor with the threshold of the largest F1, or several descriptors
/// (standardised, positive descriptors as logarithms) with Fisher's linear discriminant and the threshold of the largest F1.
struct TechniqueClassifier {
    std::string name;                      ///< name of the classifier
    std::vector<std::string> descriptors;  ///< names of the descriptors used
    std::string words;                     ///< the descriptors used, as text for messages
};
/// All classifiers. From the thesis: "roundness", "roundness variance", "roundness mean and variance", "eccentricity",
/// "eccentricity variance", "eccentricity mean and variance", "both means", "both" (means and variances of roundness and
/// eccentricity). Further classifiers: "equivalent roundness", "ovality", "marks", "coherence", "straightness", "upright
/// straightness", "wall variation", "outside" (ovality, marks, coherence and straightness), "outside and wall".
const std::vector<TechniqueClassifier>& technique_classifiers();

/// Options of `study_technique`.
struct TechniqueStudyOptions {
    std::string positive;            ///< label of the positive class of F1; empty: the class with the rounder bodies
    std::string answer_by = "both";  ///< name of the classifier that gives the answers
    int folds = 10, repeats = 10;    ///< folds of the cross-validation; number of random divisions into folds
    int resamples = 300;             ///< number of resampled collections that classify each object
    int simulations = 999;           ///< number of simulated collections of one group, for the p-value of a split
    /// Min distance, in robust standard deviations of a descriptor, at which an object is out-of-class.
    double min_outlier_distance = 6;
    std::uint64_t seed = 1;  ///< random seed

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Validation of one classifier on the labelled objects.
struct ClassifierResult {
    TechniqueClassifier classifier;
    std::size_t objects = 0;  ///< number of labelled objects that have all descriptors of the classifier
    /// False if a label has fewer than two objects; the classifier is then not validated, and the following members are
    /// undefined.
    bool validated = false;
    CrossValidation validation;  ///< scores on held-out objects
    double trivial_f1 = 0;       ///< F1 of classifying every object as positive
    Interval f1_interval;        ///< 95 % interval of the F1 when objects are resampled within each label
    bool better = false;         ///< true if `f1_interval` lies above `trivial_f1`
    /// Error rate on held-out objects: (number of wrong answers + 1) / (number of answers + 2) (Laplace), mean over the
    /// repeats.
    double error = 1;
    /// ROC curve of the descriptor's values (one descriptor) or of the held-out scores (several descriptors).
    RocCurve roc;
    /// Threshold learnt from all objects, in the descriptor's unit; none for several descriptors.
    std::optional<Threshold> threshold;
};

/// A split of the objects into two groups by one variable, at the threshold with the smallest within-group variance (Otsu 1979).
struct TechniqueSplit {
    /// Name of the variable: a descriptor, or "first component" (first principal component of the standardised outside
    /// descriptors).
    std::string descriptor;
    std::size_t objects = 0, lower = 0;  ///< number of objects with a value, and of objects in the lower group
    double threshold = 0;                ///< value halfway between the two groups
    /// Between-group variance as a fraction of the total variance (of the logarithms for positive descriptors).
    double share = 0;
    /// Fraction of the collections simulated from one normal distribution whose best split has at least this `share`.
    double p_value = 1;
    std::vector<int> group;  ///< for each object of the study: 0 lower group, 1 upper group, -1 unknown
    /// F1 of the split, with labels assigned to groups so that F1 is larger; none unless both labels occur.
    std::optional<double> f1;
};

/// The descriptor whose value shows that an object is out-of-class, with this value and the range of the labelled objects.
struct TechniqueOutlier {
    std::string descriptor;
    double value = 0;          ///< value of the object
    double low = 0, high = 0;  ///< min and max value of the labelled objects, excluding the object itself
    /// Distance of the value from the closer of the two class medians, in robust standard deviations; 0 between the medians.
    double distance = 0;
};

/// The technique that the study found for one object.
struct TechniqueAnswer {
    std::string name, label;  ///< name of the object; its known technique (empty: unknown)
    std::string answer;       ///< label or group given by the study; empty if there is no answer
    /// "clear", "likely" or "doubtful"; without an answer "undecided", "unlike" or "not told apart"; empty: unknown.
    std::string certainty;
    /// Descriptor that shows that the object is out-of-class; none if the object is not out-of-class.
    std::optional<TechniqueOutlier> outlier;
    bool positive = false;  ///< true: the answer is the positive class
    /// Score of the classifier, in standard deviations of the labelled objects' scores; at least 0 for the positive class.
    double score = 0;
    /// Fraction of the resampled collections that give the same answer, among those that do not contain the object.
    double agreement = 0;
    int asked = 0;                      ///< number of the resampled collections that do not contain the object
    std::optional<Interval> roundness;  ///< 95 % interval of the mean roundness, from resampled blocks of slices
    std::string words;                  ///< sentence that gives the reason for the answer
    [[nodiscard]] bool wrong() const { return !answer.empty() && !label.empty() && answer != label; }
};

/// Result of `study_technique`.
struct TechniqueStudy {
    /// Labels of the two classes; "rounder" and "less round" in a study without labels.
    std::string positive, negative;
    bool learned = false;                       ///< true if trained on labels, false if split without labels
    std::string answered_by;                    ///< classifier or descriptor that gave the answers
    std::vector<ClassifierResult> classifiers;  ///< one per classifier; empty without labels
    std::vector<TechniqueSplit> splits;         ///< one per variable
    /// True if the classifier that gives the answers is better than the trivial one; without labels, true if the split has p <=
    /// 0.05.
    bool separated = false;
    std::vector<TechniqueAnswer> answers;  ///< one per object, in the order of the objects
};

/// Trains, validates and applies the classifiers. A labelled object is classified by a model trained on the other objects. An
/// object gets no answer if the classifier is not better than classifying every object as positive, if the object is out-of-class
/// (option `min_outlier_distance`: outward distance from the closer of the two class medians, divided by 1.4826 times the median
/// absolute deviation from the class medians), or if fewer than half of the resampled collections agree. An answer is clear with
/// an agreement of at least 0.95 and an error of at most 0.05, likely with an agreement of at least 0.8 and an error of at most
/// 0.2, and doubtful otherwise. Without labels the objects are split by the first descriptor of `answer_by` ("outside": by the
/// first principal component), and answers are given only if a single homogeneous group would rarely be split as clearly (p at
/// most 0.05). Throws Error (usage) for an unknown classifier or label; Error (input) without objects or with more than two
/// distinct labels.
TechniqueStudy study_technique(const std::vector<TechniqueObject>& objects, const TechniqueStudyOptions& options = {});

/// The split of values into two groups with the smallest within-group variance: threshold, and fraction `share` of the variance
/// between the groups (0 if all values are equal).
struct TwoGroups {
    double threshold = 0, share = 0;  ///< value that separates the groups; fraction of the variance between them
};
TwoGroups divide_in_two(std::vector<double> values);

}  // namespace ostraka
