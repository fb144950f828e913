// Per-patch features that separate fracture from intact surface.
#pragma once

#include "ostraka/fracture/facet_graph.h"
#include "ostraka/stats/boosted_trees.h"

#include <array>
#include <string>
#include <vector>

namespace ostraka {

/// Points spread evenly over the surface of a fragment.
struct PatchSamples {
    std::vector<Point> points;  ///< positions of the samples
    std::vector<Index> patch;   ///< for each point: index of its patch
};

/// For each patch: the samples (PatchSamples) in a neighbourhood of the patch.
struct Neighbourhoods {
    double radius = 0;  ///< radius of the neighbourhoods
    /// Entries first[p] to first[p + 1] - 1 of `samples` belong to patch p; the vector has one entry more than there are
    /// patches.
    std::vector<std::size_t> first;
    std::vector<Index> samples;  ///< indices of sample points, patch by patch
};

/// Features of the patches of a fragment, and the data from which they are computed. Lengths in the features are divided by the
/// square root of the fragment's area, so that the features do not depend on unit and pose.
struct FacetEvidence {
    FacetGraph graph;
    Walls walls;
    PatchSamples samples;
    std::array<Neighbourhoods, 4> around;  ///< neighbourhoods of each patch at four radii, smallest radius first
    /// For each patch: index of its part (convex_parts) in two segmentations: parts bounded by sharp convex edges, and smaller
    /// parts bounded also by less sharp convex edges.
    std::array<std::vector<std::size_t>, 2> parts;
    std::vector<double> convexity;  ///< for each patch: measure of how convex the surface is around the patch
    FeatureTable features;          ///< features of the patches, one row per patch
};

/// Computes the features of all patches. Throws Error (input) for a mesh without area.
FacetEvidence facet_evidence(const Mesh& mesh);
/// Names of the features of `facet_evidence`, in the order of the columns.
const std::vector<std::string>& facet_feature_names();

/// Appends context features to the features of each patch. The context features are aggregates of `log_odds` (of fracture
/// surface, one per patch) over the patch's neighbourhoods, over its part, and over the whole fragment.
FeatureTable with_context(const FacetEvidence& evidence, const std::vector<double>& log_odds);
/// Names of the context features, in the order of the columns.
const std::vector<std::string>& facet_context_names();

/// Classifier of patches as fracture surface or intact surface. The log odds are calibrated on objects that were not used to
/// train the trees.
struct FacetModel {
    BoostedTrees alone;  ///< first stage: uses only the features of the patch
    /// Second stage: uses the features of the patch and the context features computed from the log odds of `alone` (Tu and Bai
    /// 2010).
    BoostedTrees trees;
    double shift = 0, slope = 1;  ///< the calibrated log odds are shift + slope * (log odds predicted by `trees`)

    /// Calibrated log odds of fracture surface, per patch.
    [[nodiscard]] std::vector<double> log_odds(const FacetEvidence& evidence) const;
};

/// The built-in model (data/facets.model.json).
const FacetModel& facet_model();

/// Log odds predicted for each row of a feature table.
std::vector<double> log_odds_of(const BoostedTrees& trees, const FeatureTable& rows);

}  // namespace ostraka
