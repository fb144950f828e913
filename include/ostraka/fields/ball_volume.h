// Integral invariants: the share of balls of several radii that the solid below the surface fills.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <vector>

namespace ostraka {

/// Shares of balls around the vertices that lie in the solid, one row per vertex and one column per radius.
struct BallVolumes {
    std::size_t scales = 0;      ///< number of radii
    std::vector<double> shares;  ///< row by row; NaN at vertices nearer to the border than the radius, and without faces
    /// The values of one radius, one per vertex.
    [[nodiscard]] std::vector<double> at_scale(std::size_t scale) const;
};

/// The volume integral invariant (Manay et al. 2004; Pottmann et al. 2009; for writing and relief Mara et al. 2010): the share of
/// the ball of radius r around each vertex that lies in the solid. It is 1/2 on planes, 1/2 - 3r / (16 R) on a sphere of radius
/// R, more than 1/2 in grooves. With the field x / 3 (1 - r^3 / |x|^3), whose divergence is 1 and which vanishes on the ball, the
/// volume is r^3 w / 3 plus the flux through the faces in the ball, where w is the solid angle of the vertex; so the volumes of
/// all radii need one pass over the faces of the largest ball. Faces are summed exactly near the vertex, in clusters whose
/// radius is at most a tenth of their distance farther away; the error is of second order in this ratio. O(n log n) and O(log
/// n) per vertex, largely independent of the number of radii. The result is the same for any number of threads. Throws Error
/// (usage) unless the radii are positive, finite and ascending, (input) for a mesh without area.
BallVolumes ball_volumes(const Mesh& mesh, const std::vector<double>& radii);

}  // namespace ostraka
