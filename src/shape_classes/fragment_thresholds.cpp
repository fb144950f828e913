#include "ostraka/shape_classes/fragment_thresholds.h"

#include "ostraka/core/error.h"
#include "ostraka/files/file.h"
#include "ostraka/files/json_build.h"
#include "ostraka/reconstruction/rigid_scale.h"
#include "ostraka/registration/procrustes.h"
#include "ostraka/shape_classes/thresholds.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

constexpr std::size_t min_landmarks = 8, min_piece = 4;

Landmarks rows_of(const Landmarks& landmarks, const std::vector<Eigen::Index>& rows) {
    Landmarks selected(static_cast<Eigen::Index>(rows.size()), 3);
    for (std::size_t i = 0; i < rows.size(); ++i) selected.row(static_cast<Eigen::Index>(i)) = landmarks.row(rows[i]);
    return selected;
}

double spread_of(const Landmarks& landmarks) {
    return centroid_size(landmarks) / std::sqrt(static_cast<double>(landmarks.rows()));
}

double rigid_scale_between(const Landmarks& source, const Landmarks& target) {
    std::vector<Eigen::Vector3d> a, b;
    for (Eigen::Index i = 0; i < source.rows(); ++i)
        a.emplace_back(source.row(i).transpose()), b.emplace_back(target.row(i).transpose());
    return rigid_scale(a, b);
}

double per_cent_difference(double a, double b) { return 100 * (std::max(a, b) / std::min(a, b) - 1); }

/// Maximum residual and maximum difference of scale over the pieces.
std::optional<std::array<double, 2>> worst_piece(const Landmarks& template_landmarks, const Landmarks& member) {
    const Eigen::Index n = template_landmarks.rows();
    ProcrustesOptions scaled;
    scaled.scaling = true;
    const double scale = procrustes(template_landmarks, member, scaled).scale;
    const auto count = static_cast<std::size_t>(std::max<Eigen::Index>(min_piece, n / 4));
    std::array<double, 2> worst{};
    bool any_piece = false;
    for (Eigen::Index i = 0; i < n; ++i) {
        std::vector<Eigen::Index> order(static_cast<std::size_t>(n));
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
            return (template_landmarks.row(a) - template_landmarks.row(i)).squaredNorm() <
                   (template_landmarks.row(b) - template_landmarks.row(i)).squaredNorm();
        });
        const std::vector<Eigen::Index> near_rows(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count)),
            far_rows(order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
        const Landmarks piece = rows_of(template_landmarks, near_rows), goal = rows_of(member, near_rows),
                        other_landmarks = rows_of(template_landmarks, far_rows), other_goal = rows_of(member, far_rows);
        const double spread = spread_of(goal);
        if (!(spread > 0) || !(spread_of(piece) > 0) || !(spread_of(other_landmarks) > 0) || !(spread_of(other_goal) > 0))
            continue;
        const double residual = procrustes(scale * piece, goal).sum_of_squares;
        const double piece_scale = procrustes(piece, goal, scaled).scale,
                     other_scale = procrustes(other_landmarks, other_goal, scaled).scale;
        if (!(piece_scale > 0) || !(other_scale > 0)) continue;
        any_piece = true;
        worst[0] = std::max(worst[0], std::sqrt(std::max(0.0, residual) / static_cast<double>(count)) / spread);
        // As the verdict on fragments compares sizes: by all landmarks and by those that move rigidly together; the smaller
        // difference counts.
        const double rigid = rigid_scale_between(piece, goal), rigid_others = rigid_scale_between(other_landmarks, other_goal);
        double scale_difference = per_cent_difference(piece_scale, other_scale);
        if (rigid > 0 && rigid_others > 0)
            scale_difference = std::min(scale_difference, per_cent_difference(rigid, rigid_others));
        worst[1] = std::max(worst[1], scale_difference);
    }
    return any_piece ? std::optional(worst) : std::nullopt;
}

}  // namespace

