// Figure 4.6 of the thesis: a region is flattened over the vertices of the mesh and through a cage; displacements elsewhere.
#include "harness.h"
#include "plane_problem.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/coords/nested.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"

#include <algorithm>
#include <map>

namespace ostraka::experiments {

namespace {

struct Figure46Options {
    std::string mesh, annotations, cage, region, output = "experiments-output/figure-4-6";
    std::vector<std::string> kinds{"mean-value"};
    int nodes = 20000;
    void list_options(OptionList& list) {
        list("mesh", mesh, "mesh file").positional().required();
        list("annotations", annotations, "annotations of the mesh (.ant.json)").positional().required();
        list("cage", cage, "cage of the mesh").positional().required();
        list("region", region, "tag of the region to be flattened").positional().required();
        list("kind", kinds, "kinds of cage coordinates");
        list("nodes", nodes, "number of nodes of the tetrahedra inside the cage", Range{1, 1e9});
        list("output", output, "output folder");
    }
};

struct Case {
    std::string name, about;
    PlaneProblem problem;
    bool cage;
    int iterations;  ///< 0: until convergence
    std::string kind = "mean-value";
};

const std::vector<Case> all_cases{
    {"mesh-2", "mesh, 2 iterations", {"closeness"}, false, 2},
    {"cage-2", "cage, 2 iterations", {"closeness"}, true, 2},
    {"mesh-converged", "mesh, converged", {"closeness"}, false, 0},
    {"cage-converged", "cage, converged", {"closeness"}, true, 0},
    {"mesh-strong-2", "plane of weight 100, mesh, 2 iterations", {"closeness", 1, 100}, false, 2},
    {"cage-strong-2", "plane of weight 100, cage, 2 iterations", {"closeness", 1, 100}, true, 2},
    {"mesh-strong-converged", "plane of weight 100, mesh, converged", {"closeness", 1, 100}, false, 0},
    {"cage-strong-converged", "plane of weight 100, cage, converged", {"closeness", 1, 100}, true, 0},
    {"mesh-alone-2", "plane alone, mesh, 2 iterations", {"nothing"}, false, 2},
    {"cage-alone-2", "plane alone, cage, 2 iterations", {"nothing"}, true, 2}};

/// Cases through the cage, one per kind of coordinates.
std::vector<Case> cases_of(const std::vector<std::string>& kinds) {
    std::vector<Case> cases;
    for (const Case& one : all_cases) {
        if (!one.cage) cases.push_back(one);
        for (const std::string& kind : kinds) {
            if (!one.cage) break;
            cases.push_back(one);
            cases.back().kind = kind;
            if (kinds.size() > 1) cases.back().name += "-" + kind, cases.back().about += ", " + kind;
        }
    }
    return cases;
}

struct Solved {
    std::vector<double> moved;  ///< displacement of each vertex
    Points points;
    SolveSummary summary;
};

SolveOptions solving(const Case& one) {
    SolveOptions options;
    options.iterations = one.iterations > 0 ? one.iterations : 5000;
    options.tolerance = one.iterations > 0 ? 0 : 1e-9;
    options.window = one.iterations > 0 ? 0 : 5;
    return options;
}

using Constraints = std::vector<std::unique_ptr<Constraint>>;
using OtherParts = std::vector<std::pair<const Annotation*, std::vector<Index>>>;

/// The part itself, all others, and the one with the greatest mean displacement; displacements as shares of the diagonal.
void add_summary(Rows& summary, const std::string& name, const Solved& solved, double flatness, double diagonal,
                 const std::vector<Index>& region, const OtherParts& others) {
    std::vector<Index> all;
    std::string farthest = "none";
    MeanAndMax its;
    for (const auto& [annotation, vertices] : others) {
        all.insert(all.end(), vertices.begin(), vertices.end());
        const MeanAndMax moved = mean_and_max(solved.moved, vertices);
        if (moved.mean > its.mean) farthest = annotation->tag, its = moved;
    }
    const auto [mean, max] = mean_and_max(solved.moved, region);
    summary(name, solved.summary.iterations, flatness, mean / diagonal, max / diagonal,
            mean_and_max(solved.moved, all).mean / diagonal, farthest, its.mean / diagonal, its.max / diagonal);
}

/// The annotated parts other than the region, with their vertices outside of it.
OtherParts other_parts(const Mesh& mesh, const AnnotationSet& set, const std::string& tag, const std::vector<Index>& region) {
    OtherParts others;
    std::vector<bool> inside(mesh.number_of_vertices(), false);
    for (const Index v : region) inside[v] = true;
    for (const Annotation& annotation : set.annotations) {
        if (annotation.faces.empty() || annotation.all || annotation.tag == tag) continue;
        std::vector<Index> vertices = touched_vertices(mesh, annotation);
        std::erase_if(vertices, [&](Index v) { return inside[v]; });
        if (!vertices.empty()) others.emplace_back(&annotation, std::move(vertices));
    }
    return others;
}

/// Solves through nested cages: the levels that do not influence the region stay fixed.
SolveSummary solve_nested(Constraints list, const CageWeights& weights, const Points& rest, const Points& cage_rest,
                          const std::vector<CageLevel>& levels, const std::vector<Index>& region, Points& x,
                          const SolveOptions& how) {
    const std::size_t own = governing_level(weights, region, levels, carrying_weights(levels));
    CageWeights extended(weights.rows() + weights.cols(), weights.cols());
    extended.topRows(weights.rows()) = weights;
    extended.bottomRows(weights.cols()).setIdentity();
    Points all(3, extended.rows());
    all << rest, cage_rest;
    for (std::size_t l = 0; l < levels.size(); ++l)
        for (const Index v : levels[l].cage.vertices)
            if (l != own)
                list.push_back(
                    make_constraint(kinds::Closeness{}, {static_cast<int>(weights.rows()) + static_cast<int>(v)}, 1e6, all));
    return CageSpaceSolver(std::move(list), extended, cage_rest).solve(x, how);
}

void figure_4_6(const Figure46Options& options) {
    const Path folder(options.output);
    const Mesh mesh = read_mesh(options.mesh).mesh, cage = read_mesh(options.cage).mesh;
    const AnnotationSet set = read_annotations(options.annotations, mesh);
    const std::vector<Index> region = touched_vertices(mesh, tagged(set, options.region));
    if (region.empty()) fail_input(options.annotations, fmt::format("has no region '{}'", options.region));
    const Points rest = columns_of(mesh), cage_rest = columns_of(cage);
    const std::vector<Case> cases = cases_of(options.kinds);
    CoordinateOptions computing;
    computing.nodes = static_cast<std::uint64_t>(options.nodes);
    std::map<std::string, CageWeights> weights_of;
    for (const std::string& kind : options.kinds) weights_of[kind] = compute_coordinates(kind, cage, mesh, computing).vertex;
    const std::vector<CageLevel> levels = cage_levels(cage);

    std::vector<Solved> solved;
    double farthest = 0;  // one colour scale for all pictures
    for (const Case& one : cases) {
        Solved result;
        Constraints constraints = plane_constraints(mesh, rest, region, one.problem);
        Points x = one.cage ? cage_rest : rest;
        const CageWeights& weights = one.cage ? weights_of.at(one.kind) : weights_of.begin()->second;
        if (!one.cage) result.summary = MeshSpaceSolver(std::move(constraints), rest).solve(x, solving(one));
        else if (levels.size() == 1)
            result.summary = CageSpaceSolver(std::move(constraints), weights, cage_rest).solve(x, solving(one));
        else result.summary = solve_nested(std::move(constraints), weights, rest, cage_rest, levels, region, x, solving(one));
        result.points = one.cage ? ostraka::points_of(weights, x) : x;
        result.moved = displacements(mesh_points(rest), mesh_points(result.points));
        if (one.cage) write_mesh(folder / (one.name + "-cage.ply"), with_points(cage, mesh_points(x)));
        if (one.problem.rest_kind != "nothing") farthest = std::max(farthest, mean_and_max(result.moved).max);
        solved.push_back(std::move(result));
    }
    const double diagonal = box_diagonal(mesh), flat = flatness(rest, region);
    const OtherParts others = other_parts(mesh, set, options.region, region);
    std::string columns = "case | iterations | not flat, rms, % of the diagonal | % of rest | part itself";
    for (const auto& [annotation, vertices] : others) columns += " | " + annotation->tag;
    fmt::print(
        "Figure 4.6, '{}' ({} of {} vertices) made planar, cage of {}. Parts: displacement of their vertices, mean (max), % of "
        "the "
        "diagonal. Unless said, with closeness of weight 1 on every vertex. Colours of the meshes: displacement from 0 to "
        "{:.4g}.\n\n",
        options.region, region.size(), mesh.number_of_vertices(), cage.number_of_vertices(), farthest);
    Table table(columns);
    Rows rows("case,iterations,regularised,flatness,flatness_of_rest,part,mean_moved,max_moved"),
        summary("case,iterations,flatness_of_rest,mean,most,others_mean,other,other_mean,other_most");
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Solved& one = solved[i];
        const double after = flatness(one.points, region);
        std::string cells = fmt::format("{} | {} | {:.4f} | {:.2f}", cases[i].about, one.summary.iterations,
                                        100 * after / diagonal, 100 * after / flat);
        const auto column = [&](const std::string& tag, const std::vector<Index>& vertices) {
            const auto [mean, max] = mean_and_max(one.moved, vertices);
            cells += fmt::format(" | {:.3f} ({:.3f})", 100 * mean / diagonal, 100 * max / diagonal);
            rows(cases[i].name, one.summary.iterations, one.summary.regularised, after, after / flat, tag, mean, max);
        };
        column(options.region, region);
        for (const auto& [annotation, vertices] : others) column(annotation->tag, vertices);
        table.add(cells);
        add_summary(summary, cases[i].about, one, after / flat, diagonal, region, others);
        write_coloured(folder / (cases[i].name + ".ply"), with_points(mesh, mesh_points(one.points)), one.moved, farthest);
    }
    write_file(folder / "table.md", table.text());
    rows.write(folder / "table.csv");
    summary.write(folder / "summary.csv");
}

const Registration registered("figure-4-6", "a region made planar, over the mesh and through a cage: motion of other parts",
                              figure_4_6);

}  // namespace

}  // namespace ostraka::experiments
