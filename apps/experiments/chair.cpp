#include "chair.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/axis/axis.h"
#include "ostraka/core/error.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka::experiments {

namespace {

using Eigen::Vector3d;

constexpr double bend = 45;  ///< mm; distance of the supports' heads behind the legs' axes
constexpr double bend_from = 540, bend_to = 655;
constexpr double arm_from = -200;   ///< the arms change in front of this x
constexpr double longer = 0.18;     ///< relative elongation of the arm
constexpr double angle_limit = 10;  ///< degrees (section 5.2.2)
constexpr double our_weight = 200;

double smooth_step(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

double along_arm(double x) { return std::max(0.0, x - arm_from); }

Vector3d bent(const Vector3d& p) {
    const double back = bend * smooth_step(bend_from, bend_to, p.z()) * along_arm(p.x()) / (150 - arm_from);
    return {p.x() - back, p.y(), p.z()};
}

/// Finds the vertices of the part beside the skeleton from the reference on, as long as its direction is that of the axis
/// (section 5.2.2).
void find_segment(Chair& chair) {
    const Mesh& mesh = chair.subject.mesh;
    const Annotation& support = chair.subject.part("left support");
    const Axis leg = find_axis(mesh, chair.subject.part("front left leg").faces);
    const Axis skeleton = skeleton_axis(mesh, support.faces);
    if (!leg.found || !skeleton.found || skeleton.lines.empty())
        fail_input("chair", "leg or support has no axis: " + leg.reason + skeleton.reason, "use more vertices");
    chair.point = eigen(leg.point);
    chair.direction = eigen(leg.direction);
    if (chair.direction.z() < 0) chair.direction = -chair.direction;
    std::vector<Point> line = skeleton.lines[0];
    if (line.back().z() < line.front().z()) std::reverse(line.begin(), line.end());
    const double step = std::sqrt(CGAL::squared_distance(line.front(), line.back())) / 20;
    double top = line.front().z();
    for (std::size_t i = 0, j = 1; j < line.size(); ++j) {
        const Vector3d d = eigen(line[j]) - eigen(line[i]);
        if (d.norm() < step) continue;
        if (d.normalized().dot(chair.direction) < std::cos(angle_limit * M_PI / 180)) break;
        top = line[j].z();
        i = j;
    }
    const std::vector<Point> rest = points_of(mesh);
    double low = std::numeric_limits<double>::infinity();
    for (const Index v : vertices_of(mesh, support))
        if (rest[v].z() <= top) {
            chair.segment.push_back(v);
            low = std::min(low, rest[v].z());
        }
    Annotation foot;
    foot.id = free_id(chair.subject.set);
    foot.tag = "foot of the support";
    foot.colour = {230, 60, 50};
    const std::set<Index> inside(chair.segment.begin(), chair.segment.end());
    for (const Face f : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, f);
        if (inside.count(a) + inside.count(b) + inside.count(c) == 3) foot.faces.push_back(f.idx());
    }
    chair.subject.set.annotations.push_back(foot);
    chair.count = 8;
    for (const Index v : chair.segment)
        chair.stations.push_back(std::min(chair.count - 1, static_cast<int>(chair.count * (rest[v].z() - low) / (top - low))));
}

void stretch_arm(Chair& chair) {
    const Subject& subject = chair.subject;
    const std::vector<Point> rest = points_of(subject.mesh);
    chair.edited = rest;
    const auto moved = [](const Point& p) { return Vector3d(longer * along_arm(p.x()), 0, 0); };
    const Annotation &arm = subject.part("left arm"), &support = subject.part("left support");
    for (const Index v : vertices_of(subject.mesh, arm)) chair.edited[v] = point_of(eigen(rest[v]) + moved(rest[v]));
    const Vector3d foot = centre_of(rest, joint_of(subject.mesh, support, &subject.part("seat")));
    const Vector3d head = centre_of(rest, joint_of(subject.mesh, support, &arm)), head_now = head + moved(point_of(head));
    const Vector3d was = head - foot, is = head_now - foot;
    const Eigen::Matrix3d rotation = rotation_between(was, is).toRotationMatrix();
    for (const Index v : vertices_of(subject.mesh, support)) {
        const Vector3d p = eigen(rest[v]), from_foot = p - foot;
        const double along = from_foot.dot(was.normalized()), share = along / was.norm();
        const Vector3d longer_too = (is.norm() / was.norm() - 1) * along * is.normalized();
        const Vector3d turned = foot + rotation * from_foot + longer_too - p;
        // Blends at its ends into the adjacent parts.
        const double at_head = smooth_step(0.85, 1, share), at_foot = smooth_step(0, 0.05, share);
        chair.edited[v] = point_of(p + at_foot * ((1 - at_head) * turned + at_head * moved(rest[v])));
    }
}

}  // namespace

Chair make_chair(const Path& data, std::uint64_t vertices) {
    Chair chair;
    chair.subject = synthetic_subject(data, "chair", vertices, bent);
    find_segment(chair);
    stretch_arm(chair);
    return chair;
}

AxisDeviation deviation(const Chair& chair, const std::vector<Point>& points) {
    const Mesh mesh = with_points(chair.subject.mesh, points);
    const Axis leg = find_axis(mesh, chair.subject.part("front left leg").faces);
    if (!leg.found) fail_input("chair", "the leg has no axis any more: " + leg.reason, "look at the picture");
    std::vector<Vector3d> means(static_cast<std::size_t>(chair.count), Vector3d::Zero());
    std::vector<double> sizes(means.size(), 0);
    for (std::size_t i = 0; i < chair.segment.size(); ++i) {
        means[static_cast<std::size_t>(chair.stations[i])] += eigen(points[chair.segment[i]]);
        sizes[static_cast<std::size_t>(chair.stations[i])] += 1;
    }
    AxisDeviation result;
    const Vector3d direction = eigen(leg.direction);
    for (std::size_t s = 0; s < means.size(); ++s) {
        means[s] /= std::max(1.0, sizes[s]);
        result.distance = std::max(result.distance, direction.cross(means[s] - eigen(leg.point)).norm());
    }
    const Vector3d along = means.back() - means.front();
    result.angle = std::atan2(direction.cross(along).norm(), std::abs(direction.dot(along))) * 180 / M_PI;
    return result;
}

Constraints thesis_constraints(const Chair& chair, const std::vector<Index>& constrained) {
    Constraints list;
    add_closeness(list, chair.subject, chair.edited, closeness_weight);
    add_laplacians(list, chair.subject, chair.subject.vertices("left arm"), 1);
    list.push_back(make_constraint(kinds::CoAxiality{chair.direction, chair.point}, {constrained.begin(), constrained.end()}, 1,
                                   columns_of(chair.subject.mesh)));
    return list;
}

RelationGraph continuity_graph(const Chair& chair, bool hard, bool shape) {
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "structural continuity",
                                             {chair.subject.id("left support"), chair.subject.id("front left leg")},
                                             hard ? R"({"hard": true})" : "{}", our_weight));
    if (shape) graph.relationships.push_back(constraint(1, "keep shape", {chair.subject.id("foot of the support")}, "{}", 10));
    return graph;
}

DeformOptions continuity_options(const SolveOptions& solve) {
    DeformOptions options;
    options.solve = solve;
    options.handles = 0.001;  // the edit is a soft target for the support
    return options;
}

}  // namespace ostraka::experiments
