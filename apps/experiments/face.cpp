// Proportions of parts (thesis, section 5.3.2), constrained as in the thesis and as in this library: a face (figure 5.17), a hand
// (figure 5.19).
#include "semantics.h"

#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/select/recipe.h"
#include "ostraka/synthetic/heads.h"
#include "ostraka/synthetic/make_mesh.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka::experiments {

namespace {

using Eigen::Vector3d;

/// Constrains length of `part` / length of `reference` to a range by changing the part. Lengths are the parts' measures
/// "length".
struct Ratio {
    std::string part, reference;
    double min, max;
};

const Measure& measure_of(const Annotation& part) {
    for (const Attribute& attribute : part.attributes)
        if (attribute.measure() != nullptr && attribute.name == "length") return *attribute.measure();
    fail_input(part.tag, "has no measure called length", "see the recipe that the experiment names");
}

double length(const Measure& measure, const std::vector<Point>& points) {
    const Vector3d edge = eigen(points[measure.points[1]] - points[measure.points[0]]);
    if (!measure.direction) return edge.norm();
    const Vector3d direction((*measure.direction)[0], (*measure.direction)[1], (*measure.direction)[2]);
    return std::abs(direction.normalized().dot(edge));
}

double value_of(const Subject& subject, const Ratio& ratio, const std::vector<Point>& points) {
    return length(measure_of(subject.part(ratio.part)), points) / length(measure_of(subject.part(ratio.reference)), points);
}

/// As in the thesis: parts stretched about their mean (or from their joint), and Laplacians along their borders, of equal weight.
Constraints thesis_constraints(const Subject& subject, const std::vector<Point>& edited, const std::vector<Ratio>& ratios,
                               bool anchored) {
    Constraints list;
    add_closeness(list, subject, edited, closeness_weight);
    for (const Ratio& ratio : ratios) {
        const Annotation& part = subject.part(ratio.part);
        const Measure &first = measure_of(part), &second = measure_of(subject.part(ratio.reference));
        const std::vector<Index> joint = joint_of(subject.mesh, part);
        std::set<Index> around(joint.begin(), joint.end());
        for (const Index v : joint)
            for (const Vertex w : subject.mesh.vertices_around_target(subject.mesh.halfedge(Vertex(v)))) around.insert(w.idx());
        add_laplacians(list, subject, {around.begin(), around.end()}, 1);
        const std::vector<Index> vertices = vertices_of(subject.mesh, part);
        std::vector<int> ids(vertices.begin(), vertices.end());
        const auto place = [&](Index v) {
            const auto at = std::find(ids.begin(), ids.end(), static_cast<int>(v)) - ids.begin();
            if (at == std::ssize(ids)) ids.push_back(static_cast<int>(v));
            return static_cast<int>(at);
        };
        kinds::Proportion kind{{ratio.min, ratio.max}, {{place(first.points[0]), place(first.points[1])}}};
        kind.part = static_cast<int>(ids.size());
        if (anchored)
            for (const Index v : joint) kind.anchors.push_back(place(v));
        kind.second = kinds::PinnedMeasure{{place(second.points[0]), place(second.points[1])}};
        const auto vector = [](const std::optional<std::array<double, 3>>& d) {
            return d ? std::optional(Vector3d((*d)[0], (*d)[1], (*d)[2])) : std::nullopt;
        };
        kind.measure.direction = vector(first.direction);
        kind.second->direction = vector(second.direction);
        list.push_back(make_constraint(kind, ids, 1, columns_of(subject.mesh)));
    }
    return list;
}

Method by_thesis(const Subject& subject, const std::vector<Point>& edited, const std::vector<Ratio>& ratios, bool anchored) {
    return thesis_method(subject, edited,
                         [&subject, edited, ratios, anchored] { return thesis_constraints(subject, edited, ratios, anchored); });
}

/// As in this library.
Method by_graph(const Subject& subject, const std::vector<Point>& edited, const std::vector<Ratio>& ratios, bool hard) {
    RelationGraph graph;
    for (const Ratio& ratio : ratios)
        graph.relationships.push_back(constraint(
            static_cast<int>(graph.relationships.size()), "proportion", {subject.id(ratio.part), subject.id(ratio.reference)},
            fmt::format(R"({{"measure1": "length", "measure2": "length", "minValue": {:f}, "maxValue": {:f}{}}})", ratio.min,
                        ratio.max, hard ? R"(, "hard": true)" : ""),
            1));
    return deform_method(subject, edited, std::move(graph));
}

struct FaceOptions : SemanticOptions {
    std::string mesh, recipe;
    void declare_options(OptionList& list) {
        SemanticOptions::declare_options(list);
        list("mesh", mesh, "mesh file of a face; without it a synthetic head");
        list("recipe", recipe, "recipe of its eyes and nose").required();
    }
};

/// A synthetic head, in mm, x forwards and z upwards, used if no scan is given: mean proportions of the synthetic heads (others
/// are drawn by head_archetype), with a longer nose and narrower eyes, so that the nose is 3 to 4 times as long as an eye is
/// high.
SyntheticMesh made_head(std::uint64_t vertices) {
    HeadShape shape;
    shape.nose_length = 11;
    shape.mouth_height = 10;
    shape.eye_opening = 1.25;
    MakeOptions options;
    options.vertices = vertices;
    return make_mesh(*head_object(shape), options);
}

/// Reduces the height of the eye by a factor about the centre of its measure, with a smooth transition around it.
void lower_eye(const Annotation& eye, double factor, std::vector<Point>& points) {
    const Measure& measure = measure_of(eye);
    const Vector3d bottom = eigen(points[measure.points[0]]), top = eigen(points[measure.points[1]]);
    const Vector3d middle = (bottom + top) / 2, up = (top - bottom).normalized();
    const double height = (top - bottom).norm();
    points = warped(std::move(points), [&](const Vector3d& p) {
        const Vector3d d = p - middle;
        return Vector3d(p + (factor - 1) * smooth_step(1.2 * height, 0.9 * height, d.norm()) * up.dot(d) * up);
    });
}

/// Lengthens the nose by a factor, starting from its root.
void lengthen_nose(const Annotation& nose, double factor, std::vector<Point>& points) {
    const Measure& measure = measure_of(nose);
    const Vector3d root = eigen(points[measure.points[0]]), tip = eigen(points[measure.points[1]]),
                   along = (tip - root).normalized();
    const double whole = (tip - root).norm();
    points = warped(std::move(points), [&](const Vector3d& p) {
        const Vector3d d = p - root;
        const double t = std::max(0.0, along.dot(d)), beside = (d - std::min(t, whole) * along).norm();
        return Vector3d(p + (factor - 1) * smooth_step(0.34 * whole, 0.25 * whole, beside) * t * along);
    });
}

/// The vertices outside the given parts.
std::vector<Index> outside(const Subject& subject, const std::vector<Ratio>& ratios) {
    std::vector<bool> rest(subject.mesh.number_of_vertices(), true);
    for (const Ratio& ratio : ratios)
        for (const Index v : subject.vertices(ratio.part)) rest[v] = false;
    return flagged(rest);
}

/// Faces with a corner on the border between one of the parts and the rest.
std::vector<Index> faces_at(const Subject& subject, const std::vector<Ratio>& ratios) {
    std::set<Index> list;
    for (const Ratio& ratio : ratios)
        for (const Index v : joint_of(subject.mesh, subject.part(ratio.part)))
            for (const Face f : subject.mesh.faces_around_target(subject.mesh.halfedge(Vertex(v))))
                if (f != Mesh::null_face()) list.insert(f.idx());
    return {list.begin(), list.end()};
}

void face_proportions(const FaceOptions& options) {
    const Path folder(options.output);
    SyntheticMesh made;
    if (options.mesh.empty()) made = made_head(options.vertices == 0 ? 25000 : options.vertices);
    else made.mesh = read_mesh(options.mesh).mesh;
    Subject face{{std::move(made.mesh), {}}};
    face.annotations = apply_recipe(options.recipe, face.mesh, made.face_labels);
    const std::vector<Point> rest = points_of(face.mesh);
    struct Case {
        std::string name, title;
        std::vector<Ratio> ratios;
        std::vector<Point> edited;
    };
    Case nose{"nose", "eyes lower, the nose follows", {{"nose", "left eye", 3, 4}}, rest};
    for (const char* eye : {"left eye", "right eye"}) lower_eye(face.part(eye), 0.75, nose.edited);
    Case eyes{
        "eyes", "nose longer, the eyes follow", {{"left eye", "nose", 0.25, 0.33}, {"right eye", "nose", 0.25, 0.33}}, rest};
    lengthen_nose(face.part("nose"), 1.4, eyes.edited);

    TextTable table = trial_table({"case", "first / second", "wanted", "first", "second", "the part moves, mean (most)",
                                   "the rest moves, mean (most)", "stretch at its border"});
    std::vector<Problem> problems;
    for (const Case& c : {nose, eyes}) {
        const Method thesis = by_thesis(face, c.edited, c.ratios, false), soft = by_graph(face, c.edited, c.ratios, false);
        Trials trials{face};
        trials.given("rest", "rest", rest);
        trials.given("edited, unconstrained", c.name + "-unconstrained", c.edited);
        trials.solved("thesis, 5 iterations", c.name + "-thesis-5", thesis, five);
        trials.solved("thesis, converged", c.name + "-thesis-converged", thesis, many);
        trials.solved("ours, 5 iterations", c.name + "-soft-5", soft, five);
        trials.solved("ours, converged", c.name + "-soft-converged", soft, many);
        trials.solved("ours, hard", c.name + "-hard", by_graph(face, c.edited, c.ratios, true));
        const Ratio& ratio = c.ratios.front();
        const std::vector<Index> others = outside(face, c.ratios), border = faces_at(face, c.ratios);
        const auto stretch = [&](const Outcome& outcome) { return distortions(face.mesh, c.edited, outcome.points); };
        const auto cells = [&](const Outcome& outcome) -> std::vector<std::string> {
            const auto length_of = [&](const std::string& part) {
                return fixed(length(measure_of(face.part(part)), outcome.points), 3);
            };
            return {c.title,
                    fixed(value_of(face, ratio, outcome.points), 4),
                    fixed(ratio.min, 2) + " to " + fixed(ratio.max, 2),
                    length_of(ratio.part),
                    length_of(ratio.reference),
                    outcome.if_solved(moved_text(face.vertices(ratio.part), c.edited, outcome.points, 3)),
                    outcome.if_solved(moved_text(others, c.edited, outcome.points, 4)),
                    outcome.if_solved(fixed(mean_over(face.mesh, border, stretch(outcome)), 4))};
        };
        trials.write(folder, table, cells, stretch);
        const std::string title = "Proportions of a face, " + c.title;
        problems.push_back(problem_of(c.name + "-thesis", title + ", the thesis's constraints", thesis));
        problems.push_back(problem_of(c.name + "-ours", title + ", ours", soft));
    }
    write_table(table, folder, "table");
    compare_convergence(folder, problems, options.convergence);
}

const Registration registered("face-proportions", "nose and eyes of a face (figure 5.17)", face_proportions);

}  // namespace

