#include "ostraka/execution/parallel.h"
#include "ostraka/files/file.h"
#include "ostraka/files/json.h"
#include "ostraka/fracture/facet_evidence.h"

namespace ostraka {

std::vector<double> log_odds_of(const BoostedTrees& trees, const FeatureTable& rows) {
    std::vector<double> result(rows.rows());
    parallel_for(result.size(), [&](std::size_t r) { result[r] = trees.log_odds(rows.row(r)); });
    return result;
}

std::vector<double> FacetModel::log_odds(const FacetEvidence& evidence) const {
    std::vector<double> result = log_odds_of(trees, with_context(evidence, log_odds_of(alone, evidence.features)));
    for (double& value : result) value = shift + slope * value;
    return result;
}

const FacetModel& facet_model() {
    static const FacetModel model = [] {
        const Json document = built_in_document("facets.model");
        FacetModel result;
        const std::size_t feature_count = facet_feature_names().size();
        result.alone = BoostedTrees::from_json(document["alone"], feature_count);
        result.trees = BoostedTrees::from_json(document["trees"], feature_count + facet_context_names().size());
        result.shift = document["shift"].GetDouble();
        result.slope = document["slope"].GetDouble();
        return result;
    }();
    return model;
}

}  // namespace ostraka
