// Figure 5.17 of the thesis: proportions of a face.
#include "experiments.h"
#include "proportion.h"

#include "ostraka/geom/eigen.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/select/recipe.h"
#include "ostraka/synthetic/heads.h"
#include "ostraka/synthetic/make_mesh.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>

namespace ostraka::experiments {

namespace {

using Eigen::Vector3d;

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
    for (Point& p : points) {
        const Vector3d d = eigen(p) - middle;
        p = point_of(eigen(p) + (factor - 1) * falloff(d.norm(), 0.9 * height, 1.2 * height) * up.dot(d) * up);
    }
}

/// Lengthens the nose by a factor, starting from its root.
void lengthen_nose(const Annotation& nose, double factor, std::vector<Point>& points) {
    const Measure& measure = measure_of(nose);
    const Vector3d root = eigen(points[measure.points[0]]), tip = eigen(points[measure.points[1]]),
                   along = (tip - root).normalized();
    const double whole = (tip - root).norm();
    for (Point& p : points) {
        const Vector3d d = eigen(p) - root;
        const double t = std::max(0.0, along.dot(d)), beside = (d - std::min(t, whole) * along).norm();
        p = point_of(eigen(p) + (factor - 1) * falloff(beside, 0.25 * whole, 0.34 * whole) * t * along);
    }
}

/// The vertices outside the given parts.
std::vector<Index> outside(const Subject& subject, const std::vector<Ratio>& ratios) {
    std::vector<bool> rest(subject.mesh.number_of_vertices(), true);
    for (const Ratio& ratio : ratios)
        for (const Index v : vertices_of(subject.mesh, subject.part(ratio.part))) rest[v] = false;
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

}  // namespace

void face_proportions(const SemanticOptions& options) {
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

    TextTable table({"case", "run", "iterations", "s", "first / second", "wanted", "first", "second",
                     "the part moves, mean (most)", "the rest moves, mean (most)", "stretch at its border"});
    std::vector<Problem> problems;
    const Outcome before{"rest", "rest", rest, {}, 0, 0, {}};
    write_outcome(folder, face, before);
    for (const Case& c : {nose, eyes}) {
        std::vector<Outcome> outcomes{before, {"edited, unconstrained", c.name + "-unconstrained", c.edited, {}, 0, 0, {}}};
        for (const auto& [name, file, solve] :
             {std::tuple{"thesis, 5 iterations", "thesis-5", five}, {"thesis, converged", "thesis-converged", many}})
            outcomes.push_back(solved_from(face, c.edited, thesis_proportions(face, c.edited, c.ratios, false), solve, name,
                                           c.name + "-" + file));
        for (const auto& [name, file, hard, solve] : {std::tuple{"ours, 5 iterations", "soft-5", false, five},
                                                      {"ours, converged", "soft-converged", false, many},
                                                      {"ours, hard", "hard", true, DeformOptions().solve}})
            outcomes.push_back(
                deformed_from(face, c.edited, proportion_graph(face, c.ratios, hard), solving(solve), name, c.name + "-" + file));
        const std::vector<Index> others = outside(face, c.ratios), part = vertices_of(face.mesh, face.part(c.ratios[0].part));
        const std::vector<Index> border = faces_at(face, c.ratios);
        for (const Outcome& outcome : outcomes) {
            if (outcome.file != "rest") write_outcome(folder, face, outcome, distortions(face.mesh, c.edited, outcome.points));
            const Ratio& ratio = c.ratios.front();
            const bool solved = outcome.summary.iterations > 0;
            const std::string wanted = digits(ratio.min, 2) + " to " + digits(ratio.max, 2);
            table.add({c.title, outcome.name, iterations_of(outcome), solved ? digits(outcome.seconds, 2) : "",
                       digits(value_of(face, ratio, outcome.points), 4), wanted,
                       digits(length(measure_of(face.part(ratio.part)), outcome.points), 3),
                       digits(length(measure_of(face.part(ratio.reference)), outcome.points), 3),
                       solved ? both(moved(part, c.edited, outcome.points), 3) : "",
                       solved ? both(moved(others, c.edited, outcome.points), 4) : "",
                       solved ? digits(mean_over(face.mesh, border, distortions(face.mesh, c.edited, outcome.points)), 4) : ""});
        }
        problems.push_back(
            {c.name + "-thesis", "Proportions of a face, " + c.title + ", the thesis's constraints",
             [&face, c](const SolveOptions& solve) {
                 return solved_from(face, c.edited, thesis_proportions(face, c.edited, c.ratios, false), solve, "", "").summary;
             }});
        problems.push_back(
            {c.name + "-ours", "Proportions of a face, " + c.title + ", ours", [&face, c](const SolveOptions& solve) {
                 return deformed_from(face, c.edited, proportion_graph(face, c.ratios, false), solving(solve), "", "").summary;
             }});
    }
    table.write(folder, "table");
    std::cout << table.markdown();
    compare_convergence(folder, problems, options.convergence);
}

}  // namespace ostraka::experiments
