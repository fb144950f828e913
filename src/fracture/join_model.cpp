#include "ostraka/fracture/join_evidence.h"

#include "ostraka/files/file.h"
#include "ostraka/files/json.h"
#include "ostraka/stats/boosted_trees.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ostraka {

namespace {

/// Per candidate: boosted trees over its features. Per pair: logistic regression over a candidate's log odds and its lead.
struct JoinModel {
    BoostedTrees trees;
    std::array<double, JoinEvidence::count> usual{}, spread{};  ///< per feature over true joins: mean, standard deviation
    std::array<double, 3> pair{};                               ///< bias, weight of the log odds, weight of the lead
    double joined = 0.5;  ///< share of the training pairs whose first candidate is the true join
};
constexpr double max_lead = 2;

/// The built-in model (data/joins.model.json).
const JoinModel& join_model() {
    static const JoinModel model = [] {
        JoinModel result;
        const Json document = built_in_document("joins.model");
        const auto read = [&](const char* name, auto& values) {
            const JsonValue& numbers = document[name];
            for (std::size_t k = 0; k < values.size(); ++k) values[k] = numbers[static_cast<rapidjson::SizeType>(k)].GetDouble();
        };
        result.trees = BoostedTrees::from_json(document["trees"], JoinEvidence::count);
        result.joined = document["joined"].GetDouble();
        read("usual", result.usual);
        read("spread", result.spread);
        read("pair", result.pair);
        return result;
    }();
    return model;
}

}  // namespace

double join_log_odds(const JoinEvidence& evidence) {
    const auto features = evidence.features();
    const std::vector<float> row(features.begin(), features.end());
    return join_model().trees.log_odds(row);
}

double join_probability(double log_odds, double lead) {
    const JoinModel& model = join_model();
    return 1 /
           (1 + std::exp(-(model.pair[0] + model.pair[1] * log_odds + model.pair[2] * std::clamp(lead, -max_lead, max_lead))));
}

double join_log_odds_correction(std::size_t fragments) {
    constexpr double neighbours = 4;  // of a sherd, about
    const double usual = join_model().joined,
                 joined_share = std::min(usual, neighbours / std::max(1.0, static_cast<double>(fragments) - 1));
    return std::log(joined_share / (1 - joined_share)) - std::log(usual / (1 - usual));
}

std::string join_model_version() {
    static const std::string version = sha256(to_text(built_in_document("joins.model")));
    return version;
}

std::string weakest_evidence(const JoinEvidence& evidence) {
    const JoinModel& model = join_model();
    const auto features = evidence.features();
    std::size_t worst = 0;
    const auto below = [&](std::size_t k) { return (model.usual[k] - features[k]) / model.spread[k]; };
    for (std::size_t k = 1; k < features.size(); ++k)
        if (JoinEvidence::is_join_feature(k) && below(k) > below(worst)) worst = k;
    return fmt::format("there is too little evidence of \"{}\"", JoinEvidence::names()[worst]);
}

}  // namespace ostraka
