// Figure 4.6 and Table 4.1 of the thesis: a region is flattened over the vertices of the mesh and through a cage, the rest keeps
// its shape; displacements elsewhere, and time and memory for increasing resolution.
#include "convergence.h"
#include "harness.h"
#include "scenes.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/cage/cage.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/coords/nested.h"
#include "ostraka/core/error.h"
#include "ostraka/figures/plot.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/solver/make_constraint.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka::experiments {

namespace {

using Constraints = std::vector<std::unique_ptr<Constraint>>;

/// Constraints in addition to the plane: "nothing", "closeness" of every vertex or "laplacian" displacement of every vertex.
struct PlaneProblem {
    std::string rest_kind = "closeness";
    double plane_weight = 1;
};

Constraints plane_constraints(const Mesh& mesh, const Points& rest, const std::vector<Index>& region,
                              const PlaneProblem& problem) {
    Constraints list;
    for (const Vertex v : mesh.vertices()) {
        std::vector<int> ids{static_cast<int>(v.idx())};
        if (problem.rest_kind == "closeness") {
            list.push_back(make_constraint(kinds::Closeness{}, std::move(ids), 1, rest));
        } else if (problem.rest_kind == "laplacian") {
            for (const Vertex w : CGAL::vertices_around_target(mesh.halfedge(v), mesh)) ids.push_back(static_cast<int>(w.idx()));
            list.push_back(make_constraint(kinds::LaplacianDisplacement{}, std::move(ids), 1, rest));
        }
    }
    list.push_back(make_constraint(kinds::Plane{}, {region.begin(), region.end()}, problem.plane_weight, rest));
    return list;
}

/// Root mean square distance of the region's points from their best-fitting plane.
double flatness(const Points& points, const std::vector<Index>& region) {
    Eigen::Matrix3Xd part(3, static_cast<Eigen::Index>(region.size()));
    for (std::size_t i = 0; i < region.size(); ++i) part.col(static_cast<Eigen::Index>(i)) = points.col(region[i]);
    part.colwise() -= part.rowwise().mean().eval();
    const Eigen::Matrix3d scatter = part * part.transpose();
    const double minimum = symmetric_eigenvalues(scatter)[0];
    return std::sqrt(std::max(0.0, minimum) / static_cast<double>(region.size()));
}

struct Figure46Options : AnnotatedOptions {
    Figure46Options() { output = "experiments-output/figure-4-6"; }
    std::string cage, region;
    std::vector<std::string> kinds{"mean-value"};
    int nodes = 20000;
    void declare_options(OptionList& list) {
        AnnotatedOptions::declare_options(list);
        list("cage", cage, "cage of the mesh").positional().required();
        list("region", region, "tag of the region to be flattened").positional().required();
        list("kind", kinds, "kinds of cage coordinates");
        list("nodes", nodes, "number of nodes of the tetrahedra inside the cage", Range{1, 1e9});
    }
};

struct Case {
    std::string name, about;
    PlaneProblem problem;
    bool cage;
    int iterations;  ///< 0: until convergence
    std::string kind = "mean-value";
};

const std::vector<Case> all_cases{{"mesh-2", "mesh, 2 iterations", {"closeness"}, false, 2},
                                  {"cage-2", "cage, 2 iterations", {"closeness"}, true, 2},
                                  {"mesh-converged", "mesh, converged", {"closeness"}, false, 0},
                                  {"cage-converged", "cage, converged", {"closeness"}, true, 0},
                                  {"mesh-strong-2", "plane of weight 100, mesh, 2 iterations", {"closeness", 100}, false, 2},
                                  {"cage-strong-2", "plane of weight 100, cage, 2 iterations", {"closeness", 100}, true, 2},
                                  {"mesh-strong-converged", "plane of weight 100, mesh, converged", {"closeness", 100}, false, 0},
                                  {"cage-strong-converged", "plane of weight 100, cage, converged", {"closeness", 100}, true, 0},
                                  {"mesh-alone-2", "plane alone, mesh, 2 iterations", {"nothing"}, false, 2},
                                  {"cage-alone-2", "plane alone, cage, 2 iterations", {"nothing"}, true, 2}};

/// Cases through the cage, one per kind of coordinates.
std::vector<Case> cases_of(const std::vector<std::string>& kinds) {
    std::vector<Case> cases;
    for (const Case& listed : all_cases)
        for (const std::string& kind : listed.cage ? kinds : std::vector<std::string>{"mean-value"}) {
            Case& added = cases.emplace_back(listed);
            added.kind = kind;
            if (listed.cage && kinds.size() > 1) added.name += "-" + kind, added.about += ", " + kind;
        }
    return cases;
}

struct Solved {
    std::vector<double> moved;  ///< displacement of each vertex
    Points points;
    SolveSummary summary;
};

SolveOptions solving(int iterations) {
    return iterations > 0 ? SolveOptions{iterations, 0, 0, 0} : SolveOptions{5000, 1e-9, 0, 5};
}

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
    const std::size_t governing = governing_level(weights, region, levels, carrying_weights(levels));
    CageWeights extended(weights.rows() + weights.cols(), weights.cols());
    extended.topRows(weights.rows()) = weights;
    extended.bottomRows(weights.cols()).setIdentity();
    Points all(3, extended.rows());
    all << rest, cage_rest;
    for (std::size_t l = 0; l < levels.size(); ++l)
        for (const Index v : levels[l].cage.vertices)
            if (l != governing)
                list.push_back(
                    make_constraint(kinds::Closeness{}, {static_cast<int>(weights.rows()) + static_cast<int>(v)}, 1e6, all));
    return CageSpaceSolver(std::move(list), extended, cage_rest).solve(x, how);
}

