#include "ostraka/shape_classes/parts.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/annotation/label_file.h"
#include "ostraka/core/dense.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/geom/with_points.h"

#include <Eigen/Geometry>

#include <cmath>
#include <map>
#include <set>

namespace ostraka {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

struct FaceMoments {
    double area = 0;
    Vector3d first = Vector3d::Zero();
    Matrix3d second = Matrix3d::Zero();

    void add(const Mesh& mesh, Face face, const Vector3d& origin, double share = 1) {
        const auto c = corners(mesh, face);
        const double a = share * face_area(mesh, face);
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
    for (const auto& [face, share] : face_shares(mesh, part)) moments.add(mesh, Face(face), origin, share);
    return moments;
}

AnnotationSet parts_of(const Mesh& mesh, const AnnotationSet& set) {
    AnnotationSet parts;
    for (const Annotation& annotation : set.annotations)
        if (is_part(mesh, annotation)) parts.annotations.push_back(annotation);
    return parts;
}

/// Area shared on the member by each pair of a transferred and an own label.
using Overlap = std::map<std::pair<std::int32_t, std::int32_t>, double>;

Overlap overlap_of(const ClassTemplate& known, const Mesh& fitted, const AnnotationSet& parts, const WholeObject& member,
                   const AnnotationSet& own) {
    Overlap overlap;
    const auto carried = labels_of(known.mesh, parts), there = labels_of(member.mesh, own);
    const SurfaceSearch search(fitted);
    for (const Face face : member.mesh.faces()) {
        const std::int32_t label = carried[search.closest(centroid(member.mesh, face)).face];
        if (label != no_label && there[face] != no_label) overlap[{label, there[face]}] += face_area(member.mesh, face);
    }
    return overlap;
}

/// Transferred label -> own label, where each has most of its area in the other.
std::map<std::int32_t, std::int32_t> counterparts(const Overlap& overlap) {
    std::map<std::int32_t, std::pair<double, std::int32_t>> best, back;
    for (const auto& [pair, area] : overlap) {
        auto& one = best[pair.first];
        if (area > one.first) one = {area, pair.second};
        auto& other = back[pair.second];
        if (area > other.first) other = {area, pair.first};
    }
    std::map<std::int32_t, std::int32_t> result;
    for (const auto& [label, one] : best)
        if (back[one.second].second == label) result[label] = one.second;
    return result;
}

}  // namespace

bool is_part(const Mesh& mesh, const Annotation& annotation) {
    return annotation.type == AnnotationType::region && !annotation.all && !annotation.faces.empty() &&
           annotation.faces.size() < mesh.number_of_faces();
}

std::vector<ClassQuantity> part_quantities(const ClassTemplate& known, const std::vector<Point>& points, const WholeObject* own) {
    const AnnotationSet parts = parts_of(known.mesh, known.set);
    std::vector<ClassQuantity> list;
    if (parts.annotations.empty()) return list;
    const Mesh fitted = with_points(known.mesh, points);
    std::map<std::int32_t, std::int32_t> same;
    AnnotationSet theirs;
    if (own != nullptr) {
        theirs = parts_of(own->mesh, own->annotations);
        if (!theirs.annotations.empty()) same = counterparts(overlap_of(known, fitted, parts, *own, theirs));
    }
    const Vector3d origin = eigen(points.front());
    const FaceMoments whole = face_moments(fitted, origin);
    FaceMoments own_whole;
    if (!same.empty()) own_whole = face_moments(own->mesh, origin);
    struct Part {
        const Annotation* annotation;
        FaceMoments moments;
        Vector3d from;  ///< centroid of the surface that contains the part
        double size = 1;
    };
    std::map<std::int32_t, Part> measured;
    for (const Annotation& annotation : parts.annotations) {
        const auto there = same.find(annotation.id);
        const bool theirs_counts = there != same.end();
        measured[annotation.id] = {&annotation,
                                   theirs_counts ? part_moments(own->mesh, *theirs.find(there->second), origin)
                                                 : part_moments(fitted, annotation, origin),
                                   (theirs_counts ? own_whole : whole).middle(),
                                   std::sqrt((theirs_counts ? own_whole : whole).area)};
    }
    const auto add = [&](const Annotation& annotation, const std::string& name, std::optional<double> value) {
        ClassQuantity& quantity = list.emplace_back(ClassQuantity{QuantityKind::part, annotation.id, name, annotation.tag});
        if (value && std::isfinite(*value)) quantity.value = value;
    };
    std::set<std::pair<std::int32_t, std::int32_t>> neighbours;
    const auto labels = labels_of(known.mesh, parts);
    for (const Edge edge : known.mesh.edges()) {
        if (known.mesh.is_border(edge)) continue;
        const std::int32_t a = labels[known.mesh.face(known.mesh.halfedge(edge, 0))],
                           b = labels[known.mesh.face(known.mesh.halfedge(edge, 1))];
        if (a != b && a != no_label && b != no_label) neighbours.emplace(std::min(a, b), std::max(a, b));
    }
    for (const Annotation& annotation : parts.annotations) {
        const Part& part = measured.at(annotation.id);
        const bool any = part.moments.area > 0;
        const auto sides = any ? part.moments.sides() : std::array<double, 2>{};
        const auto when = [&](double value) { return any ? std::optional<double>(value) : std::nullopt; };
        add(annotation, "share of the surface", when(part.moments.area / (part.size * part.size)));
        add(annotation, "length", when(sides[0] / part.size));
        add(annotation, "width", when(sides[1] / part.size));
        add(annotation, "distance from the middle", any ? when((part.moments.middle() - part.from).norm() / part.size) : when(0));
        for (const auto& [a, b] : neighbours) {
            if (a != annotation.id) continue;
            const Part& other = measured.at(b);
            const bool both = any && other.moments.area > 0;
            add(annotation, "distance to " + std::to_string(b) + " (" + other.annotation->tag + ")",
                both ? when((part.moments.middle() - other.moments.middle()).norm() / part.size) : std::nullopt);
        }
    }
    return list;
}

bool is_size_of_part(const ClassQuantity& quantity) { return !quantity.name.starts_with("distance"); }

std::optional<double> own_disagreement(const ClassTemplate& known, const std::vector<Point>& points, const WholeObject& member) {
    const AnnotationSet parts = parts_of(known.mesh, known.set), own = parts_of(member.mesh, member.annotations);
    if (parts.annotations.empty() || own.annotations.empty()) return {};
    const Overlap overlap = overlap_of(known, with_points(known.mesh, points), parts, member, own);
    // The index for areas, as the limit of a division into many equal grains; the number of grains cancels.
    std::map<std::int32_t, double> rows, columns;
    double all = 0, both = 0, row = 0, column = 0;
    for (const auto& [pair, area] : overlap) all += area;
    if (!(all > 0)) return {};
    for (const auto& [pair, area] : overlap) {
        const double share = area / all;
        both += share * share;
        rows[pair.first] += share;
        columns[pair.second] += share;
    }
    for (const auto& [label, share] : rows) row += share * share;
    for (const auto& [label, share] : columns) column += share * share;
    const double chance = row * column, maximum = 0.5 * (row + column);
    return maximum > chance ? 1 - (both - chance) / (maximum - chance) : 0;
}

PartsOff parts_off(std::span<const std::optional<double>> values, std::span<const std::optional<double>> expected) {
    PartsOff result;
    double squares = 0, largest = -1;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!values[i] || !expected[i] || !(*values[i] > 0) || !(*expected[i] > 0)) continue;
        const double off = std::abs(std::log(*values[i] / *expected[i]));
        squares += off * off;
        ++result.count;
        if (off > largest) largest = off, result.worst = i;
    }
    if (result.count > 0) result.off = std::sqrt(squares / static_cast<double>(result.count));
    return result;
}

}  // namespace ostraka
