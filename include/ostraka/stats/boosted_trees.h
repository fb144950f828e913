// Gradient boosted decision trees for binary classification.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/files/json.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ostraka {

/// Table of features with one row per sample, stored row by row; all rows have the same length.
struct FeatureTable {
    std::size_t columns = 0;    ///< number of features
    std::vector<float> values;  ///< features of all samples

    /// Number of samples.
    [[nodiscard]] std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
    /// Features of sample r.
    [[nodiscard]] std::span<const float> row(std::size_t r) const { return {values.data() + r * columns, columns}; }
    /// Appends the features of a sample. Throws Error (usage) for a row of a different length.
    void add(std::span<const float> row);
};

struct BoostOptions {
    int trees = 150;                         ///< number of trees
    int depth = 5;                           ///< max number of decisions from root to leaf
    double rate = 0.1;                       ///< learning rate: factor applied to each tree's output
    double leaf_weight = 50;                 ///< min sum of sample weights in a leaf
    double ridge = 20;                       ///< L2 regularisation of the leaf values
    double row_share = 0.5;                  ///< share of the samples drawn for each tree, 0 to 1
    double column_share = 0.4;               ///< share of the features drawn for each tree, 0 to 1
    std::uint64_t seed = 1;                  ///< random seed
    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A sum of decision trees that estimates the log odds of the positive class.
class BoostedTrees {
public:
    /// A decision or leaf of a tree. A sample goes left if its feature is at most the threshold, otherwise right.
    struct Node {
        int feature = -1;         ///< index of the feature; -1: a leaf
        float threshold = 0;      ///< samples with a feature value up to the threshold go left
        int left = 0, right = 0;  ///< indices of the children in the tree; unused in a leaf
        float value = 0;          ///< contribution of a leaf to the log odds
    };
    double bias = 0;                       ///< log odds before the trees' contributions
    std::vector<std::vector<Node>> trees;  ///< nodes of each tree, the root first

    [[nodiscard]] double log_odds(std::span<const float> features) const;  ///< estimated log odds of a sample

    [[nodiscard]] JsonValue to_json(JsonAllocator& allocator) const;  ///< the model as JSON, which from_json reads
    /// Reads a model with `columns` features. Throws Error (input) if the value is not such a model or uses a feature index
    /// outside `columns`.
    static BoostedTrees from_json(const JsonValue& value, std::size_t columns);
};

/// Learns trees that minimise the logistic loss (Friedman 2001; second-order leaf values and histograms of 64 quantiles as in
/// Chen and Guestrin 2016). `truth`: for each row, true if it is positive; `weights`: one per row, or empty. Features must be
/// finite. The result is bit-identical for any number of threads. Throws Error (input) for no rows or rows of one class only,
/// (usage) for lists of different lengths.
BoostedTrees boost(const FeatureTable& table, const std::vector<bool>& truth, const std::vector<double>& weights = {},
                   const BoostOptions& options = {});

}  // namespace ostraka
