// The model of breaks learnt from fragments, each judged by trees that have not seen its object.
#pragma once

#include "facet_cases.h"

#include "ostraka/fracture/facet_evidence.h"

namespace ostraka::experiments {

/// A fragment with what it shows.
struct SeenFragment {
    FacetCase given;
    FacetEvidence evidence;
    std::vector<double> broken;        ///< of each patch: share of its area
    std::vector<std::size_t> sampled;  ///< patches that the model learns from, drawn by area
    double seconds = 0;
    std::size_t fold = 0;  ///< that of its object
};

bool is_known(const FacetCase& one, Face f);
SeenFragment seen_fragment(FacetCase given);

struct LearntFacets {
    FacetModel model;  ///< from all
    std::vector<std::vector<double>>
        log_odds;  ///< of each fragment's patches, calibrated, by trees that have not seen its object
};

/// `folds`: how many. Trees that are told of the surroundings are told what trees say that have not seen the fragment's object.
LearntFacets learn_facets(const std::vector<SeenFragment>& all, std::size_t folds, const BoostOptions& options);

}  // namespace ostraka::experiments
