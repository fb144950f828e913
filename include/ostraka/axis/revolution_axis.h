// Axis and diameter of a surface of revolution, such as the vessel of a sherd, with 95 % intervals.
#pragma once

#include "ostraka/axis/axis.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Options of `revolution_axis`.
struct RevolutionAxisOptions {
    double out_of_round = 0.005;  ///< typical deviation of such vessels from roundness, as a share of the radius; 0: round
    double max_interval = 0.1;    ///< widest interval of a diameter that counts as determined, as a share of the diameter

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A diameter with its 95 % interval, in the mesh's unit.
struct DiameterEstimate {
    std::string name;                                       ///< "rim diameter" or "largest diameter"
    double value = 0;                                       ///< median of the posterior
    double low = 0;                                         ///< lower bound
    double high = std::numeric_limits<double>::infinity();  ///< upper bound; infinite if there is none
};

/// An axis with its intervals.
struct RevolutionAxis {
    Axis axis;  ///< the axis, or the reason why there is none; its figures contain the diameters too
    /// The diameter at the rim, if there is one, and at the widest place; empty if the part determines no intervals.
    std::vector<DiameterEstimate> diameters;
    bool undetermined = false;  ///< true: there is no axis because the interval of the first diameter is too wide
    /// Unit vector along the axis from the part towards its rim; empty if there is no axis or no rim.
    std::optional<Vector> rim_direction = std::nullopt;
};

/// Axis and diameter of a surface of revolution with 95 % intervals. The estimate starts at `rotation_axis` and at several tilted
/// lines. The walls are split into connected sheets (outer side, inner side, lip, floor) whose profiles are splines about one
/// common axis; vertices are weighted by the noise estimated for their sheet, and neighbours that deviate together count less.
/// Deviations from roundness (second and third harmonics of the radius, changing with height, and an uneven lip) are parameters
/// with a prior of several amplitudes, of which `out_of_round` is the typical one. Profiles and deviations are linear and are
/// integrated out (variable projection, Golub and Pereyra 1973). The axis has Jeffreys' prior; its posterior, which for short
/// arcs is far from normal, is sampled by adaptive importance sampling with the seed of `axis`. Figures: the diameters, per cent
/// of the circle preserved, rms distance from the profile, standard errors of the direction and of the diameter, and the angle
/// and the distance at the part's centroid within which 95 % of the axes lie. The rim is the top of a lip that ends the walls.
/// There is no axis for the reasons of `rotation_axis` (flat, spherical or not rotationally symmetric parts) or if the interval
/// of the first diameter is wider than `max_interval`. A part with fewer than 40 vertices on its walls has the result of
/// `rotation_axis`, without intervals. Throws Error (input) if there are no faces with area, (usage) for options out of range.
/// Time: linear in the number of faces, and about a second for the posterior.
RevolutionAxis revolution_axis(const Mesh& mesh, const std::vector<Index>& faces, const AxisOptions& axis = {},
                               const RevolutionAxisOptions& options = {});

}  // namespace ostraka
