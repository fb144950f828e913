// Figures 5.18 and 5.19 of the thesis: failures shown there, and the results of this library.
#include "chair.h"
#include "proportion.h"

#include "ostraka/measure/measure.h"

#include <algorithm>
#include <cmath>

namespace ostraka::experiments {

namespace {

using Eigen::Vector3d;

/// Adds the measure "length", along z.
void add_length(const Mesh& mesh, Annotation& part) {
    Attribute attribute;
    attribute.id = 50;
    attribute.name = "length";
    attribute.type = AttributeType::measure;
    attribute.measure.tool = "bounding";
    attribute.measure.direction = {0, 0, 1};
    const auto ends = extremes(mesh, part, {0, 0, 1});
    attribute.measure.points.assign(ends.begin(), ends.end());
    part.attributes.push_back(attribute);
}

/// Figure 5.19.
void hand(const SemanticOptions& options, Subject& subject, std::vector<Problem>& problems) {
    for (Annotation& annotation : subject.set.annotations)
        if (annotation.tag == "ring finger" || annotation.tag == "little finger") add_length(subject.mesh, annotation);
    const std::vector<Point> rest = points_of(subject.mesh);
    std::vector<Point> edited = rest;
    const double knuckle = centre_of(rest, joint_of(subject.mesh, subject.part("ring finger"))).z();
    for (const Index v : subject.vertices("ring finger"))
        edited[v] = {rest[v].x(), rest[v].y(), rest[v].z() + 0.35 * std::max(0.0, rest[v].z() - knuckle)};
    const std::vector<Ratio> ratios{{"little finger", "ring finger", 0.7, 0.9}};
    const auto thesis = [&subject, edited, ratios](bool anchored) {
        return thesis_proportions(subject, edited, ratios, anchored);
    };
    RelationGraph soft = proportion_graph(subject, ratios, false);
    Trials trials(subject, edited);
    trials.given("rest", "hand-rest", rest);
    trials.given("ring finger longer, unconstrained", "hand-unconstrained", edited);
    trials.thesis("thesis, about the mean", "hand-about-mean", thesis(false), many);
    trials.thesis("the same from the joint", "hand-from-joint", thesis(true), many);
    trials.deformed("ours, soft", "hand-soft", soft, {.solve = many});
    trials.deformed("ours, hard", "hand-hard", proportion_graph(subject, ratios, true), {});

    const Annotation& little = subject.part("little finger");
    const Index tip = measure_of(little).points[1];
    const std::vector<Index> joint = joint_of(subject.mesh, little), palm = subject.vertices("palm");
    const auto cells = [&](const Outcome& outcome) -> std::vector<std::string> {
        return {fixed(value_of(subject, ratios[0], outcome.points), 4),
                outcome.if_solved(moved_text(joint, edited, outcome.points, 3)),
                outcome.if_solved(moved_text(palm, edited, outcome.points, 3)),
                fixed(outcome.points[tip].z() - rest[tip].z(), 3)};
    };
    TextTable table = trial_table({"little / ring", "joint moves mm, mean (most)", "palm moves mm, mean (most)", "tip rises mm"});
    trials.write(options.output, table, cells,
                 [&](const Outcome& outcome) { return distortions(subject.mesh, edited, outcome.points); });
    write_table(table, options.output, "figure-5-19");
    problems.push_back(thesis_problem("hand-thesis", "Little finger after the ring finger, about its mean", subject, edited,
                                      [thesis] { return thesis(false); }));
    problems.push_back(
        deform_problem("hand-ours", "Little finger after the ring finger, from its joint", subject, edited, std::move(soft), {}));
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
    const std::vector<Index> strip = winding_strip(chair, rest);
    Trials trials(subject, chair.edited);
    trials.given("rest", "chair-rest", rest);
    trials.given("support turned, unconstrained", "chair-unconstrained", chair.edited);
    trials.thesis("co-axiality of a patch", "chair-patch", thesis_constraints(chair, strip), many);
    trials.thesis("co-axiality of the whole segment", "chair-segment", thesis_constraints(chair, chair.segment), many);
    trials.deformed("structural continuity", "chair-continuity", continuity_graph(chair, false), continuity_options(many));
    trials.deformed("structural continuity, and the foot keeps its shape", "chair-shape", continuity_graph(chair, false, true),
                    continuity_options(many));

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
    problems.push_back(thesis_problem("chair-patch", "Co-axiality of a patch of the support", subject, chair.edited,
                                      [&chair, strip] { return thesis_constraints(chair, strip); }));
    problems.push_back(deform_problem("chair-continuity", "Structural continuity of the support", subject, chair.edited,
                                      continuity_graph(chair, false), continuity_options({})));
}

void before_and_after(const SemanticOptions& options) {
    const std::uint64_t vertices = options.vertices == 0 ? 25000 : options.vertices;
    const Chair chair = make_chair(options.data, vertices);
    Subject subject = synthetic_subject(options.data, "hand", vertices);
    std::vector<Problem> problems;
    patch(options, chair, problems);
    hand(options, subject, problems);
    compare_convergence(options.output, problems, options.convergence);
}

const Registration registered("before-and-after", "a patch's axis, a finger's stretch (figures 5.18 and 5.19)", before_and_after);

}  // namespace

}  // namespace ostraka::experiments
