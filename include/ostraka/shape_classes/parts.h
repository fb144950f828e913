// The parts of a member: how large its regions are, where they lie, and whether its own annotations say the same.
#pragma once

#include "ostraka/shape_classes/quantities.h"

#include <span>

namespace ostraka {

/// A region that is neither empty nor the whole.
bool is_part(const Mesh& mesh, const Annotation& annotation);

/// Of each region of the template that is a part of it, as registered to a member: share of the surface; length
/// and width, the two largest sides of an even bar with the region's moments of inertia (12 times the eigenvalues of the
/// covariance over its area, their roots); distance of its centroid from that of the whole; and the distance between the
/// centroids of two regions that share an edge on the template. Lengths are shares of the root of the whole's area. A region that
/// the member has itself, in `own`, is measured there. Kind `part`; the list and its order are those of the template.
std::vector<ClassQuantity> part_quantities(const ClassTemplate& known, const std::vector<Point>& points,
                                           const WholeObject* own = nullptr);

/// Of a quantity of a part: it is a size, not a place.
bool is_size_of_part(const ClassQuantity& quantity);

/// 1 less the adjusted Rand index (Hubert and Arabie 1985), by area, of the template's regions as registered to the member and
/// the member's own: 0 where they say the same, 1 for chance. Nothing where one of them has no regions.
std::optional<double> own_disagreement(const ClassTemplate& known, const std::vector<Point>& points, const WholeObject& member);

/// Root mean square of ln(value / expected) over the pairs that both are there and positive, and which of them is farthest off.
struct PartsOff {
    double off = 0;
    std::size_t count = 0, worst = 0;  ///< `worst` is an index of the list
};
PartsOff parts_off(std::span<const std::optional<double>> values, std::span<const std::optional<double>> expected);

}  // namespace ostraka