void figure_4_6(const Figure46Options& options) {
    const Path folder(options.output);
    const auto [mesh, set] = options.read();
    const Mesh cage = read_mesh(options.cage).mesh;
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
    for (const Case& at : cases) {
        Solved& result = solved.emplace_back();
        Constraints constraints = plane_constraints(mesh, rest, region, at.problem);
        Points x = at.cage ? cage_rest : rest;
        const CageWeights& weights = weights_of.at(at.cage ? at.kind : options.kinds.front());
        if (!at.cage) result.summary = MeshSpaceSolver(std::move(constraints), rest).solve(x, solving(at.iterations));
        else if (levels.size() > 1)
            result.summary =
                solve_nested(std::move(constraints), weights, rest, cage_rest, levels, region, x, solving(at.iterations));
        else result.summary = CageSpaceSolver(std::move(constraints), weights, cage_rest).solve(x, solving(at.iterations));
        result.points = at.cage ? ostraka::points_of(weights, x) : x;
        result.moved = displacements(mesh_points(rest), mesh_points(result.points));
        if (at.cage) write_mesh(folder / (at.name + "-cage.ply"), with_points(cage, mesh_points(x)));
        if (at.problem.rest_kind != "nothing") farthest = std::max(farthest, mean_and_max(result.moved).max);
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
        const Solved& result = solved[i];
        const double after = flatness(result.points, region);
        std::string cells = fmt::format("{} | {} | {:.4f} | {:.2f}", cases[i].about, result.summary.iterations,
                                        100 * after / diagonal, 100 * after / flat);
        const auto column = [&](const std::string& tag, const std::vector<Index>& vertices) {
            const auto [mean, max] = mean_and_max(result.moved, vertices);
            cells += fmt::format(" | {:.3f} ({:.3f})", 100 * mean / diagonal, 100 * max / diagonal);
            rows(cases[i].name, result.summary.iterations, result.summary.regularised, after, after / flat, tag, mean, max);
        };
        column(options.region, region);
        for (const auto& [annotation, vertices] : others) column(annotation->tag, vertices);
        table.add(cells);
        add_summary(summary, cases[i].about, result, after / flat, diagonal, region, others);
        write_coloured(folder / (cases[i].name + ".ply"), with_points(mesh, mesh_points(result.points)), result.moved, farthest);
    }
    write_file(folder / "table.md", table.text());
    rows.write(folder / "table.csv");
    summary.write(folder / "summary.csv");
}

