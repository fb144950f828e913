// Figures 5.18 and 5.19 of the thesis: failures shown there, and the results of this library.
#include "chair.h"
#include "experiments.h"
#include "proportion.h"

#include "ostraka/geom/eigen.h"
#include "ostraka/measure/measure.h"

#include <algorithm>
#include <cmath>
#include <iostream>

namespace ostraka::experiments {

namespace {

using Eigen::Vector3d;

/// Figure 5.19.
std::vector<Problem> hand(const Path& folder, const Path& data, std::uint64_t vertices) {
    const auto subject = std::make_shared<Subject>(synthetic_subject(data, "hand", vertices));
    for (Annotation& annotation : subject->set.annotations) {
        if (annotation.tag != "ring finger" && annotation.tag != "little finger") continue;
        Attribute attribute;
        attribute.id = 50;
        attribute.name = "length";
        attribute.type = AttributeType::measure;
        attribute.measure.tool = "bounding";
        attribute.measure.direction = {0, 0, 1};
        const auto ends = extremes(subject->mesh, annotation, {0, 0, 1});
        attribute.measure.points.assign(ends.begin(), ends.end());
        annotation.attributes.push_back(attribute);
    }
    const std::vector<Point> rest = points_of(subject->mesh);
    std::vector<Point> edited = rest;
    const Annotation &ring = subject->part("ring finger"), &little = subject->part("little finger");
    const double knuckle = mean_of(rest, joint_of(subject->mesh, ring)).z();
    for (const Index v : vertices_of(subject->mesh, ring)) {
        const double above = std::max(0.0, rest[v].z() - knuckle);
        edited[v] = {rest[v].x(), rest[v].y(), rest[v].z() + 0.35 * above};
    }
    const std::vector<Ratio> ratios{{"little finger", "ring finger", 0.7, 0.9}};
    std::vector<Outcome> outcomes{{"rest", "hand-rest", rest, {}, 0, 0, {}},
                                  {"ring finger longer, unconstrained", "hand-unconstrained", edited, {}, 0, 0, {}}};
    for (const bool anchored : {false, true})
        outcomes.push_back(solved_from(*subject, edited, thesis_proportions(*subject, edited, ratios, anchored), many,
                                       anchored ? "the same from the joint" : "thesis, about the mean",
                                       anchored ? "hand-from-joint" : "hand-about-mean"));
    for (const bool hard : {false, true})
        outcomes.push_back(deformed_from(*subject, edited, proportion_graph(*subject, ratios, hard),
                                         solving(hard ? DeformOptions().solve : many), hard ? "ours, hard" : "ours, soft",
                                         hard ? "hand-hard" : "hand-soft"));
    TextTable table(
        {"run", "iterations", "s", "little / ring", "joint moves mm, mean (most)", "palm moves mm, mean (most)", "tip rises mm"});
    const std::vector<Index> joint = joint_of(subject->mesh, little), palm = vertices_of(subject->mesh, subject->part("palm"));
    for (const Outcome& outcome : outcomes) {
        write_outcome(folder, *subject, outcome,
                      outcome.file == "hand-rest" ? std::vector<double>() : distortions(subject->mesh, edited, outcome.points));
        const bool solved = outcome.summary.iterations > 0;
        const Index tip = measure_of(little).points[1];
        table.add({outcome.name, iterations_of(outcome), solved ? digits(outcome.seconds, 2) : "",
                   digits(value_of(*subject, ratios[0], outcome.points), 4),
                   solved ? both(moved(joint, edited, outcome.points), 3) : "",
                   solved ? both(moved(palm, edited, outcome.points), 3) : "",
                   digits(outcome.points[tip].z() - rest[tip].z(), 3)});
    }
    table.write(folder, "figure-5-19");
    std::cout << "Figure 5.19:\n\n" << table.markdown() << '\n';
    return {
        {"hand-thesis", "Little finger after the ring finger, about its mean",
         [=](const SolveOptions& solve) {
             return solved_from(*subject, edited, thesis_proportions(*subject, edited, ratios, false), solve, "", "").summary;
         }},
        {"hand-ours", "Little finger after the ring finger, from its joint", [=](const SolveOptions& solve) {
             return deformed_from(*subject, edited, proportion_graph(*subject, ratios, false), solving(solve), "", "").summary;
         }}};
}

/// Figure 5.18: the axis of a slanted patch of the support's surface is not the axis of the support.
std::vector<Problem> patch(const Path& folder, const Path& data, std::uint64_t vertices) {
    const auto chair = std::make_shared<Chair>(make_chair(data, vertices));
    const Subject& subject = chair->subject;
    const std::vector<Point> rest = points_of(subject.mesh);
    // A strip of the segment that winds half a turn around the leg's axis, from its foot to its head.
    const Vector3d x = chair->direction.unitOrthogonal(), y = chair->direction.cross(x);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Index v : chair->segment) {
        const double height = chair->direction.dot(eigen(rest[v]) - chair->point);
        low = std::min(low, height), high = std::max(high, height);
    }
    std::vector<Index> strip;
    for (const Index v : chair->segment) {
        const Vector3d d = eigen(rest[v]) - chair->point;
        const double share = (chair->direction.dot(d) - low) / (high - low);
        double angle = std::atan2(y.dot(d), x.dot(d)) - M_PI * share;
        angle -= 2 * M_PI * std::floor((angle + M_PI) / (2 * M_PI));
        if (std::abs(angle) < M_PI / 3) strip.push_back(v);
    }
    std::vector<Outcome> outcomes{{"rest", "chair-rest", rest, {}, 0, 0, {}},
                                  {"support turned, unconstrained", "chair-unconstrained", chair->edited, {}, 0, 0, {}}};
    outcomes.push_back(
        solved_from(subject, chair->edited, thesis_constraints(*chair, strip), many, "co-axiality of a patch", "chair-patch"));
    outcomes.push_back(solved_from(subject, chair->edited, thesis_constraints(*chair, chair->segment), many,
                                   "co-axiality of the whole segment", "chair-segment"));
    outcomes.push_back(deformed_from(subject, chair->edited, continuity_graph(*chair, false), continuity_options(many),
                                     "structural continuity", "chair-continuity"));
    outcomes.push_back(deformed_from(subject, chair->edited, continuity_graph(*chair, false, true), continuity_options(many),
                                     "structural continuity, and the foot keeps its shape", "chair-shape"));
    TextTable table({"run", "iterations", "s", "angle degrees", "distance mm", "segment from a rigid copy mm",
                     "stretch of the segment", "faces of it turned over"});
    const std::vector<bool> inside = [&] {
        std::vector<bool> flags(subject.mesh.number_of_vertices(), false);
        for (const Index v : chair->segment) flags[v] = true;
        return flags;
    }();
    for (const Outcome& outcome : outcomes) {
        const std::vector<double> stretch = distortions(subject.mesh, rest, outcome.points);
        write_outcome(folder, subject, outcome, outcome.file == "chair-rest" ? std::vector<double>() : stretch);
        Mesh mesh = subject.mesh;
        for (const Vertex v : mesh.vertices()) mesh.point(v) = outcome.points[v];
        double sum = 0, area = 0;
        std::size_t over = 0;
        for (const Face f : mesh.faces()) {
            const auto [a, b, c] = corners(mesh, f);
            if (!inside[a] || !inside[b] || !inside[c]) continue;
            const double weight = face_area(subject.mesh, f);
            sum += weight * stretch[f];
            area += weight;
            over += area_vector(mesh, f) * area_vector(subject.mesh, f) < 0 ? 1 : 0;
        }
        const AxisDeviation off = deviation(*chair, outcome.points);
        table.add({outcome.name, iterations_of(outcome), outcome.summary.iterations > 0 ? digits(outcome.seconds, 2) : "",
                   digits(off.angle, 3), digits(off.distance, 3),
                   digits(rigid_distance(subject, chair->segment, outcome.points), 3), digits(sum / area, 4),
                   std::to_string(over)});
    }
    table.write(folder, "figure-5-18");
    std::cout << "Figure 5.18:\n\n" << table.markdown() << '\n';
    return {{"chair-patch", "Co-axiality of a patch of the support",
             [=](const SolveOptions& solve) {
                 return solved_from(chair->subject, chair->edited, thesis_constraints(*chair, strip), solve, "", "").summary;
             }},
            {"chair-continuity", "Structural continuity of the support", [=](const SolveOptions& solve) {
                 return deformed_from(chair->subject, chair->edited, continuity_graph(*chair, false), continuity_options(solve),
                                      "", "")
                     .summary;
             }}};
}

}  // namespace

void before_and_after(const SemanticOptions& options) {
    const Path folder(options.output);
    const std::uint64_t vertices = options.vertices == 0 ? 25000 : options.vertices;
    std::vector<Problem> problems = patch(folder, options.data, vertices);
    for (Problem& problem : hand(folder, options.data, vertices)) problems.push_back(std::move(problem));
    compare_convergence(folder, problems, options.convergence);
}

}  // namespace ostraka::experiments
