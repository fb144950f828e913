// Figure 4.6 of the thesis: a region is flattened over the vertices of the mesh and through a cage; displacements elsewhere.
#include "experiments.h"

#include "coloured_mesh.h"
#include "plane_problem.h"
#include "report.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/coords/nested.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>

namespace ostraka::experiments {

namespace {

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

using OtherParts = std::vector<std::pair<const Annotation*, std::vector<Index>>>;

std::pair<double, double> mean_and_most(const std::vector<double>& moved, const std::vector<Index>& vertices) {
    double sum = 0, maximum = 0;
    for (const Index v : vertices) sum += moved[v], maximum = std::max(maximum, moved[v]);
    return {sum / static_cast<double>(vertices.size()), maximum};
}

/// The part itself, all others, and the one with the greatest mean displacement; displacements as shares of the diagonal.
std::string summary_row(const std::string& name, const Solved& one, double flatness, double diagonal,
                        const std::vector<Index>& region, const OtherParts& others) {
    const auto [mean, most] = mean_and_most(one.moved, region);
    std::vector<Index> all;
    std::string other;
    double other_mean = -1, other_most = 0;
    for (const auto& [annotation, vertices] : others) {
        all.insert(all.end(), vertices.begin(), vertices.end());
        const auto [its_mean, its_most] = mean_and_most(one.moved, vertices);
        if (its_mean > other_mean) other = annotation->tag, other_mean = its_mean, other_most = its_most;
    }
    return '"' + name +
           format("\",%d,%.6g,%.6g,%.6g,%.6g,\"", one.summary.iterations, flatness, mean / diagonal, most / diagonal,
                  all.empty() ? 0 : mean_and_most(one.moved, all).first / diagonal) +
           (other_mean > 0 ? other : "none") +
           format("\",%.6g,%.6g\n", std::max(other_mean, 0.0) / diagonal, other_most / diagonal);
}

const Annotation& region_of(const AnnotationSet& set, const std::string& tag, const std::string& file) {
    for (const Annotation& annotation : set.annotations)
        if (annotation.tag == tag && !annotation.faces.empty()) return annotation;
    fail_input(file, "has no region '" + tag + "'");
}

}  // namespace

void figure_4_6(const Figure46Options& options) {
    const Path folder(options.output);
    std::filesystem::create_directories(folder);
    const Mesh mesh = read_mesh(options.mesh).mesh, cage = read_mesh(options.cage).mesh;
    const AnnotationSet set = read_annotations(options.annotations, mesh);
    const std::vector<Index> region = touched_vertices(mesh, region_of(set, options.region, options.annotations));
    const Points rest = solver_points(mesh), cage_rest = solver_points(cage);
    const std::vector<Case> cases = cases_of(options.kinds);
    CoordinateOptions computing;
    computing.nodes = static_cast<std::uint64_t>(options.nodes);
    std::map<std::string, CageWeights> weights_of;
    for (const std::string& kind : options.kinds) weights_of[kind] = compute_coordinates(kind, cage, mesh, computing).vertex;
    const double diagonal = box_diagonal(mesh), flat = flatness(rest, region);
    // In nested cages, the levels that do not influence the region stay fixed.
    const std::vector<CageLevel> levels = cage_levels(cage);
    const auto through_its_own = [&](std::vector<std::unique_ptr<Constraint>> list, const CageWeights& weights, Points& x,
                                     const SolveOptions& how) {
        const std::size_t own = level_that_holds(weights, region, levels, carrying_weights(levels));
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
    };

    std::vector<Solved> solved;
    for (const Case& one : cases) {
        Solved result;
        auto constraints = plane_constraints(mesh, rest, region, one.problem);
        Points x = one.cage ? cage_rest : rest;
        const CageWeights& weights = one.cage ? weights_of.at(one.kind) : weights_of.begin()->second;
        if (one.cage && levels.size() > 1) result.summary = through_its_own(std::move(constraints), weights, x, solving(one));
        else if (one.cage) result.summary = CageSpaceSolver(std::move(constraints), weights, cage_rest).solve(x, solving(one));
        else result.summary = MeshSpaceSolver(std::move(constraints), rest).solve(x, solving(one));
        result.points = one.cage ? ostraka::points_of(weights, x) : x;
        result.moved = displacements(mesh_points(rest), mesh_points(result.points));
        if (one.cage) write_mesh(folder / (one.name + "-cage.ply"), with_points(cage, mesh_points(x)));
        solved.push_back(std::move(result));
    }
    // One colour scale for all pictures.
    double farthest = 0;
    for (std::size_t i = 0; i < cases.size(); ++i)
        if (cases[i].problem.rest_kind != "nothing")
            farthest = std::max(farthest, *std::max_element(solved[i].moved.begin(), solved[i].moved.end()));
    std::string text = "| case | iterations | not flat, rms, % of the diagonal | % of rest | ", rule = "|---|---|---|---|---|",
                rows = "case,iterations,regularised,flatness,flatness_of_rest,part,mean_moved,max_moved\n", body,
                summary = "case,iterations,flatness_of_rest,mean,most,others_mean,other,other_mean,other_most\n";
    text += "part itself |";
    OtherParts others;
    std::vector<bool> inside(mesh.number_of_vertices(), false);
    for (const Index v : region) inside[v] = true;
    for (const Annotation& annotation : set.annotations) {
        if (annotation.faces.empty() || annotation.all || annotation.tag == options.region) continue;
        std::vector<Index> vertices = touched_vertices(mesh, annotation);
        std::erase_if(vertices, [&](Index v) { return inside[v]; });
        if (vertices.empty()) continue;
        text += ' ' + annotation.tag + " |";
        rule += "---|";
        others.emplace_back(&annotation, std::move(vertices));
    }
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Solved& one = solved[i];
        const double after = flatness(one.points, region);
        body += "| " + cases[i].about +
                format(" | %d | %.4f | %.2f |", one.summary.iterations, 100 * after / diagonal, 100 * after / flat);
        const auto column = [&](const std::string& tag, const std::vector<Index>& vertices) {
            const auto [mean, maximum] = mean_and_most(one.moved, vertices);
            body += format(" %.3f (%.3f) |", 100 * mean / diagonal, 100 * maximum / diagonal);
            rows += cases[i].name +
                    format(",%d,%d,%.6g,%.6g,\"", one.summary.iterations, int(one.summary.regularised), after, after / flat) +
                    tag + format("\",%.6g,%.6g\n", mean, maximum);
        };
        column(options.region, region);
        for (const auto& [annotation, vertices] : others) column(annotation->tag, vertices);
        body += '\n';
        summary += summary_row(cases[i].about, one, after / flat, diagonal, region, others);
        write_coloured(folder / (cases[i].name + ".ply"), with_points(mesh, mesh_points(one.points)), one.moved, farthest);
    }
    text =
        "Figure 4.6, '" + options.region + "' (" + std::to_string(region.size()) + " of " +
        std::to_string(mesh.number_of_vertices()) + " vertices) made plane, cage of " +
        std::to_string(cage.number_of_vertices()) +
        ". Parts: how far their vertices move, mean (most), % of the diagonal. Unless said, with closeness of weight 1 on every "
        "vertex. Colours of the meshes: displacement from 0 to " +
        format("%.4g", farthest) + ".\n\n" + text + '\n' + rule + '\n' + body;
    write_file(folder / "table.md", text);
    write_file(folder / "table.csv", rows);
    write_file(folder / "summary.csv", summary);
    std::cout << text;
}

}  // namespace ostraka::experiments
