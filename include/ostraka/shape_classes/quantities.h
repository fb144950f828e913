// What is measured of a member of a class: its constraints, proportions, relations and attributes, and its geometry.
#pragma once

#include "ostraka/relation/graph.h"
#include "ostraka/shape_classes/member_fit.h"
#include "ostraka/shape_classes/shape_modes.h"
#include "ostraka/shape_classes/whole_shape.h"

namespace ostraka {

/// In the order in which reasons are reported.
enum class QuantityKind { proportion, constraint, relation, part, attribute, geometry };
std::string to_string(QuantityKind kind);
/// Throws Error (usage) for another word.
QuantityKind quantity_kind(const std::string& word);

/// One number of a member.
struct ClassQuantity {
    QuantityKind kind = QuantityKind::geometry;
    int id = -1;             ///< of the relationship, or of the annotation an attribute belongs to
    std::string name;        ///< "little finger / ring finger", "height", "distance" ...
    std::string of;          ///< type of the relationship, tag of the annotation
    std::string unit = {};   ///< "" for shares and ratios
    bool one_sided = false;  ///< a residual: less is never worse
    std::optional<double> value = {};

    /// Who it is the same quantity as, on another member.
    [[nodiscard]] std::string key() const;
    /// For people.
    [[nodiscard]] std::string text() const;
};

/// The template of a class. What is named outlives it.
struct ClassTemplate {
    const Mesh& mesh;
    const AnnotationSet& set;
    const RelationGraph& graph;
};

/// The points (a row a vertex) carried to where the template is: turned and shifted onto it, and without `sizes` brought to its
/// centroid size, so that relations, stated ranges and the upward direction mean what they mean on the template.
std::vector<Point> in_template_frame(const Mesh& mesh, const std::vector<Point>& points, bool sizes);
Landmarks landmarks_of(const std::vector<Point>& points);
std::vector<Point> points_of(const Landmarks& landmarks);

/// All that is measured on the annotations of the template at the given points: of each proportion the ratio of its measures and
/// what it is out of range (per cent), of the other constraints and of the geometric relations their deviations (these in the
/// frame of the template), of attributes the values of measures and descriptors of one number, in the points' own unit. The list
/// and its order are those of the template, whatever the points. What cannot be measured has no value.
std::vector<ClassQuantity> measure_quantities(const ClassTemplate& known, const std::vector<Point>& points, bool sizes);

/// The residuals of a fit as quantities of kind geometry: "distance", "distance back", "unmatched", "unexplained", "stretch",
/// "bend"; without values in correspondence.
std::vector<ClassQuantity> geometry_quantities(const std::optional<FitResiduals>& residuals);
/// The same of an object's own surface: "compactness", "geodesic mean", "geodesic most", "geodesic variation", "second", "fourth"
/// and "sixth far point", "thickness mean", "thickness median", "thickness most".
std::vector<ClassQuantity> geometry_quantities(const WholeShape& shape);

/// "unmatched" and "unexplained": never above 1.
bool is_share_of_surface(const ClassQuantity& quantity);

}  // namespace ostraka
