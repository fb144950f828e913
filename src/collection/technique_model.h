// Trained classifiers.
#pragma once

#include "ostraka/collection/technique_study.h"

#include <Eigen/Core>

#include <algorithm>

namespace ostraka {

/// Values of a classifier's descriptors: one row per object that has all of them, logarithms of positive descriptors.
struct DescriptorTable {
    Eigen::MatrixXd values;
    std::vector<std::size_t> objects;  ///< index of the object of each row
    bool logarithm = false;            ///< whether the first column is a logarithm
};
DescriptorTable descriptor_table(const std::vector<TechniqueObject>& objects, const std::vector<std::string>& descriptors);

/// Rows of a table whose objects are labelled, with their ground truth.
struct Labelled {
    std::vector<std::size_t> rows;
    std::vector<bool> truth;  ///< one per row of the table; false if the object has no label
    [[nodiscard]] std::size_t positives() const {
        return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [&](std::size_t row) { return truth[row]; }));
    }
    [[nodiscard]] bool enough() const { return positives() >= 2 && rows.size() - positives() >= 2; }
};
Labelled labelled(const std::vector<TechniqueObject>& objects, const DescriptorTable& table, const std::string& positive);

/// Smaller values are replaced by this one before taking logarithms: identical slices have no variance.
inline constexpr double min_positive = 1e-12;

/// Linear classifier with score weights . (x - middle) - limit; an object is positive if its score is at least 0.
struct TechniqueModel {
    Eigen::VectorXd weights, middle;
    double limit = 0;
    std::optional<Threshold> threshold;  ///< single column only
    [[nodiscard]] double score(const Eigen::VectorXd& x) const { return weights.dot(x - middle) - limit; }
};
/// Trains on the given rows; `truth` has one entry per row of `values`. Both classes must occur. Scores are scaled to standard
/// deviation 1 over the rows about their class means.
TechniqueModel learn(const Eigen::MatrixXd& values, const std::vector<bool>& truth, const std::vector<std::size_t>& rows);

/// Cross-validation of one classifier, with its uncertainty and receiver operating characteristic (technique_validation.cpp).
ClassifierResult validate_classifier(const std::vector<TechniqueObject>& objects, const TechniqueClassifier& classifier,
                                     const std::string& positive, const TechniqueStudyOptions& options);

/// For each object, the descriptor that most strongly marks it as out-of-class; none if no descriptor does, or if fewer than
/// `min_compared` other objects of each label exist (technique_range.cpp).
std::vector<std::optional<TechniqueOutlier>> technique_outliers(const std::vector<TechniqueObject>& objects,
                                                                const std::string& positive, double unlike_from);
inline constexpr std::size_t min_compared = 3;

/// Sets `words`, the explanation of every answer (technique_words.cpp).
void explain_answers(TechniqueStudy& study, const std::vector<TechniqueObject>& objects);

}  // namespace ostraka
