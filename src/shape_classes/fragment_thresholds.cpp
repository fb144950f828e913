#include "ostraka/shape_classes/fragment_thresholds.h"

#include "ostraka/core/error.h"
#include "ostraka/core/file.h"
#include "ostraka/core/json_build.h"
#include "ostraka/reconstruction/rigid_scale.h"
#include "ostraka/registration/procrustes.h"
#include "ostraka/shape_classes/thresholds.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

constexpr std::size_t min_landmarks = 8, min_piece = 4;

Landmarks rows_of(const Landmarks& all, const std::vector<Eigen::Index>& rows) {
    Landmarks some(static_cast<Eigen::Index>(rows.size()), 3);
    for (std::size_t i = 0; i < rows.size(); ++i) some.row(static_cast<Eigen::Index>(i)) = all.row(rows[i]);
    return some;
}

double spread_of(const Landmarks& marks) { return centroid_size(marks) / std::sqrt(static_cast<double>(marks.rows())); }

double rigid_scale_between(const Landmarks& from, const Landmarks& to) {
    std::vector<Eigen::Vector3d> a, b;
    for (Eigen::Index i = 0; i < from.rows(); ++i) a.emplace_back(from.row(i).transpose()), b.emplace_back(to.row(i).transpose());
    return rigid_scale(a, b);
}

double per_cent_more(double a, double b) { return 100 * (std::max(a, b) / std::min(a, b) - 1); }

/// Maximum residual and maximum difference of scale over the pieces.
std::optional<std::array<double, 2>> worst_piece(const Landmarks& rest, const Landmarks& member) {
    const Eigen::Index n = rest.rows();
    ProcrustesOptions scaled;
    scaled.scaling = true;
    const double scale = procrustes(rest, member, scaled).scale;
    const auto count = static_cast<std::size_t>(std::max<Eigen::Index>(min_piece, n / 4));
    std::array<double, 2> worst{};
    bool any = false;
    for (Eigen::Index i = 0; i < n; ++i) {
        std::vector<Eigen::Index> order(static_cast<std::size_t>(n));
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
            return (rest.row(a) - rest.row(i)).squaredNorm() < (rest.row(b) - rest.row(i)).squaredNorm();
        });
        const std::vector<Eigen::Index> near(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count)),
            far(order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
        const Landmarks piece = rows_of(rest, near), goal = rows_of(member, near), others = rows_of(rest, far),
                        other_goal = rows_of(member, far);
        const double spread = spread_of(goal);
        if (!(spread > 0) || !(spread_of(piece) > 0) || !(spread_of(others) > 0) || !(spread_of(other_goal) > 0)) continue;
        const double left = procrustes(scale * piece, goal).sum_of_squares;
        const double own = procrustes(piece, goal, scaled).scale, theirs = procrustes(others, other_goal, scaled).scale;
        if (!(own > 0) || !(theirs > 0)) continue;
        any = true;
        worst[0] = std::max(worst[0], std::sqrt(std::max(0.0, left) / static_cast<double>(count)) / spread);
        // As the verdict on fragments compares sizes: by all landmarks and by those that move rigidly together; the smaller
        // difference counts.
        const double rigid = rigid_scale_between(piece, goal), rigid_others = rigid_scale_between(others, other_goal);
        double apart = per_cent_more(own, theirs);
        if (rigid > 0 && rigid_others > 0) apart = std::min(apart, per_cent_more(rigid, rigid_others));
        worst[1] = std::max(worst[1], apart);
    }
    return any ? std::optional(worst) : std::nullopt;
}

}  // namespace

std::vector<ClassQuantity> fragment_quantities(const ClassTemplate& known, const std::vector<Point>& points,
                                               const std::vector<ClassQuantity>& quantities) {
    std::vector<Point> rest, there;
    for (const Annotation& annotation : known.set.annotations)
        if (annotation.type == AnnotationType::point && annotation.points.size() == 1) {
            rest.push_back(known.mesh.point(Vertex(annotation.points.front())));
            there.push_back(points[annotation.points.front()]);
        }
    std::optional<std::array<double, 2>> worst;
    if (rest.size() >= min_landmarks && centroid_size(landmarks_of(rest)) > 0 && centroid_size(landmarks_of(there)) > 0)
        worst = worst_piece(landmarks_of(rest), landmarks_of(there));
    std::optional<double> slack;
    for (const ClassQuantity& one : quantities)
        if (one.kind == QuantityKind::constraint && one.unit == "%" && one.value)
            slack = std::max(slack.value_or(0), std::abs(*one.value));
    std::vector<ClassQuantity> list;
    const auto add = [&](const char* name, const std::optional<double>& value, const char* unit) {
        ClassQuantity& quantity = list.emplace_back();
        quantity.name = name;
        quantity.unit = unit;
        quantity.one_sided = true;
        quantity.value = value;
    };
    add("residual", worst ? std::optional((*worst)[0]) : std::nullopt, "");
    add("scale-tolerance", worst ? std::optional((*worst)[1]) : std::nullopt, "%");
    add("slack", slack, "%");
    return list;
}

std::vector<FragmentThreshold> fragment_thresholds(const ShapeClass& learnt) {
    std::vector<FragmentThreshold> list;
    for (const LearntRange& range : learnt.fragments)
        if (range.high) list.push_back({range.quantity.name, *range.high, range.count});
    return list;
}

std::vector<UsedThreshold> take_thresholds(ReconstructOptions& options, const ShapeClass* learnt,
                                           const std::function<bool(const std::string&)>& specified) {
    std::vector<UsedThreshold> used;
    const std::vector<FragmentThreshold> of_class =
        learnt != nullptr ? fragment_thresholds(*learnt) : std::vector<FragmentThreshold>();
    const auto take = [&](const char* name, double& value, double maximum) {
        UsedThreshold& one = used.emplace_back(UsedThreshold{{name, 0, 0}, specified(name) ? "told" : "default"});
        const auto found = std::find_if(of_class.begin(), of_class.end(), [&](const auto& each) { return each.option == name; });
        const bool is_slack = one.option == "slack";
        if (found != of_class.end() && one.from != "told" && !(is_slack && found->value < value)) {
            value = std::min(found->value, maximum);
            one.members = found->members;
            one.from = "class";
        }
        one.value = value;
    };
    take("residual", options.residual, 10.0);
    take("scale-tolerance", options.scale_tolerance, 1000.0);
    take("slack", options.slack, 1000.0);
    return used;
}

JsonValue thresholds_to_json(const std::vector<UsedThreshold>& thresholds, JsonAllocator& allocator) {
    return json_list(thresholds, allocator, [&](const UsedThreshold& threshold) {
        JsonValue one = json_object(allocator, "option", threshold.option, "value", threshold.value, "from", threshold.from);
        if (threshold.members > 0) add_members(one, allocator, "members", threshold.members);
        return one;
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
    fail_input(
        class_file,
        "was learnt with another template than " + template_file + ": " +
            (vertices != mesh.number_of_vertices()
                 ? "it has " + std::to_string(vertices) + " vertices, the template " + std::to_string(mesh.number_of_vertices())
                 : std::string("their triangles join other vertices")),
        "use the template beside the class (" + learnt.template_file + "), or learn the class with this one: 'template learn'");
}

}  // namespace ostraka
