// Gradient boosted decision trees for binary classification.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/files/json.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ostraka {

/// Rows of features, stored row by row; all rows have the same length.
struct FeatureTable {
    std::size_t columns = 0;
    std::vector<float> values;

    [[nodiscard]] std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
    [[nodiscard]] std::span<const float> row(std::size_t r) const { return {values.data() + r * columns, columns}; }
    /// Throws Error (usage) for a row of a different length.
    void add(std::span<const float> row);
};

struct BoostOptions {
    int trees = 150;
    int depth = 5;              ///< maximum number of decisions from root to leaf
    double rate = 0.1;          ///< learning rate: factor applied to each tree's output
    double leaf_weight = 50;    ///< minimum sum of sample weights in a leaf
    double ridge = 20;          ///< L2 regularisation of the leaf values
    double row_share = 0.5;     ///< fraction of the samples drawn for each tree
    double column_share = 0.4;  ///< fraction of the features drawn for each tree
    std::uint64_t seed = 1;
    void list_options(OptionList& list);
};

/// A sum of trees that estimates the log odds of the positive class.
class BoostedTrees {
public:
    /// Left if the feature is at most the threshold, otherwise right; leaves have no children.
    struct Node {
        int feature = -1;  ///< -1: a leaf
        float threshold = 0;
        int left = 0, right = 0;
        float value = 0;
    };
    double bias = 0;
    std::vector<std::vector<Node>> trees;

    [[nodiscard]] double log_odds(std::span<const float> features) const;

    [[nodiscard]] JsonValue to_json(JsonAllocator& allocator) const;
    /// Throws Error (input) if the value is not such a model or uses a feature index outside `columns`.
    static BoostedTrees from_json(const JsonValue& value, std::size_t columns);
};

/// Trees that minimise the logistic loss (Friedman 2001; second-order leaf values and histograms of 64 quantiles as in Chen and
/// Guestrin 2016). `weights`: one per row, or empty. Features must be finite. Bit-identical for any number of threads. Throws
/// Error (input) for no rows or rows of one class only, (usage) for lists of different lengths.
BoostedTrees boost(const FeatureTable& table, const std::vector<bool>& truth, const std::vector<double>& weights = {},
                   const BoostOptions& options = {});

}  // namespace ostraka
