#include "ostraka/stats/boosted_trees.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/json_build.h"
#include "ostraka/stats/random.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace ostraka {

namespace {

constexpr std::size_t bins = 64;

/// Rounds to four significant digits, so that a written model equals the trained model.
float rounded(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return std::strtof(text, nullptr);
}

/// Sums of the first and second derivatives of the loss.
struct Slope {
    double first = 0, second = 0;
    void add(const Slope& other) { first += other.first, second += other.second; }
};

class Booster {
public:
    Booster(const FeatureTable& table, const std::vector<bool>& truth, const std::vector<double>& weights,
            const BoostOptions& options)
        : table_(table), options_(options), rows_(table.rows()), truth_(truth), weights_(weights) {
        if (weights_.empty()) weights_.assign(rows_, 1.0);
        compute_bins();
    }

    BoostedTrees run() {
        double positives = 0, total_weight = 0;
        for (std::size_t r = 0; r < rows_; ++r) positives += truth_[r] ? weights_[r] : 0, total_weight += weights_[r];
        BoostedTrees model;
        model.bias = static_cast<double>(rounded(std::log(positives / (total_weight - positives))));
        std::vector<double> odds(rows_, model.bias);
        slopes_.resize(rows_);
        Random random(options_.seed, 21);
        for (int t = 0; t < options_.trees; ++t) {
            for (std::size_t r = 0; r < rows_; ++r) {
                const double p = 1 / (1 + std::exp(-odds[r]));
                slopes_[r] = {weights_[r] * (p - (truth_[r] ? 1 : 0)), weights_[r] * std::max(1e-6, p * (1 - p))};
            }
            model.trees.push_back(grow(random));
            for (std::size_t r = 0; r < rows_; ++r) odds[r] += tree_value(model.trees.back(), table_.row(r));
        }
        return model;
    }

    static double tree_value(const std::vector<BoostedTrees::Node>& tree, std::span<const float> features) {
        const BoostedTrees::Node* node = tree.data();
        while (node->feature >= 0)
            node =
                tree.data() + (features[static_cast<std::size_t>(node->feature)] <= node->threshold ? node->left : node->right);
        return static_cast<double>(node->value);
    }

private:
    /// Computes thresholds of each feature at quantiles, and the bin of each value.
    void compute_bins() {
        thresholds_.resize(table_.columns);
        binned_.resize(table_.columns);
        parallel_for(table_.columns, 1, [&](std::size_t c) {
            std::vector<float> values(rows_);
            for (std::size_t r = 0; r < rows_; ++r) values[r] = table_.row(r)[c];
            std::vector<float> sorted = values;
            std::sort(sorted.begin(), sorted.end());
            auto& cuts = thresholds_[c];
            for (std::size_t b = 1; b < bins; ++b) {
                const float at = rounded(static_cast<double>(sorted[b * (rows_ - 1) / bins]));
                if (cuts.empty() || at > cuts.back()) cuts.push_back(at);
            }
            binned_[c].resize(rows_);
            for (std::size_t r = 0; r < rows_; ++r)
                binned_[c][r] = static_cast<std::uint8_t>(std::lower_bound(cuts.begin(), cuts.end(), values[r]) - cuts.begin());
        });
    }

    struct Split {
        double gain = 0;
        std::size_t column = 0, bin = 0;
    };

    std::vector<BoostedTrees::Node> grow(Random& random) {
        std::vector<Index32> sample;
        for (std::size_t r = 0; r < rows_; ++r)
            if (random.uniform() < options_.row_share) sample.push_back(static_cast<Index32>(r));
        std::vector<std::size_t> columns = random.permutation(table_.columns);
        columns.resize(std::max<std::size_t>(
            1, static_cast<std::size_t>(std::lround(options_.column_share * static_cast<double>(table_.columns)))));
        std::sort(columns.begin(), columns.end());
        std::vector<BoostedTrees::Node> tree(1);
        descend(tree, 0, sample, columns, options_.depth);
        return tree;
    }

    using Index32 = std::uint32_t;

    void descend(std::vector<BoostedTrees::Node>& tree, std::size_t at, const std::vector<Index32>& sample,
                 const std::vector<std::size_t>& columns, int depth) {
        Slope total;
        double weight = 0;
        for (const Index32 r : sample) total.add(slopes_[r]), weight += weights_[r];
        tree[at].value = rounded(-options_.rate * total.first / (total.second + options_.ridge));
        if (depth == 0 || weight < 2 * options_.leaf_weight) return;
        const auto gain_of = [&](const Slope& s) { return s.first * s.first / (s.second + options_.ridge); };
        std::vector<Split> best(columns.size());
        parallel_for(columns.size(), 1, [&](std::size_t k) {
            const std::size_t c = columns[k];
            std::array<Slope, bins> sums{};
            std::array<double, bins> weights{};
            for (const Index32 r : sample) {
                const std::size_t bin = binned_[c][r];
                sums[bin].add(slopes_[r]);
                weights[bin] += weights_[r];
            }
            Slope left;
            double below = 0;
            for (std::size_t b = 0; b < thresholds_[c].size(); ++b) {
                left.add(sums[b]);
                below += weights[b];
                if (below < options_.leaf_weight || weight - below < options_.leaf_weight) continue;
                const Slope right{total.first - left.first, total.second - left.second};
                const double gain = gain_of(left) + gain_of(right) - gain_of(total);
                if (gain > best[k].gain) best[k] = {gain, c, b};
            }
        });
        Split chosen;
        for (const Split& split : best)
            if (split.gain > chosen.gain) chosen = split;
        if (!(chosen.gain > 1e-6)) return;
        std::vector<Index32> left, right;
        for (const Index32 r : sample) (binned_[chosen.column][r] <= chosen.bin ? left : right).push_back(r);
        const int first = static_cast<int>(tree.size());
        tree[at] = {static_cast<int>(chosen.column), thresholds_[chosen.column][chosen.bin], first, first + 1, 0};
        tree.resize(tree.size() + 2);
        descend(tree, static_cast<std::size_t>(first), left, columns, depth - 1);
        descend(tree, static_cast<std::size_t>(first) + 1, right, columns, depth - 1);
    }

