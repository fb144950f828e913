// Table 4.1 of the thesis: a region flattened over the vertices of the mesh and through a cage, for increasing resolution.
#include "convergence.h"
#include "harness.h"
#include "plane_problem.h"

#include "ostraka/cage/cage.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/core/error.h"
#include "ostraka/figures/plot.h"
#include "ostraka/io/mesh_file.h"

#include <algorithm>
#include <map>

namespace ostraka::experiments {

namespace {

struct Table41Options {
    std::string made = "teapot", scan, output = "experiments-output/table-4-1";
    std::vector<int> sizes{20000, 50000, 70000, 100000, 150000, 200000, 280000, 500000};
    std::vector<double> direction{0, -1, 0};
    double share = 0.025;
    std::uint64_t cage_vertices = 200;
    int iterations = 50, convergence = 0;
    void list_options(OptionList& list) {
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

SolveOptions solving(int iterations, int window) {
    SolveOptions options;
    options.iterations = iterations;
    options.tolerance = 0;
    options.window = window;
    return options;
}

/// Set-up and solution from rest; `solve` receives the options of a run and stores the mesh vertices in `x`.
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
        auto constraints = plane_constraints(mesh, rest_, region, {rest_kind});
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
                                    return problem.run(solving(count, window)).summary;
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
                Measured& m = both.emplace_back(problem.run(solving(options.iterations, 0)));
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

const Registration registered("table-4-1", "a region made planar, over the mesh and through a cage: time and memory", table_4_1);

}  // namespace

}  // namespace ostraka::experiments
