// What a classifier has learned.
#pragma once

#include "ostraka/collection/technique_study.h"

#include <Eigen/Core>

#include <algorithm>

namespace ostraka {

/// Values of a classifier's descriptors: a row an object that has all of them, logarithms where they are positive by nature.
struct DescriptorTable {
    Eigen::MatrixXd values;
    std::vector<std::size_t> objects;  ///< the object of each row
    bool logarithm = false;            ///< of the first column
};
DescriptorTable descriptor_table(const std::vector<TechniqueObject>& objects, const std::vector<std::string>& descriptors);

/// Rows of a table whose objects are labelled, and their truth.
struct Labelled {
    std::vector<std::size_t> rows;
    std::vector<bool> truth;  ///< of every row of the table; false where there is no label
    [[nodiscard]] std::size_t positives() const {
        return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [&](std::size_t row) { return truth[row]; }));
    }
    [[nodiscard]] bool enough() const { return positives() >= 2 && rows.size() - positives() >= 2; }
};
Labelled labelled(const std::vector<TechniqueObject>& objects, const DescriptorTable& table, const std::string& positive);

/// Zero and less count as this: identical slices have no variance.
inline constexpr double min_positive = 1e-12;

/// Score of an object: weights . (x - middle) - limit, positive from 0 up.
struct TechniqueModel {
    Eigen::VectorXd weights, middle;
    double limit = 0;
    std::optional<Threshold> threshold;  ///< of one column
    [[nodiscard]] double score(const Eigen::VectorXd& x) const { return weights.dot(x - middle) - limit; }
};
/// Learns from the given rows; `truth` has one entry a row. Needs both kinds among them. Scores have standard deviation 1 over
/// the rows about the means of their kinds.
TechniqueModel learn(const Eigen::MatrixXd& values, const std::vector<bool>& truth, const std::vector<std::size_t>& rows);

/// Cross-validation, its uncertainty and the receiver operating characteristic of one classifier (technique_validation.cpp).
ClassifierResult validate_classifier(const std::vector<TechniqueObject>& objects, const TechniqueClassifier& classifier,
                                     const std::string& positive, const TechniqueStudyOptions& options);

/// Of each object what says most that it is unlike the labelled ones; none where nothing does, or fewer than `min_compared`
/// others of each label are there to compare with (technique_range.cpp).
std::vector<std::optional<TechniqueOutlier>> unlike_the_labelled(const std::vector<TechniqueObject>& objects,
                                                                 const std::string& positive, double unlike_from);
inline constexpr std::size_t min_compared = 3;

/// Sets `words` of every answer (technique_words.cpp).
void explain_answers(TechniqueStudy& study, const std::vector<TechniqueObject>& objects);

}  // namespace ostraka
