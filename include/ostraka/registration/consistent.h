// Selects feature matches that are consistent with one motion.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/registration/mesh_sift.h"

namespace ostraka {

struct ConsistentOptions {
    double tolerance = 0.02;  ///< max distance of a moved feature from its match, as a share of the size
    double angle = 30;        ///< max angle between their normals, degrees
    double shrinkage = 0;     ///< casts may differ in size by up to this share; 0: rigid

    void describe(OptionList& visit);
};

struct ConsistentMatches {
    std::vector<FeatureMatch> matches;  ///< matches consistent with `motion`, at most one per salient point of either surface
    Motion motion;                      ///< from the points of `a` to those of `b`
};

/// Each match defines a motion (point, normal and direction onto point, normal and direction). The motion that is consistent
/// with most matches is fitted to those by least squares, repeatedly until their number stops growing. Tries all matches, hence
/// deterministic; time is quadratic in their number. Empty without matches.
ConsistentMatches consistent_matches(const FeatureSet& a, const FeatureSet& b, const std::vector<FeatureMatch>& matches,
                                     const ConsistentOptions& options = {});

}  // namespace ostraka
