// The baroque chair of figures 5.5 to 5.7 and 5.18 of the thesis: its arm is lengthened, and the support below it follows.
#include "semantics.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/axis/axis.h"
#include "ostraka/core/error.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka::experiments {

namespace {

using Eigen::Vector3d;

struct Chair {
    Subject subject;
    std::vector<Point> edited;  ///< left arm lengthened, its support rotated about its foot to meet the arm as before
    std::vector<Index>
        segment;                ///< vertices of the left support that continue the leg; also the annotation "foot of the support"
    std::vector<int> stations;  ///< for each vertex of `segment`: slice along the leg's axis
    int count = 0;              ///< number of slices
    Eigen::Vector3d point, direction;  ///< axis of the undeformed leg
};
constexpr double bend = 45;  ///< mm; distance of the supports' heads behind the legs' axes
constexpr double bend_from = 540, bend_to = 655;
constexpr double arm_from = -200;   ///< the arms change in front of this x
constexpr double longer = 0.18;     ///< relative elongation of the arm
constexpr double angle_limit = 10;  ///< degrees (section 5.2.2)
constexpr double our_weight = 200;

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
    foot.id = free_id(chair.subject.annotations);
    foot.tag = "foot of the support";
    foot.colour = {230, 60, 50};
    const std::set<Index> inside(chair.segment.begin(), chair.segment.end());
    for (const Face f : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, f);
        if (inside.count(a) + inside.count(b) + inside.count(c) == 3) foot.faces.push_back(f.idx());
    }
    chair.subject.annotations.annotations.push_back(foot);
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

/// The synthetic chair; the upper halves of the supports are bent backwards, so that only their feet continue the legs.
Chair make_chair(const Path& data, std::uint64_t vertices) {
    Chair chair;
    chair.subject = synthetic_subject(data, "chair", vertices, bent);
    find_segment(chair);
    stretch_arm(chair);
    return chair;
}

struct AxisDeviation {
    double angle = 0, distance = 0;  ///< degrees, mm
};
/// Deviation of the means of the segment's slices from the axis of the deformed leg.
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

/// As in the thesis: co-axiality of surface points with the leg, and Laplacians on the arm, with equal weights.
Method coaxial(const Chair& chair, const std::vector<Index>& constrained) {
    return thesis_method(chair.subject, chair.edited, [&chair, constrained] {
        Constraints list;
        add_closeness(list, chair.subject, chair.edited, closeness_weight);
        add_laplacians(list, chair.subject, chair.subject.vertices("left arm"), 1);
        list.push_back(make_constraint(kinds::CoAxiality{chair.direction, chair.point}, {constrained.begin(), constrained.end()},
                                       1, columns_of(chair.subject.mesh)));
        return list;
    });
}

/// As in this library: structural continuity of the support and the leg; with `shape` its foot also keeps its shape.
Method continuous(const Chair& chair, bool hard, bool shape = false) {
    RelationGraph graph;
    graph.relationships.push_back(constraint(0, "structural continuity",
                                             {chair.subject.id("left support"), chair.subject.id("front left leg")},
                                             hard ? R"({"hard": true})" : "{}", our_weight));
    if (shape) graph.relationships.push_back(constraint(1, "keep shape", {chair.subject.id("foot of the support")}, "{}", 10));
    DeformOptions options;
    options.handles = 0.001;  // the edit is a soft target for the support
    return deform_method(chair.subject, chair.edited, std::move(graph), options);
}

/// Figure 5.7: the foot of the support continues the leg.
void structural_continuity(const SemanticOptions& options) {
    const Path folder(options.output);
    const Chair chair = make_chair(options.data, options.vertices == 0 ? 90000 : options.vertices);
    const Subject& subject = chair.subject;
    const std::vector<Point> rest = points_of(subject.mesh);
    std::vector<double> marked(subject.mesh.number_of_vertices(), 0);
    for (const Index v : subject.vertices("left support")) marked[v] = 0.5;
    for (const Index v : subject.vertices("front left leg")) marked[v] = 0.25;
    for (const Index v : chair.segment) marked[v] = 1;
    write_coloured(folder / "segment.ply", subject.mesh, marked);

    Trials trials{subject};
    trials.given("rest", "rest", rest);
    std::vector<Point> arm = chair.edited;
    for (const Index v : subject.vertices("left support")) arm[v] = rest[v];
    for (const Index v : joint_of(subject.mesh, subject.part("left support"), &subject.part("left arm")))
        arm[v] = chair.edited[v];
    trials.given("arm longer", "arm", arm);
    trials.given("support turned, unconstrained", "unconstrained", chair.edited);
    const SolveOptions two{2, 0, 0, 0}, converged{2000, 1e-6, 0, 5};
    const Method thesis = coaxial(chair, chair.segment), soft = continuous(chair, false);
    const std::string name = "structural continuity";
    trials.solved("thesis, 2 iterations", "thesis-2", thesis, two);
    trials.solved("thesis, converged", "thesis-converged", thesis, converged);
    trials.solved(name + ", 2 iterations", "soft-2", soft, two);
    trials.solved(name + ", converged", "soft-converged", soft, converged);
    trials.solved(name + ", hard", "hard", continuous(chair, true));
    trials.solved(name + ", and the foot keeps its shape", "soft-shape", continuous(chair, false, true), converged);

    const auto stretch = [&](const Outcome& outcome) { return distortions(subject.mesh, chair.edited, outcome.points); };
    const auto cells = [&](const Outcome& outcome) -> std::vector<std::string> {
        const AxisDeviation off = deviation(chair, outcome.points);
        const auto stretch_of = [&](const std::string& tag) {
            return outcome.if_solved(fixed(mean_over(subject.mesh, subject.part(tag).faces, stretch(outcome)), 4));
        };
        return {fixed(off.angle, 3),
                fixed(off.distance, 3),
                fixed(rigid_distance(subject, chair.segment, outcome.points), 3),
                outcome.if_solved(moved_text(subject.vertices("left arm"), chair.edited, outcome.points, 3)),
                stretch_of("left support"),
                stretch_of("left arm")};
    };
    TextTable table = trial_table({"angle degrees", "distance mm", "its foot from a rigid copy mm",
                                   "arm moved by the constraint mm, mean (most)", "support: stretch", "arm: stretch"});
    trials.write(folder, table, cells, stretch);
    write_table(table, folder, "table");
    compare_convergence(folder,
                        {problem_of("thesis", "Structural continuity on the chair, the thesis's constraints", thesis),
                         problem_of("ours", "Structural continuity on the chair, the axis's stations", soft)},
                        options.convergence);
}

