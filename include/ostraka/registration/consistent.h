// Selects the feature matches of two surfaces that are consistent with one motion.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/registration/mesh_sift.h"

namespace ostraka {

struct ConsistentOptions {
    double tolerance = 0.02;  ///< max distance of a moved feature from its match, as a share of the size of the surfaces
    double angle = 30;        ///< max angle between the normals of a moved feature and its match, degrees
    double shrinkage = 0;     ///< max relative difference in size between the surfaces; 0: rigid motion

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Result of `consistent_matches`.
struct ConsistentMatches {
    std::vector<FeatureMatch> matches;  ///< matches consistent with `motion`, at most one per salient point of either surface
    Motion motion;                      ///< maps the points of surface `a` to surface `b`
};

/// Each match defines a motion, which maps point, normal and direction of one feature onto those of the other feature. The
/// motion that is consistent with the most matches is refined: it is fitted to these matches by least squares, repeatedly,
/// until the number of consistent matches stops growing. All matches are tried, so the result is deterministic. Time: quadratic
/// in the number of matches. The result is empty if there are no matches.
ConsistentMatches consistent_matches(const FeatureSet& a, const FeatureSet& b, const std::vector<FeatureMatch>& matches,
                                     const ConsistentOptions& options = {});

}  // namespace ostraka
