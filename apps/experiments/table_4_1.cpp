// Table 4.1 of the thesis: a region flattened over the vertices of the mesh and through a cage, for increasing resolution.
#include "experiments.h"

#include "convergence.h"
#include "plane_problem.h"
#include "report.h"

#include "ostraka/cage/cage.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/remesh/refine.h"
#include "ostraka/remesh/simplify.h"
#include "ostraka/synthetic/make_mesh.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>

namespace ostraka::experiments {

namespace {

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

/// The sequence of meshes: synthetic, or a scan refined and simplified.
class Subject {
public:
    explicit Subject(const Table41Options& options) : options_(options) {
        if (options.scan.empty()) return;
        finest_ = read_mesh(options.scan).mesh;
        const std::uint64_t maximum = *std::max_element(options.sizes.begin(), options.sizes.end());
        RefineOptions refining;
        refining.scheme = RefineOptions::Scheme::loop;
        refining.levels = 1;
        while (finest_.number_of_vertices() < maximum) refine(finest_, refining);
    }
    [[nodiscard]] std::string name() const {
        return options_.scan.empty() ? "made " + options_.made : Path(options_.scan).stem().string();
    }
    [[nodiscard]] Mesh at(std::uint64_t vertices) const {
        if (options_.scan.empty()) {
            MakeOptions making;
            making.vertices = vertices;
            return make_mesh(synthetic_object(options_.made), making).mesh;
        }
        Mesh mesh = finest_;
        SimplifyOptions simplifying;
        simplifying.vertices = vertices;
        if (mesh.number_of_vertices() > vertices) simplify(mesh, simplifying);
        return mesh;
    }

private:
    const Table41Options& options_;
    Mesh finest_;
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
class Problem {
public:
    Problem(const Mesh& mesh, const std::vector<Index>& region, const std::string& rest_kind, const Mesh* cage)
        : rest_(solver_points(mesh)), region_(region) {
        if (cage != nullptr) {
            const Stopwatch watch;
            weights_ = compute_coordinates("mean-value", *cage, mesh).vertex;
            cage_ = solver_points(*cage);
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

std::string megabytes(const Measured& m) { return m.megabytes ? format("%.0f", *m.megabytes) : "-"; }

std::string pair_text(const std::optional<std::pair<double, double>>& pair) {
    return pair ? format("%.3g / %.3g", pair->first, pair->second) : "-";
}

std::string row(const Measured& mesh, const Measured& cage, bool beside) {
    std::string text = format("| %zu (%zu) |", mesh.vertices, mesh.region);
    text += format(" %.3f / %.3f (%d) | %.3f / %.3f | %s |", mesh.setup.wall, mesh.iterate.wall, mesh.summary.iterations,
                   mesh.setup.processor, mesh.iterate.processor, megabytes(mesh).c_str());
    text += format(" %.3f + %.3f / %.3f (%d) | %.3f + %.3f / %.3f | %s |", cage.weights.wall, cage.setup.wall, cage.iterate.wall,
                   cage.summary.iterations, cage.weights.processor, cage.setup.processor, cage.iterate.processor,
                   megabytes(cage).c_str());
    text += format(" %.2g, %.2g %% |", 100 * mesh.flat_after / mesh.flat_before, 100 * cage.flat_after / cage.flat_before);
    const auto known = published.find(mesh.vertices);
    if (!beside) return text + '\n';
    if (known == published.end()) return text + " - | - |\n";
    const PublishedTimes& o = known->second;
    return text + format(" %.3g, %.3g |", o.thesis_mesh, o.thesis_cage) + ' ' + pair_text(o.prototype_mesh) + ", " +
           pair_text(o.prototype_cage) + " |\n";
}

std::string csv_row(const std::string& kind, const char* space, const Measured& m) {
    return kind + ',' + space +
           format(",%zu,%zu,%.6g,%.6g,%.6g,%.6g,%d,%.6g,%.6g,%s,%.6g,%.6g\n", m.vertices, m.region, m.weights.wall,
                  m.weights.processor, m.setup.wall, m.setup.processor, m.summary.iterations, m.iterate.wall, m.iterate.processor,
                  m.megabytes ? format("%.1f", *m.megabytes).c_str() : "", m.flat_before, m.flat_after);
}

/// Plain and accelerated runs at one resolution, compared with a long run.
std::string convergence_tables(const Mesh& mesh, const std::vector<Index>& region, const Mesh& cage, int iterations,
                               const Path& folder, std::string& csv) {
    std::string text;
    for (const char* kind : {"closeness", "laplacian"})
        for (const Mesh* around : {static_cast<const Mesh*>(nullptr), &cage}) {
            const std::string name = std::string(kind) + (around == nullptr ? ", mesh" : ", cage");
            const auto solve = [&](int count, int window) {
                return Problem(mesh, region, kind, around).run(solving(count, window)).summary;
            };
            const double known = solve(7 * iterations, 10).objective.back();
            std::vector<SolveRun> runs;
            for (const int window : {0, 2, 5, 10})
                runs.push_back({window == 0 ? "plain" : format("accelerated, window %d", window), solve(iterations, window)});
            const double best = best_objective(runs, known);
            text += "\n" + name + "\n\n" + convergence_header();
            for (const SolveRun& run : runs) {
                text += convergence_row(convergence(run, best));
                csv += convergence_csv(name, convergence(run, best));
            }
            write_plot(folder / (std::string("convergence-") + kind + (around == nullptr ? "-mesh" : "-cage") + ".svg"),
                       convergence_plot(format("%s, %u vertices", name.c_str(), mesh.number_of_vertices()), runs, best));
        }
    return text;
}

}  // namespace

void table_4_1(const Table41Options& options) {
    if (options.direction.size() != 3) fail_usage("the direction needs three numbers", "e.g. --direction 0,-1,0");
    std::filesystem::create_directories(options.output);
    const Path folder(options.output);
    const Subject subject(options);
    Mesh cage;
    std::string convergence_text,
        convergence_rows = convergence_csv_header(),
        rows =
            "problem,space,vertices,region,weights_s,weights_processor_s,setup_s,setup_processor_s,iterations,"
            "iterations_s,iterations_processor_s,peak_MB,flatness_before,flatness_after\n";
    std::map<std::string, std::string> tables;
    std::map<std::string, PlotSeries> lines;
    for (const std::uint64_t size : options.sizes) {
        const Mesh mesh = subject.at(size);
        const std::vector<Index> region = region_of(mesh, solver_points(mesh), options.direction, options.share);
        if (cage.is_empty()) {
            cage = make_cage(mesh, {.vertices = options.cage_vertices}).cage;
            if (options.convergence > 0)
                convergence_text = "\nConvergence at the first resolution\n" +
                                   convergence_tables(mesh, region, cage, options.convergence, folder, convergence_rows);
        }
        for (const std::string kind : {"closeness", "laplacian"}) {
            std::vector<Measured> both;
            for (const Mesh* around : {static_cast<const Mesh*>(nullptr), static_cast<const Mesh*>(&cage)}) {
                const PeakMemory peak;
                Problem problem(mesh, region, kind, around);
                both.push_back(problem.run(solving(options.iterations, 0)));
                both.back().megabytes = peak.megabytes();
                const char* space = around == nullptr ? "mesh" : "cage";
                rows += csv_row(kind, space, both.back());
                PlotSeries& line = lines[kind + ", " + space];
                line.name = "here: " + kind + ", " + space;
                line.points.push_back({static_cast<double>(mesh.number_of_vertices()), both.back().all().processor});
            }
            tables[kind] += row(both[0], both[1], kind == "closeness");
            std::cerr << kind << ' ' << row(both[0], both[1], false);
        }
    }
    Plot plot{"A region made plane, " + subject.name() + ": set-up and iterations, processor time",
              {"vertices", true, {}, {}},
              {"processor seconds", true, {}, {}},
              {}};
    for (auto& [name, line] : lines) plot.series.push_back(std::move(line));
    PlotSeries thesis_mesh{"thesis: ShapeOp", {}, true, true}, thesis_cage{"thesis: cage", {}, true, true},
        prototype{"prototype, set-up too: mesh", {}, true, true};
    for (const auto& [size, o] : published) {
        thesis_mesh.points.push_back({static_cast<double>(size), o.thesis_mesh});
        thesis_cage.points.push_back({static_cast<double>(size), o.thesis_cage});
        if (o.prototype_mesh)
            prototype.points.push_back({static_cast<double>(size), o.prototype_mesh->first + o.prototype_mesh->second});
    }
    for (PlotSeries* line : {&thesis_mesh, &thesis_cage, &prototype}) plot.series.push_back(std::move(*line));
    write_plot(folder / "seconds.svg", plot);

    const std::string head = format(
        "\n| vertices (region) | mesh: set-up / %d iterations (done), s | processor s | MB | cage of %u: weights + set-up / "
        "iterations (done), s | processor s | MB | not flat, %% of rest: mesh, cage |",
        options.iterations, cage.number_of_vertices());
    const std::string text = "Table 4.1, " + subject.name() + ": a plane on " + format("%.3g", 100 * options.share) +
                             " % of the surface.\n\nCloseness on every vertex\n" + head +
                             " thesis: ShapeOp, cage, s | prototype: mesh set-up / 50, cage set-up / 50, s "
                             "|\n|---|---|---|---|---|---|---|---|---|---|\n" +
                             tables["closeness"] + "\nLaplacian displacement on every vertex\n" + head +
                             "\n|---|---|---|---|---|---|---|---|\n" + tables["laplacian"] + convergence_text;
    write_file(folder / "table.md", text);
    write_file(folder / "table.csv", rows);
    if (options.convergence > 0) write_file(folder / "convergence.csv", convergence_rows);
    std::cout << text;
}

}  // namespace ostraka::experiments
