// The parts of a member: the size and position of its regions, and their agreement with the member's own annotations.
#pragma once

#include "ostraka/shape_classes/quantities.h"

#include <span>

namespace ostraka {

/// Whether the annotation is a region that is neither empty nor the whole mesh.
bool is_part(const Mesh& mesh, const Annotation& annotation);

/// Measures each part of the template as registered to a member: its share of the surface; its length and width, the two largest
/// sides of a uniform bar with the region's moments of inertia (square roots of 12 times the eigenvalues of the area covariance);
/// the distance of its centroid from the centroid of the whole; and the distance between the centroids of two regions that share
/// an edge on the template. Lengths are relative to the square root of the total area. Parts for which `member` has its own
/// region are measured on that region. The quantities have kind `part`; the list and its order depend only on the template.
std::vector<ClassQuantity> part_quantities(const ClassTemplate& class_template, const std::vector<Point>& points,
                                           const WholeObject* member = nullptr);

/// Whether a quantity of a part is a size; otherwise it is a position.
bool is_size_of_part(const ClassQuantity& quantity);

/// 1 minus the area-weighted adjusted Rand index (Hubert and Arabie 1985) between the template's regions as registered to the
/// member and the member's own regions: 0 for equal regions, 1 for chance agreement. Empty if the template or the member has no
/// regions.
std::optional<double> own_disagreement(const ClassTemplate& class_template, const std::vector<Point>& points,
                                       const WholeObject& member);

/// Deviation of a list of values from expected values: root mean square of ln(value / expected) over the pairs where both exist
/// and are positive.
struct PartsDeviation {
    double off = 0;                    ///< root mean square deviation
    std::size_t count = 0, worst = 0;  ///< number of such pairs; index in the list of the pair that deviates most
};
/// Deviation of the values from the expected values, both in the same order.
PartsDeviation parts_deviation(std::span<const std::optional<double>> values, std::span<const std::optional<double>> expected);

}  // namespace ostraka
