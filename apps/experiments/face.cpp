// Figure 5.17 of the thesis: proportions of a face.
#include "proportion.h"

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

struct FaceOptions : SemanticOptions {
    std::string mesh, recipe;
    void list_options(OptionList& list) {
        SemanticOptions::list_options(list);
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

/// 1 within `near`, 0 beyond `far`.
double falloff(double distance, double near, double far) {
    const double t = std::clamp((far - distance) / (far - near), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// Reduces the height of the eye by a factor about the centre of its measure, with a smooth transition around it.
void lower_eye(const Annotation& eye, double factor, std::vector<Point>& points) {
    const Measure& measure = measure_of(eye);
    const Vector3d bottom = eigen(points[measure.points[0]]), top = eigen(points[measure.points[1]]);
    const Vector3d middle = (bottom + top) / 2, up = (top - bottom).normalized();
    const double height = (top - bottom).norm();
    points = warped(std::move(points), [&](const Vector3d& p) {
        const Vector3d d = p - middle;
        return Vector3d(p + (factor - 1) * falloff(d.norm(), 0.9 * height, 1.2 * height) * up.dot(d) * up);
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
        return Vector3d(p + (factor - 1) * falloff(beside, 0.25 * whole, 0.34 * whole) * t * along);
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
    Subject face{std::move(made.mesh), {}};
    face.set = apply_recipe(options.recipe, face.mesh, made.face_labels);
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
        Trials trials(face, c.edited);
        trials.given("rest", "rest", rest);
        trials.given("edited, unconstrained", c.name + "-unconstrained", c.edited);
        const auto thesis = [&face, c] { return thesis_proportions(face, c.edited, c.ratios, false); };
        trials.thesis("thesis, 5 iterations", c.name + "-thesis-5", thesis(), five);
        trials.thesis("thesis, converged", c.name + "-thesis-converged", thesis(), many);
        RelationGraph soft = proportion_graph(face, c.ratios, false);
        trials.deformed("ours, 5 iterations", c.name + "-soft-5", soft, {.solve = five});
        trials.deformed("ours, converged", c.name + "-soft-converged", soft, {.solve = many});
        trials.deformed("ours, hard", c.name + "-hard", proportion_graph(face, c.ratios, true), {});
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
        problems.push_back(thesis_problem(c.name + "-thesis", "Proportions of a face, " + c.title + ", the thesis's constraints",
                                          face, c.edited, thesis));
        problems.push_back(deform_problem(c.name + "-ours", "Proportions of a face, " + c.title + ", ours", face, c.edited,
                                          std::move(soft), {}));
    }
    write_table(table, folder, "table");
    compare_convergence(folder, problems, options.convergence);
}

const Registration registered("face-proportions", "nose and eyes of a face (figure 5.17)", face_proportions);

}  // namespace

}  // namespace ostraka::experiments
