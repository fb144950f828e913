// A part of a surface registered to the whole: iterative closest points, one way.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/geom/surface_search.h"

#include <vector>

namespace ostraka {

struct PartAlignmentOptions {
    double trim = 0.8;           ///< share of the pairs that count, the nearest ones: what is not on the whole stays out
    double search_radius = 0.1;  ///< farthest pair, as a share of the whole's diagonal
    double angle = 60;           ///< pairs whose normals differ by more are none, degrees
    double anchors = 1;          ///< weight of all anchors together against that of all pairs
    int samples = 3000;          ///< points of the part that are registered to the whole, evenly spread
    int iterations = 60;

    void describe(OptionList& visit);
};

/// A place of the part that belongs to a place of the whole.
struct Anchor {
    Eigen::Vector3d of_part, of_whole;
    bool operator==(const Anchor&) const = default;
};

struct PartAlignment {
    Motion pose;          ///< rigid, of the part onto the whole
    double residual = 0;  ///< root mean square distance from the planes of the pairs that count, in the unit of the points
    double overlap = 0;   ///< share of the samples that have a pair
    int iterations = 0;
    bool settled = false;  ///< the last step moved nothing any more
};

/// Trimmed iterative closest points (Chetverikov, Stepanov and Krsek 2005), point to plane (Chen and Medioni 1992), from `start`:
/// samples of the faces marked in `of_part` (all if empty) are paired with the nearest point of the whole whose normal agrees,
/// the nearest `trim` of them kept; anchors count as pairs of points. Each step is a linear least squares problem for turn and
/// shift; motions that the pairs leave open (a sphere, a plane, a cylinder) are not made. The best pose met is kept. Throws Error
/// (input) for a part without area.
PartAlignment align_part(const Mesh& part, const std::vector<bool>& of_part, const SurfaceSearch& whole, const Motion& start,
                         const std::vector<Anchor>& anchors = {}, const PartAlignmentOptions& options = {});

}  // namespace ostraka
