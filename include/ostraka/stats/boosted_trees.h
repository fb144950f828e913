// Gradient boosted decision trees for yes or no.
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/core/options.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ostraka {

/// Rows of equally many features each, one after the other.
struct FeatureTable {
    std::size_t columns = 0;
    std::vector<float> values;

    [[nodiscard]] std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
    [[nodiscard]] std::span<const float> row(std::size_t r) const { return {values.data() + r * columns, columns}; }
    /// Throws Error (usage) for a row of another length.
    void add(std::span<const float> row);
};

struct BoostOptions {
    int trees = 150;
    int depth = 5;              ///< decisions from root to leaf, at most
    double rate = 0.1;          ///< share of each tree's answer that is taken
    double leaf_weight = 50;    ///< of the samples under a leaf, at least
    double ridge = 20;          ///< holds leaves to 0
    double row_share = 0.5;     ///< of the samples, for each tree
    double column_share = 0.4;  ///< of the features, for each tree
    std::uint64_t seed = 1;
    void describe(OptionList& visit);
};

/// A sum of trees that estimates the log odds of "yes".
class BoostedTrees {
public:
    /// Left below and at the threshold, right above it; leaves have no children.
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
    /// Throws Error (input) for what is no such model or asks for a feature beyond `columns`.
    static BoostedTrees from_json(const JsonValue& value, std::size_t columns);
};

/// Trees that lower the logistic loss (Friedman 2001; second-order leaves and histograms of 64 quantiles as Chen and Guestrin
/// 2016). `weights`: one a row, or empty. Features must be finite. The same to the bit for any number of threads. Throws Error
/// (input) for no rows or rows of one kind only, (usage) for lists of different lengths.
BoostedTrees boost(const FeatureTable& table, const std::vector<bool>& truth, const std::vector<double>& weights = {},
                   const BoostOptions& options = {});

}  // namespace ostraka