struct Table41Options {
    std::string made = "teapot", scan, output = "experiments-output/table-4-1";
    std::vector<int> sizes{20000, 50000, 70000, 100000, 150000, 200000, 280000, 500000};
    std::vector<double> direction{0, -1, 0};
    double share = 0.025;
    std::uint64_t cage_vertices = 200;
    int iterations = 50, convergence = 0;
    void declare_options(OptionList& list) {
        list("made", made, "name of a synthetic object");
        list("scan", scan, "mesh file instead; refined and simplified to each number of vertices");
        list("sizes", sizes, "numbers of vertices", Range{100, 1e8});
        list("direction", direction, "the region surrounds the vertex that is farthest in this direction");
        list("share", share, "area of the region, as a share of the surface", Range{0, 1});
        list("cage-vertices", cage_vertices, "number of vertices of the cage", Range{4, 1e6});
        list("iterations", iterations, "number of plain iterations that are timed", Range{1, 100000});
        list("convergence", convergence,
             "number of iterations, plain and accelerated, that are compared at the first resolution; 0: none", Range{0, 100000});
        list("output", output, "output folder");
    }
};

/// Seconds as published (thesis, Table 4.1) and as measured for its prototype: set-up and iterations.
struct PublishedTimes {
    double thesis_mesh, thesis_cage;
    std::optional<std::pair<double, double>> prototype_mesh, prototype_cage;
};
const std::map<std::uint64_t, PublishedTimes> published{{20'000, {0.228, 0.133, {{0.68, 0.33}}, {{0.25, 0.78}}}},
                                                        {50'000, {2.064, 0.393, {{18.7, 2.15}}, {{0.89, 1.7}}}},
                                                        {70'000, {2.866, 0.49, {}, {}}},
                                                        {100'000, {6.735, 0.819, {{69.9, 6.8}}, {{3.5, 3.1}}}},
                                                        {150'000, {15.543, 1.18, {}, {}}},
                                                        {200'000, {28.601, 1.622, {{689, 17.9}}, {{16, 5.5}}}},
                                                        {280'000, {45.566, 1.95, {}, {}}},
                                                        {500'000, {147.518, 5.019, {}, {}}}};

struct Measured {
    std::size_t vertices = 0, region = 0;
    Seconds weights, setup, iterate;  ///< coordinates in the cage; constraints, matrices and factorisation; iterations
    SolveSummary summary;
    std::optional<double> megabytes;
    double flat_before = 0, flat_after = 0;
    [[nodiscard]] Seconds all() const { return weights + setup + iterate; }
};

/// The given share of the surface nearest to the vertex that is farthest along `direction`.
std::vector<Index> region_of(const Mesh& mesh, const Points& rest, const std::vector<double>& direction, double share) {
    Eigen::Index seed = 0;
    (Eigen::RowVector3d(direction[0], direction[1], direction[2]) * rest).maxCoeff(&seed);
    Annotation region;
    region.faces = disc(mesh, Vertex(static_cast<Index>(seed)), share);
    return touched_vertices(mesh, region);
}

/// Set-up, and solutions from rest.
class FlatteningProblem {
public:
    FlatteningProblem(const Mesh& mesh, const std::vector<Index>& region, const std::string& rest_kind, const Mesh* cage)
        : rest_(columns_of(mesh)), region_(region) {
        if (cage != nullptr) {
            const Stopwatch watch;
            weights_ = compute_coordinates("mean-value", *cage, mesh).vertex;
            cage_ = columns_of(*cage);
            weighing_ = watch.seconds();
        }
        const Stopwatch watch;
        Constraints constraints = plane_constraints(mesh, rest_, region, {rest_kind});
        if (cage != nullptr) solver_ = std::make_unique<CageSpaceSolver>(std::move(constraints), weights_, cage_);
        else solver_ = std::make_unique<MeshSpaceSolver>(std::move(constraints), rest_);
        solver_->initialize();
        setup_ = watch.seconds();
    }

    Measured run(const SolveOptions& options) {
        Measured result;
        result.vertices = static_cast<std::size_t>(rest_.cols());
        result.region = region_.size();
        result.weights = weighing_;
        result.setup = setup_;
        Points x = weights_.size() > 0 ? cage_ : rest_;
        const Stopwatch watch;
        result.summary = solver_->solve(x, options);
        result.iterate = watch.seconds();
        if (!result.summary.usable) throw Error(ErrorKind::failure, "table 4.1", "a solution is not usable");
        result.flat_before = flatness(rest_, region_);
        result.flat_after = flatness(weights_.size() > 0 ? ostraka::points_of(weights_, x) : x, region_);
        return result;
    }

private:
    Points rest_, cage_;
    const std::vector<Index>& region_;
    CageWeights weights_;
    std::unique_ptr<Solver> solver_;
    Seconds weighing_, setup_;
};

std::string pair_text(const std::optional<std::pair<double, double>>& pair) {
    return pair ? fmt::format("{:.3g} / {:.3g}", pair->first, pair->second) : "-";
}

std::string cells_of(const Measured& mesh, const Measured& cage) {
    const auto megabytes = [](const Measured& m) { return m.megabytes ? fmt::format("{:.0f}", *m.megabytes) : "-"; };
    return fmt::format(
        "{} ({}) | {:.3f} / {:.3f} ({}) | {:.3f} / {:.3f} | {} | {:.3f} + {:.3f} / {:.3f} ({}) | {:.3f} + {:.3f} / {:.3f} | {} | "
        "{:.2g}, {:.2g} %",
        mesh.vertices, mesh.region, mesh.setup.wall, mesh.iterate.wall, mesh.summary.iterations, mesh.setup.processor,
        mesh.iterate.processor, megabytes(mesh), cage.weights.wall, cage.setup.wall, cage.iterate.wall, cage.summary.iterations,
        cage.weights.processor, cage.setup.processor, cage.iterate.processor, megabytes(cage),
        100 * mesh.flat_after / mesh.flat_before, 100 * cage.flat_after / cage.flat_before);
}

std::string published_cells(std::size_t vertices) {
    const auto found = published.find(vertices);
    if (found == published.end()) return "- | -";
    const PublishedTimes& times = found->second;
    return fmt::format("{:.3g}, {:.3g} | {}, {}", times.thesis_mesh, times.thesis_cage, pair_text(times.prototype_mesh),
                       pair_text(times.prototype_cage));
}

/// Plain and accelerated runs at one resolution, compared with a long run.
std::string convergence_tables(const Mesh& mesh, const std::vector<Index>& region, const Mesh& cage, int iterations,
                               const Path& folder) {
    std::vector<Problem> problems;
    for (const std::string kind : {"closeness", "laplacian"})
        for (const bool through_cage : {false, true}) {
            const std::string space = through_cage ? "cage" : "mesh";
            problems.push_back({kind + "-" + space, fmt::format("{}, {}, {} vertices", kind, space, mesh.number_of_vertices()),
                                [&, kind, through_cage](int count, int window) {
                                    FlatteningProblem problem(mesh, region, kind, through_cage ? &cage : nullptr);
                                    return problem.run({count, 0, 0, window}).summary;
                                }});
        }
    return compare_convergence(folder, problems, iterations, {0, 2, 5, 10}, 7);
}

void write_seconds(const Path& file, const std::string& name, std::map<std::string, PlotSeries>& lines) {
    Plot plot{"A region made planar, " + name + ": set-up and iterations, processor time",
              {"vertices", true, {}, {}},
              {"processor seconds", true, {}, {}},
              {}};
    for (auto& [label, line] : lines) plot.series.push_back(std::move(line));
    PlotSeries thesis_mesh{"thesis: ShapeOp", {}, true, true}, thesis_cage{"thesis: cage", {}, true, true},
        prototype{"prototype, set-up too: mesh", {}, true, true};
    for (const auto& [size, times] : published) {
        const auto x = static_cast<double>(size);
        thesis_mesh.points.push_back({x, times.thesis_mesh});
        thesis_cage.points.push_back({x, times.thesis_cage});
        if (const auto& both = times.prototype_mesh) prototype.points.push_back({x, both->first + both->second});
    }
    for (PlotSeries* line : {&thesis_mesh, &thesis_cage, &prototype}) plot.series.push_back(std::move(*line));
    write_plot(file, plot);
}

void table_4_1(const Table41Options& options) {
    if (options.direction.size() != 3) fail_usage("the direction needs three numbers", "e.g. --direction 0,-1,0");
    const Path folder(options.output);
    const Mesh finest = options.scan.empty()
                            ? Mesh()
                            : refined(read_mesh(options.scan).mesh,
                                      static_cast<std::uint64_t>(*std::max_element(options.sizes.begin(), options.sizes.end())));
    const std::string name = options.scan.empty() ? "made " + options.made : Path(options.scan).stem().string();
    Mesh cage;
    std::string convergence;
    Rows rows(
        "problem,space,vertices,region,weights_s,weights_processor_s,setup_s,setup_processor_s,iterations,iterations_s,"
        "iterations_processor_s,peak_MB,flatness_before,flatness_after");
    const std::string columns = fmt::format(
        "vertices (region) | mesh: set-up / {0} iterations (done), s | processor s | MB | cage of {1}: weights + set-up / "
        "iterations (done), s | processor s | MB | not flat, % of rest: mesh, cage",
        options.iterations, options.cage_vertices);
    std::map<std::string, Table> tables;
    tables.emplace("closeness",
                   Table(columns + " | thesis: ShapeOp, cage, s | prototype: mesh set-up / 50, cage set-up / 50, s", false));
    tables.emplace("laplacian", Table(columns, false));
    std::map<std::string, PlotSeries> lines;
    for (const int size : options.sizes) {
        const auto vertices = static_cast<std::uint64_t>(size);
        const Mesh mesh = options.scan.empty() ? made_mesh(options.made, vertices) : simplified(finest, vertices);
        const std::vector<Index> region = region_of(mesh, columns_of(mesh), options.direction, options.share);
        if (cage.is_empty()) {
            cage = make_cage(mesh, {.vertices = options.cage_vertices}).cage;
            convergence = convergence_tables(mesh, region, cage, options.convergence, folder);
        }
        for (const std::string kind : {"closeness", "laplacian"}) {
            std::vector<Measured> both;
            for (const bool through_cage : {false, true}) {
                const PeakMemory peak;
                FlatteningProblem problem(mesh, region, kind, through_cage ? &cage : nullptr);
                Measured& m = both.emplace_back(problem.run({options.iterations, 0, 0, 0}));
                m.megabytes = peak.megabytes();
                const std::string space = through_cage ? "cage" : "mesh";
                rows(kind, space, m.vertices, m.region, m.weights.wall, m.weights.processor, m.setup.wall, m.setup.processor,
                     m.summary.iterations, m.iterate.wall, m.iterate.processor, m.megabytes, m.flat_before, m.flat_after);
                PlotSeries& line = lines[kind + ", " + space];
                line.name = "here: " + kind + ", " + space;
                line.points.push_back({static_cast<double>(mesh.number_of_vertices()), m.all().processor});
            }
            const std::string cells = cells_of(both[0], both[1]);
            tables.at(kind).add(kind == "closeness" ? cells + " | " + published_cells(mesh.number_of_vertices()) : cells);
            fmt::print(stderr, "{} {}\n", kind, cells);
        }
    }
    write_seconds(folder / "seconds.svg", name, lines);
    const std::string text = fmt::format(
        "Table 4.1, {}: a plane on {:.3g} % of the surface.\n\nCloseness on every vertex\n\n{}\nLaplacian displacement on every "
        "vertex\n\n{}\n{}",
        name, 100 * options.share, tables.at("closeness").text(), tables.at("laplacian").text(), convergence);
    write_file(folder / "table.md", text);
    rows.write(folder / "table.csv");
    fmt::print("{}", text);
}

const Registration registered_figure("figure-4-6",
                                     "a region made planar, over the mesh and through a cage: motion of other parts", figure_4_6);
const Registration registered_table("table-4-1", "a region made planar, over the mesh and through a cage: time and memory",
                                    table_4_1);

}  // namespace

}  // namespace ostraka::experiments
