#include "ostraka/core/file.h"
#include "ostraka/core/json.h"
#include "ostraka/core/parallel.h"
#include "ostraka/fracture/facet_evidence.h"

namespace ostraka {

std::vector<double> FacetModel::log_odds(const FacetEvidence& evidence) const {
    std::vector<double> result(evidence.features.rows());
    parallel_for(result.size(), [&](std::size_t r) { result[r] = shift + slope * trees.log_odds(evidence.features.row(r)); });
    return result;
}

const FacetModel& facet_model() {
    static const FacetModel model = [] {
        const Json document = built_in_document("facets.model");
        FacetModel result;
        result.trees = BoostedTrees::from_json(document["trees"], facet_feature_names().size());
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
