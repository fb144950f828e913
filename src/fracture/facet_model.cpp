#include "ostraka/core/file.h"
#include "ostraka/core/json.h"
#include "ostraka/core/parallel.h"
#include "ostraka/fracture/facet_evidence.h"

namespace ostraka {

std::vector<double> log_odds_of(const BoostedTrees& trees, const FeatureTable& table) {
    std::vector<double> result(table.rows());
    parallel_for(result.size(), [&](std::size_t r) { result[r] = trees.log_odds(table.row(r)); });
    return result;
}

std::vector<double> FacetModel::log_odds(const FacetEvidence& evidence) const {
    std::vector<double> result = log_odds_of(second, with_surroundings(evidence, log_odds_of(first, evidence.features)));
    for (double& one : result) one = shift + slope * one;
    return result;
}

const FacetModel& facet_model() {
    static const FacetModel model = [] {
        const Json document = built_in_document("facets.model");
        constexpr std::size_t around = 11;  // see with_surroundings
        const std::size_t features = facet_feature_names().size();
        FacetModel result;
        result.first = BoostedTrees::from_json(document["first"], features);
        result.second = BoostedTrees::from_json(document["second"], features + around);
        result.shift = document["shift"].GetDouble();
        result.slope = document["slope"].GetDouble();
        return result;
    }();
    return model;
}

std::string facet_model_version() {
    static const std::string version = sha256(to_text(built_in_document("facets.model")));
    return version;
}

}  // namespace ostraka
