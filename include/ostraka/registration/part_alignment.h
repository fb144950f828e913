// Registers a part of a surface to the whole: one-way ICP.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/geom/surface_search.h"

#include <vector>

namespace ostraka {

struct PartAlignmentOptions {
    /// Share of the pairs that are kept: those of smallest distance. Surface of the part that the whole does not have is
    /// excluded in this way.
    double trim = 0.8;
    double search_radius = 0.1;  ///< max distance of a pair, as a share of the whole's diagonal
    double angle = 60;           ///< max angle between the normals of a pair, degrees
    double anchors = 1;          ///< weight of all anchors together, relative to the weight of all pairs together
    int samples = 3000;          ///< number of points of the part, evenly spread, that are registered to the whole
    int iterations = 60;         ///< max number of iterations

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A point of the part and the corresponding point of the whole.
struct Anchor {
    Eigen::Vector3d of_part, of_whole;  ///< position on the part, and position on the whole
    bool operator==(const Anchor&) const = default;
};

/// Result of `align_part`.
struct PartAlignment {
    Motion pose;             ///< rigid motion from the part onto the whole
    double residual = 0;     ///< root mean square point-to-plane distance of the kept pairs, in the unit of the coordinates
    double overlap = 0;      ///< share of the samples that have a pair
    int iterations = 0;      ///< number of iterations
    bool converged = false;  ///< true: the iteration converged, that is the last step did not change the pose
};

/// Registers a part to the whole by trimmed ICP (Chetverikov, Stepanov and Krsek 2005), point to plane (Chen and Medioni 1992),
/// from the pose `start`: samples of the faces marked in `of_part` (all faces if empty) are paired with the nearest point of the
/// whole that has a compatible normal, and the share `trim` of smallest distance is kept; anchors count as point pairs. Each step
/// is a linear least squares problem for rotation and translation; motions that the pairs do not constrain (on a sphere, a plane,
/// a cylinder) are left out of the step. Returns the pose with the smallest residual of all steps. Throws Error (input) for a
/// part without area.
PartAlignment align_part(const Mesh& part, const std::vector<bool>& of_part, const SurfaceSearch& whole, const Motion& start,
                         const std::vector<Anchor>& anchors = {}, const PartAlignmentOptions& options = {});

}  // namespace ostraka
