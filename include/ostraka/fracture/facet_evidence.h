// What the surface of a fragment shows by which a break is told from intact surface.
#pragma once

#include "ostraka/fracture/facet_graph.h"
#include "ostraka/stats/boosted_trees.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// Points spread evenly over the surface, and the patch that each lies on.
struct PatchSamples {
    std::vector<Point> points;
    std::vector<Index> patch;
};

/// The samples about each patch.
struct Neighbourhoods {
    double radius = 0;
    std::vector<std::size_t> first;  ///< of each patch, where its samples begin; and the end
    std::vector<Index> samples;
};

/// Lengths among the features are measured in the square root of the fragment's area, so that neither unit nor place matters.
struct FacetEvidence {
    FacetGraph graph;
    Walls walls;
    PatchSamples samples;
    std::array<Neighbourhoods, 4> around;           ///< the smallest first
    std::array<std::vector<std::size_t>, 2> parts;  ///< of each patch, between convex edges: sharp ones, and less sharp ones
    std::vector<double> convexity;                  ///< of each patch: how sharply the surface turns outward about it
    FeatureTable features;                          ///< a row a patch
};

/// Throws Error (input) for a mesh without area.
FacetEvidence facet_evidence(const Mesh& mesh);
/// In the order of the features.
const std::vector<std::string>& facet_feature_names();

/// The features, and what log odds of the patches say of their neighbourhoods, parts and the whole fragment.
FeatureTable with_context(const FacetEvidence& evidence, const std::vector<double>& log_odds);
/// In the order of those that context adds.
const std::vector<std::string>& facet_context_names();

/// What tells a break by these features. Its log odds are calibrated on objects that the trees were not made from.
struct FacetModel {
    BoostedTrees alone;           ///< by what a patch shows itself
    BoostedTrees trees;           ///< by that, and by what `alone` says of its surroundings (Tu and Bai 2010)
    double shift = 0, slope = 1;  ///< calibrated log odds: shift + slope * those of the trees

    [[nodiscard]] std::vector<double> log_odds(const FacetEvidence& evidence) const;
};

/// The model that is built in (data/facets.model.json), and its SHA-256.
const FacetModel& facet_model();
std::string facet_model_version();

/// Of each row.
std::vector<double> log_odds_of(const BoostedTrees& trees, const FeatureTable& rows);

}  // namespace ostraka
