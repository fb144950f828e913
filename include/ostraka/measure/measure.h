// Measures by ruler, tape and bounding, and simple descriptors of an annotation (thesis, sections 2.2.3 and 5, Appendix A).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"

namespace ostraka {

class PathSearch;

/// The value of a measure on the current mesh, in the mesh's unit. Pins are the measure's points, or its locations if it has
/// them. ruler: sum of the Euclidean distances from pin to pin. tape: sum of the shortest edge paths from pin to pin (the
/// thesis's approximate geodesic: some per cent longer than the true one) or, if the measure is `exact`, of the shortest curves
/// over the faces; on edge paths a pin inside a face is connected to the face's corners. bounding: distance of the two planes
/// across `direction` through the pins farthest apart along it. With repeats, the mean over the repeats. Throws Error (input),
/// naming the annotation, if a pin is out of range, the direction is missing or no path joins two pins of a tape.
double evaluate(const Mesh& mesh, const Annotation& annotation, const Measure& measure);

/// Value and standard deviation of a measure. Each pin was set on the nearest vertex, so that its position is known to the size
/// of the adjacent faces: uniformly distributed in a disc whose area A is a third of theirs (or the area of the face that holds
/// the pin, for a location), which has the variance s^2 = A / (4 pi) in each direction. A length L then has the variance r^2 =
/// sum over the pins of s^2 |dL/dp|^2, with derivatives along the straight lines between the pins (JCGM 100:2008, type B). For
/// n repeats with values L_i, the value is their mean and the uncertainty is u^2 = mean r_i^2 + (sum (L_i - mean)^2 / (n - 1))
/// / n (type A added). The excess length of edge paths is not included. Throws as `evaluate`.
struct Evaluated {
    double value = 0;
    double uncertainty = 0;
    double resolution = 0;  ///< root mean square of the r_i
    double spread = 0;      ///< sample standard deviation of the repeats; 0 if there is only one
    std::size_t pickings = 1;
};
Evaluated evaluate_with_uncertainty(const Mesh& mesh, const Annotation& annotation, const Measure& measure);

/// Merges the measures of an annotation that have the same name, tool, number of pins and direction: the first one is kept and
/// gets the pins of the others as repeats; its value and uncertainty are left for `refresh_measures`. Measures with locations
/// are not changed. Returns the number of measures merged into others.
std::size_t merge_pickings(Annotation& annotation);

/// Scalar descriptors by name: "area", "perimeter", "circularity" (P^2 / A), "volume" and others of a region, "length" of a
/// line; see descriptors.h. Nothing for other names or types.
std::optional<double> evaluate(const Mesh& mesh, const Annotation& annotation, const std::string& descriptor);
/// The unit of such a descriptor if lengths are in `unit` ("mm" gives "mm^2" for an area); empty if `unit` is.
std::string descriptor_unit(const std::string& descriptor, const std::string& unit);

/// The lowest and highest vertices of the annotation along a direction (ties: lower index), the pins of a bounding measure.
/// Throws Error (input) for an annotation without elements.
std::array<Index, 2> extremes(const Mesh& mesh, const Annotation& annotation, const std::array<double, 3>& direction);

/// Whether a bounding measure is the extent of its annotation: the distance of its pins along its direction equals the extent
/// of the annotation's vertices (to a relative 1e-9).
bool is_extent(const Mesh& mesh, const Annotation& annotation, const Measure& measure);

/// Bounding measures that are extents on `before` get the pins of the extents on `after`: the same mesh with other points and a
/// copy of its annotations, or another mesh to which these were transferred. Matches annotations and attributes by their ids.
void move_extents(AnnotatedMeshView before, const Mesh& after, AnnotationSet& to);

/// The positions of the pins of a measure. A bounding measure goes from its first pin straight to the plane of the other.
std::vector<Point> pins_of(const Mesh& mesh, const Measure& measure);
/// The path of a measure: the edges between the pins of a tape along them; empty for others.
std::vector<Point> path_of_measure(PathSearch& search, const Mesh& mesh, const Measure& measure);

/// Adds the measure as an attribute of this name, with a new id.
Attribute& add_measure(Annotation& annotation, const std::string& name, Measure measure);

struct RefreshResult {
    std::size_t computed = 0;        ///< number of recomputed values
    std::size_t stale = 0;           ///< number of values that could not be computed, marked as stale
    std::vector<std::string> notes;  ///< why, one line for each stale value
};

/// Recomputes every measure and every known descriptor of the set and clears their stale marks; values that cannot be computed
/// are marked stale. Recomputes the uncertainty of measures that have one or repeats; with `uncertainties`, of all measures.
RefreshResult refresh_measures(const Mesh& mesh, AnnotationSet& set, bool uncertainties = false);

}  // namespace ostraka