void proportions_of_hand(const SemanticOptions& options, Subject& subject, std::vector<Problem>& problems) {
    for (Annotation& annotation : subject.annotations.annotations)
        if (annotation.tag == "ring finger" || annotation.tag == "little finger") add_height(subject.mesh, annotation, "length");
    const std::vector<Point> rest = points_of(subject.mesh);
    std::vector<Point> edited = rest;
    const double knuckle = centre_of(rest, joint_of(subject.mesh, subject.part("ring finger"))).z();
    for (const Index v : subject.vertices("ring finger"))
        edited[v] = {rest[v].x(), rest[v].y(), rest[v].z() + 0.35 * std::max(0.0, rest[v].z() - knuckle)};
    const std::vector<Ratio> ratios{{"little finger", "ring finger", 0.7, 0.9}};
    const Method thesis = by_thesis(subject, edited, ratios, false), soft = by_graph(subject, edited, ratios, false);
    Trials trials{subject};
    trials.given("rest", "hand-rest", rest);
    trials.given("ring finger longer, unconstrained", "hand-unconstrained", edited);
    trials.solved("thesis, about the mean", "hand-about-mean", thesis, many);
    trials.solved("the same from the joint", "hand-from-joint", by_thesis(subject, edited, ratios, true), many);
    trials.solved("ours, soft", "hand-soft", soft, many);
    trials.solved("ours, hard", "hand-hard", by_graph(subject, edited, ratios, true));

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
    problems.push_back(problem_of("hand-thesis", "Little finger after the ring finger, about its mean", thesis));
    problems.push_back(problem_of("hand-ours", "Little finger after the ring finger, from its joint", soft));
}

}  // namespace ostraka::experiments
