// Quantities measured on a member of a class: its constraints, proportions, relations, attributes and geometry.
#pragma once

#include "ostraka/relation/graph.h"
#include "ostraka/shape_classes/member_fit.h"
#include "ostraka/shape_classes/shape_modes.h"
#include "ostraka/shape_classes/whole_shape.h"

namespace ostraka {

/// Kinds of quantities, in the order in which reasons are reported.
enum class QuantityKind { proportion, constraint, relation, part, attribute, geometry };
std::string to_string(QuantityKind kind);
/// The kind named by a word. Throws Error (usage) for an unknown word.
QuantityKind quantity_kind(const std::string& word);

/// A quantity of a member, with its value.
struct ClassQuantity {
    QuantityKind kind = QuantityKind::geometry;  ///< kind of quantity
    int id = -1;                       ///< id of the relationship, or of the annotation that has the attribute; -1: none
    std::string name;                  ///< name of the quantity: "little finger / ring finger", "height", "distance" ...
    std::string subject;               ///< type of the relationship, or tag of the annotation
    std::string unit = {};             ///< unit of the value; empty for shares and ratios
    bool one_sided = false;            ///< true: the quantity is a residual, which has only an upper threshold
    std::optional<double> value = {};  ///< empty: the quantity cannot be measured

    /// Text that identifies the same quantity on another member.
    [[nodiscard]] std::string key() const;
    /// Name for display.
    [[nodiscard]] std::string text() const;
};

/// The template of a class. A template stores references to its mesh, annotations and graph, which must outlive it.
struct ClassTemplate : AnnotatedMeshView {
    const RelationGraph& graph;  ///< relationships between the annotations
};

/// Moves the points (one per vertex) to the coordinate system of the template by rotation and translation and, without `sizes`,
/// scales them to the template's centroid size, so that relations, stated ranges and the upward direction have the same meaning
/// as on the template.
std::vector<Point> in_template_frame(const Mesh& mesh, const std::vector<Point>& points, bool sizes);
/// Converts points to a landmark configuration.
Landmarks landmarks_of(const std::vector<Point>& points);
/// Converts a landmark configuration to points.
std::vector<Point> points_of(const Landmarks& landmarks);

/// Measures all quantities defined on the annotations of the template at the given points: for each proportion, the ratio of
/// its measures and the deviation of the ratio from its range (per cent); for each other constraint and geometric relation, its
/// deviations (in the coordinate system of the template); for each attribute with one value, its measure or descriptor, in the
/// unit of the points. The list and its order depend only on the template. A quantity that cannot be measured has no value.
std::vector<ClassQuantity> measure_quantities(const ClassTemplate& class_template, const std::vector<Point>& points, bool sizes);

/// The residuals of a fit as quantities of kind geometry: "distance", "distance back", "unmatched", "unexplained", "stretch",
/// "bend"; they have no values for a member in correspondence.
std::vector<ClassQuantity> geometry_quantities(const std::optional<FitResiduals>& residuals);
/// Measures of an object's own surface as quantities of kind geometry: "compactness", "geodesic mean", "geodesic most", "geodesic
/// variation", "second", "fourth" and "sixth far point", "thickness mean", "thickness median", "thickness most".
std::vector<ClassQuantity> geometry_quantities(const WholeShape& shape);

/// True if the quantity is "unmatched" or "unexplained", which are shares of at most 1.
bool is_share_of_surface(const ClassQuantity& quantity);

}  // namespace ostraka
