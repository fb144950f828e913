// Figure 5.7 of the thesis: the arm of a chair is lengthened, and the foot of its support continues the leg.
#include "chair.h"

namespace ostraka::experiments {

namespace {

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

    Trials trials(subject, chair.edited);
    trials.given("rest", "rest", rest);
    std::vector<Point> arm = chair.edited;
    for (const Index v : subject.vertices("left support")) arm[v] = rest[v];
    for (const Index v : joint_of(subject.mesh, subject.part("left support"), &subject.part("left arm")))
        arm[v] = chair.edited[v];
    trials.given("arm longer", "arm", arm);
    trials.given("support turned, unconstrained", "unconstrained", chair.edited);
    const SolveOptions two{2, 0, 0, 0}, many{2000, 1e-6, 0, 5}, usual = DeformOptions().solve;
    trials.thesis("thesis, 2 iterations", "thesis-2", thesis_constraints(chair, chair.segment), two);
    trials.thesis("thesis, converged", "thesis-converged", thesis_constraints(chair, chair.segment), many);
    const std::string name = "structural continuity";
    trials.deformed(name + ", 2 iterations", "soft-2", continuity_graph(chair, false), continuity_options(two));
    trials.deformed(name + ", converged", "soft-converged", continuity_graph(chair, false), continuity_options(many));
    trials.deformed(name + ", hard", "hard", continuity_graph(chair, true), continuity_options(usual));
    trials.deformed(name + ", and the foot keeps its shape", "soft-shape", continuity_graph(chair, false, true),
                    continuity_options(many));

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
                        {thesis_problem("thesis", "Structural continuity on the chair, the thesis's constraints", subject,
                                        chair.edited, [&] { return thesis_constraints(chair, chair.segment); }),
                         deform_problem("ours", "Structural continuity on the chair, the axis's stations", subject, chair.edited,
                                        continuity_graph(chair, false), continuity_options({}))},
                        options.convergence);
}

const Registration registered("structural-continuity", "a chair's longer arm and its support (figure 5.7)",
                              structural_continuity);

}  // namespace

}  // namespace ostraka::experiments
