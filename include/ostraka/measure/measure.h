// Measures between pins (ruler, tape, bounding), and simple descriptors of an annotation (thesis, sections 2.2.3 and 5,
// Appendix A).
#pragma once

#include "ostraka/annotation/annotated_mesh.h"

namespace ostraka {

class PathSearch;

/// The value of a measure on the given mesh, in the mesh's unit. The pins are the measure's points or, if given, its locations.
/// ruler: sum of the Euclidean distances from pin to pin. tape: sum of the shortest edge paths from pin to pin (the thesis's
/// approximate geodesic, which is a few per cent longer than the exact geodesic) or, if the measure is `exact`, of the shortest
/// curves over the faces; on edge paths a pin inside a face is connected to the face's corners. bounding: distance of two planes
/// perpendicular to `direction` through the two pins that are farthest apart in this direction. If the measure has repeats, the
/// value is the mean over the repeats. Throws Error (input), naming the annotation, if a pin is out of range, the direction is
/// missing or no path joins two pins of a tape.
double evaluate(const Mesh& mesh, const Annotation& annotation, const Measure& measure);

/// Value and standard deviation of a measure. A picked pin was moved to the closest vertex, so that its true position is
/// uncertain by the size of the adjacent faces. The position is modelled as uniformly distributed in a disc whose area A is a
/// third of the total area of these faces (for a pin inside a face: the area of this face). The position then has the variance
/// s^2 = A / (4 pi) in each direction. A length L then has the variance r^2 = sum over the pins of s^2 |dL/dp|^2, with
/// derivatives along the straight lines between the pins (JCGM 100:2008, type B). For n repeats with values L_i, the value is
/// their mean and the uncertainty is u^2 = mean r_i^2 + (sum (L_i - mean)^2 / (n - 1)) / n (type A added). The error of edge
/// paths, which are longer than geodesics, is not included. Throws the same errors as `evaluate`.
struct Evaluated {
    double value = 0;          ///< value of the measure, in the mesh's unit
    double uncertainty = 0;    ///< standard deviation u of the value
    double resolution = 0;     ///< root mean square of the standard deviations r_i due to pin positions
    double spread = 0;         ///< sample standard deviation of the values of the repeats; 0 for a single picking
    std::size_t pickings = 1;  ///< number of pickings
};
/// Value and standard deviation of a measure.
Evaluated evaluate_with_uncertainty(const Mesh& mesh, const Annotation& annotation, const Measure& measure);

/// Merges the measures of an annotation that have the same name, tool, number of pins and direction: the first of these measures
/// is kept and gets the pins of the other measures as repeats; `refresh_measures` must then recompute its value and uncertainty.
/// Measures with locations are not changed. Returns the number of measures merged into others.
std::size_t merge_pickings(Annotation& annotation);

/// Value of a scalar descriptor by name: "area", "perimeter", "circularity" (perimeter^2 / area), "volume" and others of a
/// region, "length" of a line; see descriptors.h. None for other names or types of annotation.
std::optional<double> evaluate(const Mesh& mesh, const Annotation& annotation, const std::string& descriptor);
/// The unit of a descriptor if lengths are in `unit` ("mm" gives "mm^2" for an area); empty if `unit` is empty.
std::string descriptor_unit(const std::string& descriptor, const std::string& unit);

/// The pins of a bounding measure: the lowest and the highest vertex of the annotation along a direction (ties: lower index).
/// Throws Error (input) for an annotation without elements.
std::array<Index, 2> extremes(const Mesh& mesh, const Annotation& annotation, const std::array<double, 3>& direction);

/// True if a bounding measure is the extent of its annotation: the distance of its pins along its direction equals the extent of
/// the annotation's vertices (up to a relative difference of 1e-9).
bool is_extent(const Mesh& mesh, const Annotation& annotation, const Measure& measure);

/// Updates the pins of bounding measures that are extents on `before` (`is_extent`), so that they are extents on `after`.
/// `after` is the same mesh with other points and `to` a copy of its annotations, or `after` is another mesh to which the
/// annotations were transferred. Annotations and attributes are matched by id.
void move_extents(AnnotatedMeshView before, const Mesh& after, AnnotationSet& to);

/// The positions of the pins of a measure. For a bounding measure: the first pin, and its projection onto the plane through the
/// second pin perpendicular to the direction.
std::vector<Point> pins_of(const Mesh& mesh, const Measure& measure);
/// The path of a tape measure along edges, from pin to pin; empty for other measures.
std::vector<Point> path_of_measure(PathSearch& search, const Mesh& mesh, const Measure& measure);

/// Adds the measure as an attribute of this name, with a new id.
Attribute& add_measure(Annotation& annotation, const std::string& name, Measure measure);

/// Result of `refresh_measures`.
struct RefreshResult {
    std::size_t computed = 0;        ///< number of recomputed values
    std::size_t stale = 0;           ///< number of values that could not be computed, marked as stale
    std::vector<std::string> notes;  ///< reasons why values are stale, one line per stale value
};

/// Recomputes every measure and every known descriptor of the set and clears the stale marks; values that cannot be computed are
/// marked stale. The uncertainty is recomputed for measures that have an uncertainty or repeats; with `uncertainties`, for all
/// measures.
RefreshResult refresh_measures(const Mesh& mesh, AnnotationSet& set, bool uncertainties = false);

}  // namespace ostraka
