#include "shape_classes/parts.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/geom/with_points.h"

#include <fmt/core.h>
#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <set>

namespace ostraka {

namespace {

struct FaceMoments {
    double area = 0;
    Vector3d first = Vector3d::Zero();
    Matrix3d second = Matrix3d::Zero();

    void add(const Mesh& mesh, Face face, const Vector3d& origin, double fraction = 1) {
        const auto c = corners(mesh, face);
        const double a = fraction * face_area(mesh, face);
        const Vector3d p = eigen(mesh.point(c[0])) - origin, q = eigen(mesh.point(c[1])) - origin,
                       r = eigen(mesh.point(c[2])) - origin, m = (p + q + r) / 3;
        area += a;
        first += a * m;
        second += a / 12 * (p * p.transpose() + q * q.transpose() + r * r.transpose() + 9 * m * m.transpose());
    }
    [[nodiscard]] Vector3d middle() const { return first / area; }
    /// Length and width.
    [[nodiscard]] std::array<double, 2> sides() const {
        const Matrix3d covariance = second / area - middle() * middle().transpose();
        const Vector3d values = symmetric_eigenvalues(covariance);
        return {std::sqrt(12 * std::max(0.0, values[2])), std::sqrt(12 * std::max(0.0, values[1]))};
    }
};

FaceMoments face_moments(const Mesh& mesh, const Vector3d& origin) {
    FaceMoments moments;
    for (const Face face : mesh.faces()) moments.add(mesh, face, origin);
    return moments;
}

/// Moments of the area enclosed by the outline; faces that it cuts count with their share.
FaceMoments part_moments(const Mesh& mesh, const Annotation& part, const Vector3d& origin) {
    FaceMoments moments;
    for (const auto& [face, fraction] : face_area_fractions(mesh, part)) moments.add(mesh, Face(face), origin, fraction);
    return moments;
}

AnnotationSet parts_of(AnnotatedMeshView object) {
    AnnotationSet parts;
    for (const Annotation& annotation : object.annotations.annotations)
        if (is_part(object.mesh, annotation)) parts.annotations.push_back(annotation);
    return parts;
}

/// Area shared on the member by each pair of a transferred and an own label.
using Overlap = std::map<std::pair<std::int32_t, std::int32_t>, double>;

Overlap overlap_of(const ClassTemplate& class_template, const Mesh& fitted, const AnnotationSet& parts, const WholeObject& member,
                   const AnnotationSet& member_parts) {
    Overlap overlap;
    const auto transferred_labels = labels_of({class_template.mesh, parts}),
               member_labels = labels_of({member.mesh, member_parts});
    const SurfaceSearch search(fitted);
    for (const Face face : member.mesh.faces()) {
        const std::int32_t label = transferred_labels[search.closest(centroid(member.mesh, face)).face];
        if (label != no_label && member_labels[face] != no_label)
            overlap[{label, member_labels[face]}] += face_area(member.mesh, face);
    }
    return overlap;
}

/// Transferred label -> own label, where each has most of its area in the other.
std::map<std::int32_t, std::int32_t> counterparts(const Overlap& overlap) {
    std::map<std::int32_t, std::pair<double, std::int32_t>> best, best_back;
    for (const auto& [pair, area] : overlap) {
        auto& counterpart = best[pair.first];
        if (area > counterpart.first) counterpart = {area, pair.second};
        auto& other = best_back[pair.second];
        if (area > other.first) other = {area, pair.first};
    }
    std::map<std::int32_t, std::int32_t> result;
    for (const auto& [label, counterpart] : best)
        if (best_back[counterpart.second].second == label) result[label] = counterpart.second;
    return result;
}

}  // namespace

bool is_part(const Mesh& mesh, const Annotation& annotation) {
    return annotation.type == AnnotationType::region && !annotation.all && !annotation.faces.empty() &&
           annotation.faces.size() < mesh.number_of_faces();
}

std::vector<ClassQuantity> part_quantities(const ClassTemplate& class_template, const std::vector<Point>& points,
                                           const WholeObject* member) {
    const AnnotationSet parts = parts_of(class_template);
    std::vector<ClassQuantity> quantities;
    if (parts.annotations.empty()) return quantities;
    const Mesh fitted = with_points(class_template.mesh, points);
    std::map<std::int32_t, std::int32_t> counterpart_labels;
    AnnotationSet own_parts;
    if (member != nullptr) {
        own_parts = parts_of(*member);
        if (!own_parts.annotations.empty())
            counterpart_labels = counterparts(overlap_of(class_template, fitted, parts, *member, own_parts));
    }
    const Vector3d origin = eigen(points.front());
    const FaceMoments fitted_moments = face_moments(fitted, origin);
    FaceMoments member_moments;
    if (!counterpart_labels.empty()) member_moments = face_moments(member->mesh, origin);
    struct Part {
        const Annotation* annotation;
        FaceMoments moments;
        Vector3d surface_centroid;  ///< centroid of the surface that contains the part
        double size = 1;
    };
    std::map<std::int32_t, Part> measured;
    for (const Annotation& annotation : parts.annotations) {
        const auto counterpart = counterpart_labels.find(annotation.id);
        const bool has_counterpart = counterpart != counterpart_labels.end();
        measured[annotation.id] = {&annotation,
                                   has_counterpart ? part_moments(member->mesh, *own_parts.find(counterpart->second), origin)
                                                   : part_moments(fitted, annotation, origin),
                                   (has_counterpart ? member_moments : fitted_moments).middle(),
                                   std::sqrt((has_counterpart ? member_moments : fitted_moments).area)};
    }
    const auto add = [&](const Annotation& annotation, const std::string& name, std::optional<double> value) {
        ClassQuantity& quantity = quantities.emplace_back(ClassQuantity{QuantityKind::part, annotation.id, name, annotation.tag});
        if (value && std::isfinite(*value)) quantity.value = value;
    };
    std::set<std::pair<std::int32_t, std::int32_t>> neighbours;
    const auto labels = labels_of({class_template.mesh, parts});
    for (const Edge edge : class_template.mesh.edges()) {
        if (class_template.mesh.is_border(edge)) continue;
        const std::int32_t a = labels[class_template.mesh.face(class_template.mesh.halfedge(edge, 0))],
                           b = labels[class_template.mesh.face(class_template.mesh.halfedge(edge, 1))];
        if (a != b && a != no_label && b != no_label) neighbours.emplace(std::min(a, b), std::max(a, b));
    }
    for (const Annotation& annotation : parts.annotations) {
        const Part& part = measured.at(annotation.id);
        const bool is_measured = part.moments.area > 0;
        const auto sides = is_measured ? part.moments.sides() : std::array<double, 2>{};
        const auto if_present = [&](double value) { return is_measured ? std::optional<double>(value) : std::nullopt; };
        add(annotation, "share of the surface", if_present(part.moments.area / (part.size * part.size)));
        add(annotation, "length", if_present(sides[0] / part.size));
        add(annotation, "width", if_present(sides[1] / part.size));
        add(annotation, "distance from the middle",
            is_measured ? if_present((part.moments.middle() - part.surface_centroid).norm() / part.size) : if_present(0));
        for (const auto& [a, b] : neighbours) {
            if (a != annotation.id) continue;
            const Part& other = measured.at(b);
            const bool both_present = is_measured && other.moments.area > 0;
            add(annotation, fmt::format("distance to {} ({})", b, other.annotation->tag),
                both_present ? if_present((part.moments.middle() - other.moments.middle()).norm() / part.size) : std::nullopt);
        }
    }
    return quantities;
}

bool is_size_of_part(const ClassQuantity& quantity) { return !quantity.name.starts_with("distance"); }

std::optional<double> own_disagreement(const ClassTemplate& class_template, const std::vector<Point>& points,
                                       const WholeObject& member) {
    const AnnotationSet parts = parts_of(class_template), own = parts_of(member);
    if (parts.annotations.empty() || own.annotations.empty()) return {};
    const Overlap overlap = overlap_of(class_template, with_points(class_template.mesh, points), parts, member, own);
    // The index for areas, as the limit of a division into many equal grains; the number of grains cancels.
    std::map<std::int32_t, double> rows, columns;
    double total_area = 0, joint = 0, row = 0, column = 0;
    for (const auto& [pair, area] : overlap) total_area += area;
    if (!(total_area > 0)) return {};
    for (const auto& [pair, area] : overlap) {
        const double fraction = area / total_area;
        joint += fraction * fraction;
        rows[pair.first] += fraction;
        columns[pair.second] += fraction;
    }
    for (const auto& [label, fraction] : rows) row += fraction * fraction;
    for (const auto& [label, fraction] : columns) column += fraction * fraction;
    const double chance = row * column, maximum = 0.5 * (row + column);
    return maximum > chance ? 1 - (joint - chance) / (maximum - chance) : 0;
}

PartsDeviation parts_deviation(std::span<const std::optional<double>> values, std::span<const std::optional<double>> expected) {
    PartsDeviation result;
    double squares = 0, largest = -1;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!values[i] || !expected[i] || !(*values[i] > 0) || !(*expected[i] > 0)) continue;
        const double log_ratio = std::abs(std::log(*values[i] / *expected[i]));
        squares += log_ratio * log_ratio;
        ++result.count;
        if (log_ratio > largest) largest = log_ratio, result.worst = i;
    }
    if (result.count > 0) result.off = std::sqrt(squares / static_cast<double>(result.count));
    return result;
}

}  // namespace ostraka
