// Matches of features that one motion explains.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/registration/mesh_sift.h"

namespace ostraka {

struct ConsistentOptions {
    double tolerance = 0.02;  ///< how far a feature may lie from its match once moved, as a share of the size
    double angle = 30;        ///< and how far their normals may differ, degrees
    double shrinkage = 0;     ///< casts may differ in size by up to this share; 0: rigid

    void describe(OptionList& visit);
};

struct ConsistentMatches {
    std::vector<FeatureMatch> matches;  ///< those that `motion` explains, at most one for each salient point of either surface
    Motion motion;                      ///< from the places of `a` to those of `b`
};

/// Every match says how one surface would have to be moved onto the other (point, normal and direction onto point, normal and
/// direction); the motion that explains most of the matches is fitted to those (least squares) and asked again until no more are
/// explained. All matches are tried, so that nothing is left to chance: time is the square of their number. Empty without
/// matches.
ConsistentMatches consistent_matches(const FeatureSet& a, const FeatureSet& b, const std::vector<FeatureMatch>& matches,
                                     const ConsistentOptions& options = {});

}  // namespace ostraka
