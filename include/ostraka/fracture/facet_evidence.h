// Per-patch features that separate fracture from intact surface.
#pragma once

#include "ostraka/fracture/facet_graph.h"
#include "ostraka/stats/boosted_trees.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// Points spread evenly over the surface, and the patch of each.
struct PatchSamples {
    std::vector<Point> points;
    std::vector<Index> patch;
};

/// The samples around each patch.
struct Neighbourhoods {
    double radius = 0;
    std::vector<std::size_t> first;  ///< per patch, the index of its first sample; one more entry for the end
    std::vector<Index> samples;
};

/// Lengths in the features are divided by the square root of the fragment's area, so that the features do not depend on the
/// unit or the pose.
struct FacetEvidence {
    FacetGraph graph;
    Walls walls;
    PatchSamples samples;
    std::array<Neighbourhoods, 4> around;           ///< smallest radius first
    std::array<std::vector<std::size_t>, 2> parts;  ///< per patch, its part between convex edges: sharp ones, and less sharp ones
    std::vector<double> convexity;                  ///< per patch, how sharply the surface turns outward around it
    FeatureTable features;                          ///< one row per patch
};

/// Throws Error (input) for a mesh without area.
FacetEvidence facet_evidence(const Mesh& mesh);
/// Names of the features, in their order.
const std::vector<std::string>& facet_feature_names();

/// Appends context features: the log odds aggregated over the neighbourhood and the part of each patch and over the whole
/// fragment.
FeatureTable with_context(const FacetEvidence& evidence, const std::vector<double>& log_odds);
/// Names of the context features, in their order.
const std::vector<std::string>& facet_context_names();

/// Classifier of fracture surface. Its log odds are calibrated on objects that were not used to train the trees.
struct FacetModel {
    BoostedTrees alone;           ///< uses the features of the patch only
    BoostedTrees trees;           ///< uses these and the context features from the log odds of `alone` (Tu and Bai 2010)
    double shift = 0, slope = 1;  ///< calibrated log odds: shift + slope * log odds of `trees`

    [[nodiscard]] std::vector<double> log_odds(const FacetEvidence& evidence) const;
};

/// The built-in model (data/facets.model.json).
const FacetModel& facet_model();

/// Log odds of each row.
std::vector<double> log_odds_of(const BoostedTrees& trees, const FeatureTable& rows);

}  // namespace ostraka
