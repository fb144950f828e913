// Figure 5.7 of the thesis: the arm of a chair is lengthened, and the foot of its support continues the leg.
#include "chair.h"
#include "coloured_mesh.h"
#include "experiments.h"

#include "ostraka/geom/eigen.h"

#include <iostream>

namespace ostraka::experiments {

void structural_continuity(const SemanticOptions& options) {
    const Path folder(options.output);
    const Chair chair = make_chair(options.data, options.vertices == 0 ? 90000 : options.vertices);
    const Subject& subject = chair.subject;
    std::vector<Outcome> outcomes;
    outcomes.push_back({"rest", "rest", points_of(subject.mesh), {}, 0, 0, {}});
    std::vector<double> marked(subject.mesh.number_of_vertices(), 0);
    for (const Index v : vertices_of(subject.mesh, subject.part("left support"))) marked[v] = 0.5;
    for (const Index v : vertices_of(subject.mesh, subject.part("front left leg"))) marked[v] = 0.25;
    for (const Index v : chair.segment) marked[v] = 1;
    write_coloured(folder / "segment.ply", subject.mesh, marked);
    Outcome arm{"arm longer", "arm", chair.edited, {}, 0, 0, {}};
    for (const Index v : vertices_of(subject.mesh, subject.part("left support"))) arm.points[v] = outcomes[0].points[v];
    for (const Index v : joint_of(subject.mesh, subject.part("left support"), &subject.part("left arm")))
        arm.points[v] = chair.edited[v];
    outcomes.push_back(arm);
    outcomes.push_back({"support turned, unconstrained", "unconstrained", chair.edited, {}, 0, 0, {}});
    const SolveOptions two{2, 0, 0, 0}, many{2000, 1e-6, 0, 5};
    outcomes.push_back(
        solved_from(subject, chair.edited, thesis_constraints(chair, chair.segment), two, "thesis, 2 iterations", "thesis-2"));
    outcomes.push_back(solved_from(subject, chair.edited, thesis_constraints(chair, chair.segment), many, "thesis, converged",
                                   "thesis-converged"));
    for (const auto& [name, file, hard, solve] : {std::tuple{"structural continuity, 2 iterations", "soft-2", false, two},
                                                  {"structural continuity, converged", "soft-converged", false, many},
                                                  {"structural continuity, hard", "hard", true, DeformOptions().solve}})
        outcomes.push_back(
            deformed_from(subject, chair.edited, continuity_graph(chair, hard), continuity_options(solve), name, file));
    outcomes.push_back(deformed_from(subject, chair.edited, continuity_graph(chair, false, true), continuity_options(many),
                                     "structural continuity, and the foot keeps its shape", "soft-shape"));

    const std::vector<Index> arm_vertices = vertices_of(subject.mesh, subject.part("left arm"));
    TextTable table({"run", "iterations", "s", "angle degrees", "distance mm", "its foot from a rigid copy mm",
                     "arm moved by the constraint mm, mean (most)", "support: stretch", "arm: stretch"});
    for (const Outcome& outcome : outcomes) {
        std::cerr << "  " << outcome.name << '\n';
        const std::vector<double> stretch = distortions(subject.mesh, chair.edited, outcome.points);
        write_outcome(folder, subject, outcome, outcome.file == "rest" ? std::vector<double>() : stretch);
        const AxisDeviation off = deviation(chair, outcome.points);
        const bool solved = outcome.summary.iterations > 0;
        const auto cell = [&](const std::string& text) { return solved ? text : std::string(); };
        const auto stretch_of = [&](const std::string& tag) {
            return cell(digits(mean_over(subject.mesh, subject.part(tag).faces, stretch), 4));
        };
        table.add({outcome.name, iterations_of(outcome), cell(digits(outcome.seconds, 1)), digits(off.angle, 3),
                   digits(off.distance, 3), digits(rigid_distance(subject, chair.segment, outcome.points), 3),
                   cell(both(moved(arm_vertices, chair.edited, outcome.points), 3)), stretch_of("left support"),
                   stretch_of("left arm")});
    }
    table.write(folder, "table");
    std::cout << table.markdown();
    compare_convergence(
        folder,
        {{"thesis", "Structural continuity on the chair, the thesis's constraints",
          [&](const SolveOptions& solve) {
              return solved_from(subject, chair.edited, thesis_constraints(chair, chair.segment), solve, "", "").summary;
          }},
         {"ours", "Structural continuity on the chair, the axis's stations",
          [&](const SolveOptions& solve) {
              return deformed_from(subject, chair.edited, continuity_graph(chair, false), continuity_options(solve), "", "")
                  .summary;
          }}},
        options.convergence);
}

}  // namespace ostraka::experiments
