#include "ostraka/shape_classes/quantities.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/geom/with_points.h"
#include "ostraka/measure/measure.h"
#include "ostraka/relation/check.h"
#include "ostraka/semantic/measure_constraints.h"

#include <fmt/core.h>

#include <cmath>
#include <map>
#include <set>

namespace ostraka {

std::string to_string(QuantityKind kind) {
    return enum_name(kind, {"proportion", "constraint", "relation", "part", "attribute", "geometry"});
}

QuantityKind quantity_kind(const std::string& word) {
    for (const QuantityKind kind : {QuantityKind::proportion, QuantityKind::constraint, QuantityKind::relation,
                                    QuantityKind::part, QuantityKind::attribute, QuantityKind::geometry})
        if (to_string(kind) == word) return kind;
    fail_usage(fmt::format("'{}' is not a kind of quantity", word),
               "use proportion, constraint, relation, part, attribute or geometry");
}

std::string ClassQuantity::key() const {
    return to_string(kind) + (id >= 0 ? " " + std::to_string(id) : "") + " " + (kind == QuantityKind::proportion ? "" : name);
}

std::string ClassQuantity::text() const {
    switch (kind) {
        case QuantityKind::geometry:
            return name;
        case QuantityKind::part:
            return id < 0 ? name : fmt::format("{} of part {}{}", name, id, subject.empty() ? "" : fmt::format(" ({})", subject));
        case QuantityKind::attribute:
            return fmt::format("{} of {}", name, subject);
        case QuantityKind::proportion:
            return fmt::format("proportion {}, {}", id, name);
        default:
            return fmt::format("{} {} ({}), {}", to_string(kind), id, subject, name);
    }
}

Landmarks landmarks_of(const std::vector<Point>& points) {
    Landmarks landmarks(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i)
        landmarks.row(static_cast<Eigen::Index>(i)) << points[i].x(), points[i].y(), points[i].z();
    return landmarks;
}

std::vector<Point> points_of(const Landmarks& landmarks) {
    std::vector<Point> points;
    for (Eigen::Index i = 0; i < landmarks.rows(); ++i) points.emplace_back(landmarks(i, 0), landmarks(i, 1), landmarks(i, 2));
    return points;
}

std::vector<Point> in_template_frame(const Mesh& mesh, const std::vector<Point>& points, bool sizes) {
    const Landmarks goal = landmarks_of({mesh.points().begin(), mesh.points().end()});
    Landmarks landmarks = landmarks_of(points);
    if (!sizes) {
        const double size = centroid_size(landmarks);
        if (!(size > 0)) fail_input("shape", "all its vertices coincide", "check that it is the right file");
        landmarks *= centroid_size(goal) / size;
    }
    return points_of(procrustes(landmarks, goal).apply(landmarks));
}

namespace {

/// The attribute with the measure to which a constraint refers by id or name; nullptr if there is none.
const Attribute* named(const JsonValue& parameters, const char* member, const Annotation& annotation) {
    const JsonValue* name = find_member(parameters, member);
    if (name == nullptr) return nullptr;
    for (const Attribute& attribute : annotation.attributes) {
        if (attribute.measure() == nullptr) continue;
        if (name->IsInt() ? attribute.id == name->GetInt() : name->IsString() && attribute.name == name->GetString())
            return &attribute;
    }
    return nullptr;
}

/// The ratio of the two measures of a proportion.
std::optional<ClassQuantity> ratio_of(AnnotatedMeshView shape, const Relationship& relationship) {
    if (relationship.annotations.size() != 2) return {};
    const Annotation *a = shape.annotations.find(relationship.annotations[0]),
                     *b = shape.annotations.find(relationship.annotations[1]);
    if (a == nullptr || b == nullptr) return {};
    const Json parameters = parse_json(relationship.constraint.empty() ? "{}" : relationship.constraint, "constraint");
    const Attribute *first = named(parameters, "measure1", *a), *second = named(parameters, "measure2", *b);
    if (first == nullptr || second == nullptr) return {};
    ClassQuantity quantity{QuantityKind::proportion, relationship.id,
                           fmt::format("{} of {} / {} of {}", first->name, a->tag, second->name, b->tag), relationship.type};
    const double below = evaluate(shape.mesh, *b, *second->measure());
    if (below > 0) quantity.value = evaluate(shape.mesh, *a, *first->measure()) / below;
    return quantity;
}

void add_attributes(AnnotatedMeshView shape, std::vector<ClassQuantity>& quantities) {
    for (const Annotation& annotation : shape.annotations.annotations)
        for (const Attribute& attribute : annotation.attributes) {
            ClassQuantity quantity{QuantityKind::attribute, annotation.id, attribute.name, annotation.tag};
            const Descriptor* descriptor = attribute.descriptor();
            if (const Measure* measure = attribute.measure()) {
                quantity.value = evaluate(shape.mesh, annotation, *measure);
                quantity.unit = shape.annotations.unit;
            } else if (descriptor != nullptr && !descriptor->is_list && descriptor->file.empty() &&
                       descriptor->values.size() == 1) {
                quantity.value = evaluate(shape.mesh, annotation, attribute.name);
                if (!quantity.value) continue;  // of a kind that cannot be computed
                quantity.unit = descriptor_unit(attribute.name, shape.annotations.unit);
            } else {
                continue;
            }
            if (!std::isfinite(*quantity.value)) quantity.value.reset();
            quantities.push_back(std::move(quantity));
        }
}

}  // namespace

std::vector<ClassQuantity> measure_quantities(const ClassTemplate& class_template, const std::vector<Point>& points, bool sizes) {
    std::vector<ClassQuantity> quantities;
    const std::vector<Point> normal = in_template_frame(class_template.mesh, points, sizes);
    // Attributes are measured at the object's own size but in the pose of the template, because measures have directions.
    const Mesh framed = with_points(class_template.mesh, normal),
               shape = with_points(class_template.mesh, in_template_frame(class_template.mesh, points, true));
    std::map<int, ConstraintReport> constraints;
    for (ConstraintReport& report : measure_constraints(class_template, class_template.graph, normal)) {
        const int id = report.id;
        constraints.emplace(id, std::move(report));
    }
    const auto relations = check_relations({framed, class_template.annotations}, class_template.graph);
    for (std::size_t i = 0; i < class_template.graph.relationships.size(); ++i) {
        const Relationship& relationship = class_template.graph.relationships[i];
        const auto add = [&](QuantityKind kind, const std::vector<Deviation>& deviations) {
            for (const Deviation& deviation : deviations) {
                ClassQuantity quantity{kind, relationship.id, deviation.quantity, relationship.type, deviation.unit};
                quantity.one_sided = deviation.tolerance.has_value();  // a residual: it is satisfied up to its tolerance
                if (deviation.value && std::isfinite(*deviation.value)) quantity.value = deviation.value;
                quantities.push_back(std::move(quantity));
            }
        };
        const auto constraint = constraints.find(relationship.id);
        if (!relationship.is_constraint) {
            add(QuantityKind::relation, relations[i].parameters.deviations);
        } else if (constraint != constraints.end() && constraint->second.used) {
            if (find_relation_type(relationship.type) != nullptr && relationship.type == "proportion")
                if (auto ratio = ratio_of({framed, class_template.annotations}, relationship))
                    quantities.push_back(std::move(*ratio));
            add(QuantityKind::constraint, constraint->second.deviations);
        }
    }
    add_attributes({shape, class_template.annotations}, quantities);
    return quantities;
}

bool is_share_of_surface(const ClassQuantity& quantity) {
    static const std::set<std::string> shares{"unmatched", "unexplained", "share of the hull", "concave share"};
    return quantity.kind == QuantityKind::geometry && shares.count(quantity.name) > 0;
}

std::vector<ClassQuantity> geometry_quantities(const std::optional<FitResiduals>& residuals) {
    std::vector<ClassQuantity> quantities;
    const auto add = [&](const char* name, double FitResiduals::*value) {
        ClassQuantity quantity;
        quantity.name = name;
        quantity.one_sided = true;
        if (residuals) quantity.value = (*residuals).*value;
        quantities.push_back(std::move(quantity));
    };
    add("distance", &FitResiduals::distance);
    add("distance back", &FitResiduals::back);
    add("unmatched", &FitResiduals::unmatched);
    add("unexplained", &FitResiduals::unexplained);
    add("stretch", &FitResiduals::stretch);
    add("bend", &FitResiduals::bend);
    return quantities;
}

std::vector<ClassQuantity> geometry_quantities(const WholeShape& shape) {
    std::vector<ClassQuantity> quantities;
    const auto add = [&](const std::string& name, const std::optional<double>& value) {
        quantities.emplace_back().name = name;
        quantities.back().value = value;
    };
    add("compactness", shape.compactness);
    add("geodesic mean", shape.geodesic_mean);
    add("geodesic most", shape.geodesic_max);
    add("geodesic variation", shape.geodesic_variation);
    add("second far point", shape.second_point);
    add("fourth far point", shape.fourth_point);
    add("sixth far point", shape.sixth_point);
    add("thickness mean", shape.thickness_mean);
    add("thickness median", shape.thickness_median);
    add("thickness most", shape.thickness_most);
    add("share of the hull", shape.hull_share);
    add("compactness of the hull", shape.hull_compactness);
    add("mean curvature", shape.curvature);
    add("concave share", shape.concave);
    add("saddles and peaks", shape.saddles);
    for (std::size_t k = 0; k < WholeShape::spectrum_size; ++k)
        add("tone " + std::to_string(k + 1), k < shape.spectrum.size() ? std::optional(shape.spectrum[k]) : std::nullopt);
    return quantities;
}

}  // namespace ostraka