    const FeatureTable& table_;
    const BoostOptions& options_;
    std::size_t rows_;
    const std::vector<bool>& truth_;
    std::vector<double> weights_;
    std::vector<std::vector<float>> thresholds_;
    std::vector<std::vector<std::uint8_t>> binned_;
    std::vector<Slope> slopes_;
};

}  // namespace

void FeatureTable::add(std::span<const float> row) {
    if (columns == 0) columns = row.size();
    if (row.size() != columns)
        fail_usage(fmt::format("a row of {} features among rows of {}", row.size(), columns),
                   "give the same number of features in every row");
    values.insert(values.end(), row.begin(), row.end());
}

double BoostedTrees::log_odds(std::span<const float> features) const {
    double sum = bias;
    for (const auto& tree : trees) sum += Booster::tree_value(tree, features);
    return sum;
}

JsonValue BoostedTrees::to_json(JsonAllocator& allocator) const {
    // A tree is a list of nodes in preorder: feature and threshold, then both children; for a leaf -1 and its value.
    const auto number = [](float value) {
        char text[32];
        std::snprintf(text, sizeof text, "%.4g", static_cast<double>(value));
        return std::strtod(text, nullptr);
    };
    JsonValue tree_list(rapidjson::kArrayType);
    for (const auto& tree : trees) {
        JsonValue nodes(rapidjson::kArrayType);
        const auto add = [&](const auto& self, std::size_t at) -> void {
            const Node& node = tree[at];
            nodes.PushBack(node.feature, allocator);
            nodes.PushBack(number(node.feature < 0 ? node.value : node.threshold), allocator);
            if (node.feature < 0) return;
            self(self, static_cast<std::size_t>(node.left));
            self(self, static_cast<std::size_t>(node.right));
        };
        add(add, 0);
        tree_list.PushBack(nodes, allocator);
    }
    JsonValue object(rapidjson::kObjectType);
    add_members(object, allocator, "bias", number(static_cast<float>(bias)));
    object.AddMember("trees", tree_list, allocator);
    return object;
}

BoostedTrees BoostedTrees::from_json(const JsonValue& value, std::size_t columns) {
    const auto refuse = [](const std::string& problem) { fail_input("boosted trees", problem, "train the model again"); };
    BoostedTrees model;
    if (!value.IsObject() || !value.HasMember("bias") || !value["bias"].IsNumber() || !value.HasMember("trees") ||
        !value["trees"].IsArray())
        refuse("have no bias or no list of trees");
    model.bias = static_cast<double>(static_cast<float>(value["bias"].GetDouble()));
    for (const JsonValue& nodes : value["trees"].GetArray()) {
        auto& tree = model.trees.emplace_back();
        rapidjson::SizeType at = 0;
        const auto read = [&](const auto& self, int depth) -> int {
            if (!nodes.IsArray() || at + 2 > nodes.Size() || !nodes[at].IsInt() || !nodes[at + 1].IsNumber() || depth > 64)
                refuse("have a truncated tree");
            const int feature = nodes[at].GetInt();
            const float number = static_cast<float>(nodes[at + 1].GetDouble());
            at += 2;
            const std::size_t place = tree.size();
            tree.push_back({});
            if (feature < 0) {
                tree[place].value = number;
                return static_cast<int>(place);
            }
            if (static_cast<std::size_t>(feature) >= columns) refuse("use the unknown feature " + std::to_string(feature));
            const int left = self(self, depth + 1), right = self(self, depth + 1);
            tree[place] = {feature, number, left, right, 0};
            return static_cast<int>(place);
        };
        read(read, 0);
        if (at != nodes.Size()) refuse("have a tree with unused nodes");
    }
    return model;
}

BoostedTrees boost(const FeatureTable& table, const std::vector<bool>& truth, const std::vector<double>& weights,
                   const BoostOptions& options) {
    check_options(options, "boost");
    if (truth.size() != table.rows() || (!weights.empty() && weights.size() != table.rows()))
        fail_usage("the numbers of rows, labels and weights differ", "give one of each per sample");
    const auto positives = std::count(truth.begin(), truth.end(), true);
    if (positives == 0 || static_cast<std::size_t>(positives) == truth.size())
        fail_input("samples", "all belong to one class", "give samples of both classes");
    if (!std::all_of(table.values.begin(), table.values.end(), [](float x) { return std::isfinite(x); }))
        fail_input("samples", "have features that are not finite", "check how the features are computed");
    return Booster(table, truth, weights, options).run();
}

void BoostOptions::declare_options(OptionList& list) {
    list("trees", trees, "number of trees", Range{1, 10000});
    list("depth", depth, "maximum number of decisions from root to leaf", Range{1, 16});
    list("rate", rate, "learning rate: factor on the value of each tree", Range{1e-4, 1});
    list("leaf-weight", leaf_weight, "minimum total weight of the samples of a leaf", Range{0, 1e9});
    list("ridge", ridge, "regularisation that shrinks the leaf values towards 0", Range{0, 1e9});
    list("row-share", row_share, "fraction of the samples used for each tree", Range{0.01, 1});
    list("column-share", column_share, "fraction of the features used for each tree", Range{0.01, 1});
    list("seed", seed, "random seed of the choice of samples and features", Range{0, 9007199254740992.0});
}

}  // namespace ostraka