/// A strip of the segment that winds half a turn around the leg's axis, from its foot to its head.
std::vector<Index> winding_strip(const Chair& chair, const std::vector<Point>& rest) {
    const Vector3d x = chair.direction.unitOrthogonal(), y = chair.direction.cross(x);
    const auto from_axis = [&](Index v) { return Vector3d(eigen(rest[v]) - chair.point); };
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Index v : chair.segment) {
        const double height = chair.direction.dot(from_axis(v));
        low = std::min(low, height), high = std::max(high, height);
    }
    std::vector<Index> strip;
    for (const Index v : chair.segment) {
        const Vector3d d = from_axis(v);
        const double share = (chair.direction.dot(d) - low) / (high - low);
        double angle = std::atan2(y.dot(d), x.dot(d)) - M_PI * share;
        angle -= 2 * M_PI * std::floor((angle + M_PI) / (2 * M_PI));
        if (std::abs(angle) < M_PI / 3) strip.push_back(v);
    }
    return strip;
}

/// Figure 5.18: the axis of a slanted patch of the support's surface is not the axis of the support.
void patch(const SemanticOptions& options, const Chair& chair, std::vector<Problem>& problems) {
    const Subject& subject = chair.subject;
    const std::vector<Point> rest = points_of(subject.mesh);
    Trials trials{subject};
    trials.given("rest", "chair-rest", rest);
    trials.given("support turned, unconstrained", "chair-unconstrained", chair.edited);
    const Method of_patch = coaxial(chair, winding_strip(chair, rest)), soft = continuous(chair, false);
    trials.solved("co-axiality of a patch", "chair-patch", of_patch, many);
    trials.solved("co-axiality of the whole segment", "chair-segment", coaxial(chair, chair.segment), many);
    trials.solved("structural continuity", "chair-continuity", soft, many);
    trials.solved("structural continuity, and the foot keeps its shape", "chair-shape", continuous(chair, false, true), many);

    const std::vector<Index>& foot = subject.part("foot of the support").faces;
    const auto stretch = [&](const Outcome& outcome) { return distortions(subject.mesh, rest, outcome.points); };
    const auto cells = [&](const Outcome& outcome) -> std::vector<std::string> {
        const Mesh mesh = with_points(subject.mesh, outcome.points);
        const auto over = std::count_if(foot.begin(), foot.end(), [&](Index f) {
            return area_vector(mesh, Face(f)) * area_vector(subject.mesh, Face(f)) < 0;
        });
        const AxisDeviation off = deviation(chair, outcome.points);
        return {fixed(off.angle, 3), fixed(off.distance, 3), fixed(rigid_distance(subject, chair.segment, outcome.points), 3),
                fixed(mean_over(subject.mesh, foot, stretch(outcome)), 4), std::to_string(over)};
    };
    TextTable table = trial_table(
        {"angle degrees", "distance mm", "segment from a rigid copy mm", "stretch of the segment", "faces of it turned over"});
    trials.write(options.output, table, cells, stretch);
    write_table(table, options.output, "figure-5-18");
    problems.push_back(problem_of("chair-patch", "Co-axiality of a patch of the support", of_patch));
    problems.push_back(problem_of("chair-continuity", "Structural continuity of the support", soft));
}

void before_and_after(const SemanticOptions& options) {
    const std::uint64_t vertices = options.vertices == 0 ? 25000 : options.vertices;
    const Chair chair = make_chair(options.data, vertices);
    Subject hand = synthetic_subject(options.data, "hand", vertices);
    std::vector<Problem> problems;
    patch(options, chair, problems);
    proportions_of_hand(options, hand, problems);
    compare_convergence(options.output, problems, options.convergence);
}

const Registration registered_continuity("structural-continuity", "a chair's longer arm and its support (figure 5.7)",
                                         structural_continuity);
const Registration registered_patch("before-and-after", "a patch's axis, a finger's stretch (figures 5.18 and 5.19)",
                                    before_and_after);

}  // namespace

}  // namespace ostraka::experiments