std::vector<ClassQuantity> fragment_quantities(const ClassTemplate& class_template, const std::vector<Point>& points,
                                               const std::vector<ClassQuantity>& quantities) {
    std::vector<Point> template_points, member_points;
    for (const Annotation& annotation : class_template.annotations.annotations)
        if (annotation.type == AnnotationType::point && annotation.points.size() == 1) {
            template_points.push_back(class_template.mesh.point(Vertex(annotation.points.front())));
            member_points.push_back(points[annotation.points.front()]);
        }
    std::optional<std::array<double, 2>> worst;
    if (template_points.size() >= min_landmarks && centroid_size(landmarks_of(template_points)) > 0 &&
        centroid_size(landmarks_of(member_points)) > 0)
        worst = worst_piece(landmarks_of(template_points), landmarks_of(member_points));
    std::optional<double> tolerance;
    for (const ClassQuantity& constraint_quantity : quantities)
        if (constraint_quantity.kind == QuantityKind::constraint && constraint_quantity.unit == "%" && constraint_quantity.value)
            tolerance = std::max(tolerance.value_or(0), std::abs(*constraint_quantity.value));
    std::vector<ClassQuantity> fragment_list;
    const auto add = [&](const char* name, const std::optional<double>& value, const char* unit) {
        ClassQuantity& quantity = fragment_list.emplace_back();
        quantity.name = name;
        quantity.unit = unit;
        quantity.one_sided = true;
        quantity.value = value;
    };
    add("residual", worst ? std::optional((*worst)[0]) : std::nullopt, "");
    add("scale-tolerance", worst ? std::optional((*worst)[1]) : std::nullopt, "%");
    add("min-tolerance", tolerance, "%");
    return fragment_list;
}

std::vector<FragmentThreshold> fragment_thresholds(const ShapeClass& learnt) {
    std::vector<FragmentThreshold> thresholds;
    for (const LearntRange& range : learnt.fragments)
        if (range.high) thresholds.push_back({range.quantity.name, *range.high, range.count});
    return thresholds;
}

std::vector<UsedThreshold> apply_class_thresholds(ReconstructOptions& options, const ShapeClass* learnt,
                                                  const std::function<bool(const std::string&)>& specified) {
    std::vector<UsedThreshold> used;
    const std::vector<FragmentThreshold> of_class =
        learnt != nullptr ? fragment_thresholds(*learnt) : std::vector<FragmentThreshold>();
    const auto apply_threshold = [&](const char* name, double& value, double maximum) {
        UsedThreshold& used_threshold = used.emplace_back(UsedThreshold{{name, 0, 0}, specified(name) ? "option" : "default"});
        const auto class_threshold =
            std::find_if(of_class.begin(), of_class.end(), [&](const auto& each) { return each.option == name; });
        const bool is_tolerance = used_threshold.option == "min-tolerance";
        if (class_threshold != of_class.end() && used_threshold.from != "option" &&
            !(is_tolerance && class_threshold->value < value)) {
            value = std::min(class_threshold->value, maximum);
            used_threshold.members = class_threshold->members;
            used_threshold.from = "class";
        }
        used_threshold.value = value;
    };
    apply_threshold("residual", options.residual, 10.0);
    apply_threshold("scale-tolerance", options.scale_tolerance, 1000.0);
    apply_threshold("min-tolerance", options.min_tolerance, 1000.0);
    return used;
}

JsonValue thresholds_to_json(const std::vector<UsedThreshold>& thresholds, JsonAllocator& allocator) {
    return json_list(thresholds, allocator, [&](const UsedThreshold& threshold) {
        JsonValue threshold_object =
            json_object(allocator, "option", threshold.option, "value", threshold.value, "from", threshold.from);
        if (threshold.members > 0) add_members(threshold_object, allocator, "members", threshold.members);
        return threshold_object;
    });
}

std::string topology_checksum(const Mesh& mesh) {
    std::string bytes = std::to_string(mesh.number_of_vertices()) + "\n";
    for (const Face face : mesh.faces()) {
        const auto c = corners(mesh, face);
        for (const Vertex v : c) bytes += std::to_string(v.idx()) + " ";
    }
    return sha256(bytes);
}

void check_topology(const ShapeClass& learnt, const std::string& class_file, const Mesh& mesh, const std::string& template_file) {
    const auto vertices = static_cast<std::size_t>(learnt.modes.mean.rows());
    if (vertices == mesh.number_of_vertices() && learnt.topology == topology_checksum(mesh)) return;
    fail_input(class_file,
               fmt::format("was learnt with a template other than {}: {}", template_file,
                           vertices != mesh.number_of_vertices()
                               ? fmt::format("it has {} vertices, the template {}", vertices, mesh.number_of_vertices())
                               : std::string("their triangles differ")),
               fmt::format("use the template of the class ({}), or learn the class with this template: 'template learn'",
                           learnt.template_file));
}

}  // namespace ostraka
