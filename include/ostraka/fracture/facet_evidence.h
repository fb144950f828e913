// What the surface of a fragment shows by which a break is told from intact surface.
#pragma once

#include "ostraka/fracture/facet_graph.h"
#include "ostraka/stats/boosted_trees.h"

#include <string>
#include <vector>

namespace ostraka {

/// Lengths among the features are measured in the square root of the fragment's area, so that neither unit nor place matters.
struct FacetEvidence {
    FacetGraph graph;
    Walls walls;
    FeatureTable features;  ///< a row a patch
    static const std::vector<std::string>& names();
};

/// Throws Error (input) for a mesh without area.
FacetEvidence facet_evidence(const Mesh& mesh);

/// What tells a break by these features: trees, whose log odds are then calibrated on objects the trees were not made from.
struct FacetModel {
    BoostedTrees trees;
    double shift = 0, slope = 1;  ///< calibrated log odds: shift + slope * those of the trees

    [[nodiscard]] std::vector<double> log_odds(const FeatureTable& features) const;
};
/// The one that is built in (data/facets.model.json), and its SHA-256.
const FacetModel& facet_model();
std::string facet_model_version();

}  // namespace ostraka
