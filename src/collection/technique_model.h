// Training and validation of the classifiers of forming techniques.
#pragma once

#include "ostraka/collection/technique_study.h"

#include <Eigen/Core>

#include <algorithm>

namespace ostraka {

/// Values of a classifier's descriptors for the objects that have all of these descriptors.
struct DescriptorTable {
    Eigen::MatrixXd values;            ///< one row per object, one column per descriptor; logarithms of positive descriptors
    std::vector<std::size_t> objects;  ///< for each row: index of the object
    bool logarithm = false;            ///< true if the first column holds logarithms
};
DescriptorTable descriptor_table(const std::vector<TechniqueObject>& objects, const std::vector<std::string>& descriptors);

/// The rows of a DescriptorTable whose objects are labelled, and their true classes.
struct Labelled {
    std::vector<std::size_t> rows;  ///< indices of the labelled rows
    /// For each row of the table: true if the object's label is the positive class; false if it has no label.
    std::vector<bool> truth;
    /// Number of labelled rows of the positive class.
    [[nodiscard]] std::size_t positives() const {
        return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [&](std::size_t row) { return truth[row]; }));
    }
    /// True if each class has at least two rows.
    [[nodiscard]] bool enough() const { return positives() >= 2 && rows.size() - positives() >= 2; }
};
Labelled labelled(const std::vector<TechniqueObject>& objects, const DescriptorTable& table, const std::string& positive);

/// Values smaller than `min_positive` are replaced by it before taking logarithms, because identical slices have variance 0.
inline constexpr double min_positive = 1e-12;

/// Linear classifier with score weights . (x - middle) - limit; an object is positive if its score is at least 0.
struct TechniqueModel {
    Eigen::VectorXd weights, middle;  ///< one entry per column: weight, and reference value
    double limit = 0;                 ///< threshold of the weighted sum
    /// Threshold in the descriptor's unit; none unless there is a single column.
    std::optional<Threshold> threshold;
    [[nodiscard]] double score(const Eigen::VectorXd& x) const { return weights.dot(x - middle) - limit; }
};
/// Trains on the given rows; `truth` has one entry per row of `values`. Both classes must occur among the given rows. Scores are
/// scaled so that their standard deviation about the class means is 1 over the rows.
TechniqueModel learn(const Eigen::MatrixXd& values, const std::vector<bool>& truth, const std::vector<std::size_t>& rows);

/// Cross-validation of one classifier, with its uncertainty and receiver operating characteristic (technique_validation.cpp).
ClassifierResult validate_classifier(const std::vector<TechniqueObject>& objects, const TechniqueClassifier& classifier,
                                     const std::string& positive, const TechniqueStudyOptions& options);

/// For each object, the descriptor that most strongly marks it as out-of-class; none if no descriptor does, or if fewer than
/// `min_compared` other objects of each label exist (technique_range.cpp).
std::vector<std::optional<TechniqueOutlier>> technique_outliers(const std::vector<TechniqueObject>& objects,
                                                                const std::string& positive, double min_outlier_distance);
inline constexpr std::size_t min_compared = 3;  ///< minimum number of other objects of each label

/// Sets `words`, the explanation of every answer (technique_words.cpp).
void explain_answers(TechniqueStudy& study, const std::vector<TechniqueObject>& objects);

}  // namespace ostraka
