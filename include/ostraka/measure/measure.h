// Measures taken with ruler, tape and bounding, and simple descriptors of an annotation (thesis, sections 2.2.3 and 5, Appendix
// A).
#pragma once

#include "ostraka/annotation/annotation.h"

namespace ostraka {

/// The value of a measure on the mesh as it is, in the mesh's unit. Pins are the measure's points, or its locations where it has
/// them. ruler: Euclidean distance from pin to pin, summed. tape: shortest edge paths from pin to pin, summed (the thesis's
/// approximate geodesic: some per cent longer than the true one); a pin inside a face reaches the edges over its corners.
/// bounding: distance of the two planes across `direction` through the pins farthest apart along it. Throws Error (input), naming
/// the annotation, if a pin is out of range, the direction is missing or no path joins two pins of a tape.
double evaluate(const Mesh& mesh, const Annotation& annotation, const Measure& measure);

/// Descriptors known by name: "area", "perimeter" and "circularity" (P^2 / A) of a region, "length" of a line, "volume" enclosed
/// by a region that is all of a closed mesh. Nothing for other names or types.
std::optional<double> evaluate(const Mesh& mesh, const Annotation& annotation, const std::string& descriptor);
/// The unit of such a descriptor when lengths are in `unit` ("mm" gives "mm^2" for an area); empty if `unit` is.
std::string descriptor_unit(const std::string& descriptor, const std::string& unit);

/// The vertices of the annotation lowest and highest along a direction (ties: lower index), the pins of a bounding measure.
/// Throws Error (input) for an annotation without elements.
std::array<Index, 2> extremes(const Mesh& mesh, const Annotation& annotation, const std::array<double, 3>& direction);

struct RefreshResult {
    std::size_t computed = 0;        ///< values computed anew
    std::size_t stale = 0;           ///< values that could not be, and are marked so
    std::vector<std::string> notes;  ///< why, one line for each that stayed stale
};

/// Computes every measure and every known descriptor of the set anew and clears their marks; what cannot be computed is marked
/// stale.
RefreshResult refresh_measures(const Mesh& mesh, AnnotationSet& set);

}  // namespace ostraka
