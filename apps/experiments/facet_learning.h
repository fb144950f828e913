// Trains the fracture model; each fragment is evaluated by trees trained without its object.
#pragma once

#include "facet_cases.h"

#include "ostraka/fracture/facet_evidence.h"

namespace ostraka::experiments {

/// A fragment with its features.
struct SeenFragment {
    FacetCase given;
    FacetEvidence evidence;
    std::vector<double> broken;        ///< per patch: area share of fracture
    std::vector<std::size_t> sampled;  ///< patches used for training, drawn by area
    double seconds = 0;
    std::size_t fold = 0;  ///< cross-validation fold of its object
};

bool is_known(const FacetCase& one, Face f);
SeenFragment seen_fragment(FacetCase given);

struct LearntFacets {
    FacetModel model;  ///< trained on all fragments
    std::vector<std::vector<double>>
        log_odds;  ///< for each fragment's patches: calibrated, from trees trained without its object
};

/// `folds`: number of folds. Trees that use the context of patches get it from trees trained without the fragment's object.
LearntFacets learn_facets(const std::vector<SeenFragment>& all, std::size_t folds, const BoostOptions& options);

}  // namespace ostraka::experiments
