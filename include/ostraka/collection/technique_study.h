// Which objects of a collection are wheel-made and which hand-made: answers learned from objects whose technique is known, or
// found without any (thesis, section 3.2.1).
#pragma once

#include "ostraka/collection/technique.h"
#include "ostraka/core/options.h"
#include "ostraka/stats/inference.h"
#include "ostraka/stats/scores.h"

#include <optional>

namespace ostraka {

struct TechniqueObject {
    std::string name;
    std::string label;  ///< the known technique; empty where it is not known
    TechniqueMeasures measures;
};

/// A rule that learns from labelled objects: one descriptor and the threshold with the best F1, or several (logarithms where they
/// are positive, standardised) and Fisher's linear discriminant, also with the limit of the best F1.
struct TechniqueClassifier {
    std::string name;
    std::vector<std::string> descriptors;
    std::string words;  ///< what it goes by, for people
};
/// Those of the thesis: "roundness", "roundness variance", "roundness mean and variance", the same of "eccentricity", "both
/// means", "both" (means and variances of both). Others: "equivalent roundness", "ovality", "marks", "coherence", "straightness",
/// "upright straightness", "wall variation", "outside" (ovality, marks, coherence and straightness), "outside and wall".
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
    std::size_t objects = 0;  ///< labelled ones with all its descriptors
    bool validated = false;   ///< false with fewer than two objects of a label: then nothing below is known
    CrossValidation validation;
    double trivial_f1 = 0;  ///< of calling every object positive
    Interval f1_interval;   ///< 95 % of the F1 when objects of each label are drawn anew
    bool better = false;    ///< that interval lies above the trivial F1
    double error = 1;       ///< (wrong + 1) / (answers + 2) of the objects when left out, a mean over the repeats (Laplace)
    RocCurve roc;           ///< of one descriptor: its values; of several: scores of each object when it was left out
    std::optional<Threshold> threshold;  ///< of one descriptor, learned from all; in its own unit
};

/// A division into two groups by one number alone: the one with the least variance within (Otsu 1979).
struct TechniqueSplit {
    std::string descriptor;              ///< or "first component": of all descriptors of the outside, logarithms, standardised
    std::size_t objects = 0, lower = 0;  ///< in all, and in the group of the lower values
    double threshold = 0;                ///< halfway between the groups
    double share = 0;                    ///< of the variance (of logarithms, where positive) that lies between the groups
    double p_value = 1;                  ///< share of simulated collections from one normal distribution that divide as well
    std::vector<int> group;              ///< of each object of the study: 0 lower, 1 upper, -1 not known
    std::optional<double> f1;            ///< the better of the two ways to name the groups, where labels of both kinds are
};

/// What says that an object is unlike the labelled ones.
struct TechniqueOutlier {
    std::string descriptor;
    double value = 0;
    double low = 0, high = 0;  ///< least and largest of the labelled objects, itself left out
    double distance = 0;       ///< beyond the nearer median of the two kinds, in robust standard deviations
};

struct TechniqueAnswer {
    std::string name, label;
    std::string answer;     ///< empty if there is none
    std::string certainty;  ///< clear, likely, doubtful; without an answer undecided, unlike, not told apart; empty: not known
    std::optional<TechniqueOutlier> unlike;
    bool positive = false;
    double score = 0;                   ///< from 0 up: positive; in standard deviations of the labelled objects' scores
    double agreement = 0;               ///< share of the resampled collections without this object that give the same answer
    int asked = 0;                      ///< their number
    std::optional<Interval> roundness;  ///< 95 % of the mean roundness over resampled blocks of slices
    std::string words;                  ///< why, in one sentence
    [[nodiscard]] bool wrong() const { return !answer.empty() && !label.empty() && answer != label; }
};

struct TechniqueStudy {
    std::string positive, negative;  ///< labels; of a study without labels "rounder" and "less round"
    bool learned = false;            ///< from labels; else by a division
    std::string answered_by;
    std::vector<ClassifierResult> classifiers;  ///< empty without labels
    std::vector<TechniqueSplit> splits;
    bool separated = false;  ///< the answering classifier is better than trivial; without labels: the division has p <= 0.05
    std::vector<TechniqueAnswer> answers;  ///< one an object, in their order
};

/// Learns, validates and answers. A labelled object is answered by what the others teach. No answer is given by a classifier that
/// is not better than calling every object positive, to an object unlike the labelled ones (see `unlike_from`: distance from the
/// nearer median of the two kinds, outwards, over the median absolute deviation from them times 1.4826), and where fewer than
/// half of the resampled collections agree. An answer is clear with an agreement of 0.95 and an error of at most 0.05, likely
/// with 0.8 and 0.2, else doubtful. Without labels the objects are divided by the first descriptor of `answer_by` (all of the
/// outside: their first component), and no answers are given unless that division is better than those of one group (p at most
/// 0.05). Throws Error (usage) for an unknown classifier or label; Error (input) without objects or with labels of more than two
/// kinds.
TechniqueStudy study_technique(const std::vector<TechniqueObject>& objects, const TechniqueStudyOptions& options = {});

/// The division of `values` with the least variance within, its threshold and share between; share 0 if all are the same.
struct TwoGroups {
    double threshold = 0, share = 0;
};
TwoGroups divide_in_two(std::vector<double> values);

}  // namespace ostraka
