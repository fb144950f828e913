// Measures taken with ruler, tape and bounding, and simple descriptors of an annotation (thesis, sections 2.2.3 and 5, Appendix
// A).
#pragma once

#include "ostraka/annotation/annotation.h"

namespace ostraka {

class PathSearch;

/// The value of a measure on the mesh as it is, in the mesh's unit. Pins are the measure's points, or its locations where it has
/// them. ruler: Euclidean distance from pin to pin, summed. tape: shortest edge paths from pin to pin, summed (the thesis's
/// approximate geodesic: some per cent longer than the true one), or, where the measure is `exact`, the shortest curves over the
/// faces; on edge paths a pin inside a face reaches the edges over its corners. bounding: distance of the two planes across
/// `direction` through the pins farthest apart along it. With repeats the mean over the pickings. Throws Error (input), naming
/// the annotation, if a pin is out of range, the direction is missing or no path joins two pins of a tape.
double evaluate(const Mesh& mesh, const Annotation& annotation, const Measure& measure);

/// Value and standard deviation of a measure. Each pin was set on the nearest vertex, so that its place is known to the size of
/// the faces around it: as if it lay anywhere in a disc of a third of their area A (of the area of the face that holds the pin,
/// for a location), which has the variance s^2 = A / (4 pi) in each direction. A length L then varies by r^2 = sum over the pins
/// of s^2 |dL/dp|^2, the derivatives taken along the straight lines between the pins (JCGM 100:2008, type B). Of n pickings with
/// values L_i the mean is kept, and the uncertainty is u^2 = mean r_i^2 + (sum (L_i - mean)^2 / (n - 1)) / n (type A added). What
/// an edge path is longer than the true one is not in it. Throws as `evaluate`.
struct Evaluated {
    double value = 0;
    double uncertainty = 0;
    double resolution = 0;  ///< root mean square of the r_i
    double spread = 0;      ///< sample standard deviation of the pickings; 0 if there is one
    std::size_t pickings = 1;
};
Evaluated evaluate_with_uncertainty(const Mesh& mesh, const Annotation& annotation, const Measure& measure);

/// Makes one measure of those of an annotation that have the same name, tool, number of pins and direction: the first keeps its
/// place and gets the pins of the others as repeats; value and uncertainty are left for `refresh_measures`. Measures with
/// locations stay as they are. Returns how many went into others.
std::size_t merge_pickings(Annotation& annotation);

/// Descriptors of one number known by name: "area", "perimeter", "circularity" (P^2 / A), "volume" and others of a region,
/// "length" of a line; see descriptors.h. Nothing for other names or types.
std::optional<double> evaluate(const Mesh& mesh, const Annotation& annotation, const std::string& descriptor);
/// The unit of such a descriptor when lengths are in `unit` ("mm" gives "mm^2" for an area); empty if `unit` is.
std::string descriptor_unit(const std::string& descriptor, const std::string& unit);

/// The vertices of the annotation lowest and highest along a direction (ties: lower index), the pins of a bounding measure.
/// Throws Error (input) for an annotation without elements.
std::array<Index, 2> extremes(const Mesh& mesh, const Annotation& annotation, const std::array<double, 3>& direction);

/// Whether a bounding measure is the extent of its annotation: its pins are as far apart along its direction as the annotation's
/// vertices are (to 1e-9 of that).
bool is_extent(const Mesh& mesh, const Annotation& annotation, const Measure& measure);

/// Bounding measures that are extents on `before` get the pins of the extents on `after`: the same mesh with other points and a
/// copy of its annotations, or another mesh to which these were carried. Annotations and attributes by their ids.
void move_extents(const Mesh& before, const AnnotationSet& from, const Mesh& after, AnnotationSet& to);

/// Where the pins of a measure are. A bounding measure goes from its first pin straight to the plane of the other.
std::vector<Point> pins_of(const Mesh& mesh, const Measure& measure);
/// What a measure runs along: the edges between the pins of a tape along them; empty for others.
std::vector<Point> way_of(PathSearch& search, const Mesh& mesh, const Measure& measure);

/// Adds it as an attribute of this name, under a free id.
Attribute& add_measure(Annotation& annotation, const std::string& name, Measure measure);

struct RefreshResult {
    std::size_t computed = 0;        ///< values computed anew
    std::size_t stale = 0;           ///< values that could not be, and are marked so
    std::vector<std::string> notes;  ///< why, one line for each that stayed stale
};

/// Computes every measure and every known descriptor of the set anew and clears their marks; what cannot be computed is marked
/// stale. Measures that have an uncertainty or repeats get their uncertainty anew as well; with `uncertainties` all do.
RefreshResult refresh_measures(const Mesh& mesh, AnnotationSet& set, bool uncertainties = false);

}  // namespace ostraka
