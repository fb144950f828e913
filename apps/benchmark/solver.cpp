// The local/global solver: set-up and iterations, over mesh vertices and through a cage.
#include "benchmarks.h"

#include "ostraka/cage/cage.h"
#include "ostraka/coords/coordinates.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/solver/make_constraint.h"
#include "ostraka/solver/solve.h"
#include "ostraka/stats/random.h"
#include "ostraka/synthetic/make_mesh.h"

#include <malloc.h>

#include <chrono>
#include <fstream>
#include <numeric>
#include <set>

namespace ostraka::bench {

namespace {

constexpr int iterations = 50;
constexpr Eigen::Index cage_size = 200;

Points points_of_mesh(const Mesh& mesh) {
    Points points(3, static_cast<Eigen::Index>(mesh.number_of_vertices()));
    for (const Vertex v : mesh.vertices()) points.col(static_cast<Eigen::Index>(v.idx())) = eigen(mesh.point(v));
    return points;
}

/// The `count` points nearest to the point with the greatest x.
std::vector<int> patch(const Points& points, std::size_t count) {
    Eigen::Index seed = 0;
    points.row(0).maxCoeff(&seed);
    std::vector<int> ids(static_cast<std::size_t>(points.cols()));
    std::iota(ids.begin(), ids.end(), 0);
    const auto distance = [&](int i) { return (points.col(i) - points.col(seed)).squaredNorm(); };
    std::nth_element(ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(count), ids.end(),
                     [&](int a, int b) { return distance(a) < distance(b); });
    ids.resize(count);
    return ids;
}

using ConstraintList = std::vector<std::unique_ptr<Constraint>>;

void add_plane(ConstraintList& constraints, const Points& rest) {
    constraints.push_back(make_constraint(kinds::Plane{}, patch(rest, static_cast<std::size_t>(rest.cols() / 40)), 1, rest));
}

void add_laplacians(ConstraintList& constraints, const Mesh& mesh, const Points& rest, double weight) {
    for (const Vertex v : mesh.vertices()) {
        std::vector<int> ids{static_cast<int>(v.idx())};
        for (const Vertex w : CGAL::vertices_around_target(mesh.halfedge(v), mesh)) ids.push_back(static_cast<int>(w.idx()));
        constraints.push_back(make_constraint(kinds::LaplacianDisplacement{}, std::move(ids), weight, rest));
    }
}

SolveOptions plain(int count) {
    SolveOptions options;
    options.iterations = count;
    options.tolerance = 0;
    options.window = 0;
    return options;
}

/// Resident memory of this process in bytes: current ("VmRSS") or peak since forget_peak() ("VmHWM"); 0 if unknown.
double resident(const std::string& which) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind(which + ":", 0) == 0) return 1024 * std::stod(line.substr(which.size() + 1));
    return 0;
}

/// Resets the peak; returns free memory to the system first, so that later growth is visible.
void forget_peak() {
    ::malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << 5;
}

void report(benchmark::State& state, const SolveSummary& summary) {
    if (!summary.usable) state.SkipWithError("not solved");
    state.counters["iterations"] = summary.iterations;  // fewer if the result no longer changes, to the bit
    state.counters["factor_MB"] = summary.factor_entries * sizeof(double) / 1e6;
    state.counters["symbolic_s"] = summary.times.symbolic;
    state.counters["factor_s"] = summary.times.factor;
    state.counters["project_s"] = summary.times.project;
    state.counters["solve_s"] = summary.times.solve;
}

/// Laplacian displacement on every vertex and a plane on 2.5 % of them: set-up and 50 plain iterations.
void laplacian_and_plane(benchmark::State& state, std::size_t vertices) {
    const Mesh& mesh = target(vertices);
    const Points rest = points_of_mesh(mesh);
    SolveSummary summary;
    double before = 0, constraints = 0, peak = 0;
    for ([[maybe_unused]] const auto lap : state) {
        forget_peak();
        before = resident("VmRSS");
        ConstraintList constraint_list;
        add_laplacians(constraint_list, mesh, rest, 1);
        add_plane(constraint_list, rest);
        constraints = resident("VmRSS");
        MeshSpaceSolver solver(std::move(constraint_list), rest);
        Points x = rest;
        summary = solver.solve(x, plain(iterations));
        peak = resident("VmHWM");
    }
    report(state, summary);
    state.counters["constraints_MB"] = (constraints - before) / 1e6;
    state.counters["peak_MB"] = (peak - before) / 1e6;  // growth, including constraints and factor
}

/// Closeness of every vertex to its rest position, and the plane: a diagonal matrix plus a matrix of rank one.
void closeness_and_plane(benchmark::State& state, std::size_t vertices) {
    const Points rest = points_of_mesh(target(vertices));
    SolveSummary summary;
    for ([[maybe_unused]] const auto lap : state) {
        ConstraintList constraints;
        for (int i = 0; i < rest.cols(); ++i) constraints.push_back(make_constraint(kinds::Closeness{}, {i}, 1, rest));
        add_plane(constraints, rest);
        MeshSpaceSolver solver(std::move(constraints), rest);
        Points x = rest;
        summary = solver.solve(x, plain(iterations));
    }
    report(state, summary);
}

/// The vertices of each flower of the synthetic teapot.
std::vector<std::vector<int>> flowers_of(const SyntheticMesh& teapot) {
    std::vector<std::vector<int>> flowers;
    const auto& parts = synthetic_object("teapot").parts;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        if (parts[part].find("flower") == std::string::npos) continue;
        std::set<int> members;
        for (const Face f : teapot.mesh.faces())
            if (teapot.face_labels[f.idx()] == static_cast<int>(part))
                for (const Vertex v : CGAL::vertices_around_face(teapot.mesh.halfedge(f), teapot.mesh))
                    members.insert(static_cast<int>(v.idx()));
        if (members.size() >= 10) flowers.emplace_back(members.begin(), members.end());
    }
    return flowers;
}

/// The stretched teapot with rigid flowers whose centres are on one level (the thesis, figure 5.3): iterations until phi - best
/// has fallen to a thousandth of its value at the start, and of its value after the first step.
void same_level(benchmark::State& state, int window) {
    MakeOptions make_options;
    make_options.vertices = 20'000;
    const SyntheticMesh teapot = make_mesh(synthetic_object("teapot"), make_options);
    const Mesh& mesh = teapot.mesh;
    const Points rest = points_of_mesh(mesh);
    Points stretched = rest;
    stretched.row(2) *= 1.4;
    const auto build = [&] {
        ConstraintList constraints;
        add_laplacians(constraints, mesh, stretched, 2);
        std::vector<int> centres;
        for (const std::vector<int>& ids : flowers_of(teapot)) {
            Eigen::Vector3d mean = Eigen::Vector3d::Zero();
            for (const int i : ids) mean += rest.col(i) / static_cast<double>(ids.size());
            const auto squared_distance = [&](int i) { return (rest.col(i) - mean).squaredNorm(); };
            centres.push_back(*std::min_element(ids.begin(), ids.end(),
                                                [&](int a, int b) { return squared_distance(a) < squared_distance(b); }));
            constraints.push_back(make_constraint(kinds::Rigid{}, ids, 4, rest));
        }
        constraints.push_back(make_constraint(kinds::Orientation{{0.1, 0, 1}}, centres, 4, rest));
        return constraints;
    };
    SolveOptions options;
    options.tolerance = 0;
    options.iterations = 1000;
    options.window = 10;
    Points best = stretched;
    const double minimum = MeshSpaceSolver(build(), stretched).solve(best, options).objective.back();
    options.window = window;
    options.iterations = 300;
    SolveSummary summary;
    for ([[maybe_unused]] const auto lap : state) {
        MeshSpaceSolver solver(build(), stretched);
        Points x = stretched;
        summary = solver.solve(x, options);
    }
    const double start = summary.objective.front(), first = summary.objective[1];
    const auto until = [&](double from) {
        std::size_t count = 0;
        while (count + 1 < summary.objective.size() && summary.objective[count] - minimum > 1e-3 * (from - minimum)) ++count;
        return count;
    };
    state.counters["from_start"] = static_cast<double>(until(start));
    state.counters["from_first_step"] = static_cast<double>(until(first));
    state.counters["seconds"] = summary.seconds[until(first)];
    state.counters["refused"] = summary.refused;
    state.counters["objective"] = summary.objective.back() / start;
    state.counters["best"] = minimum / start;
}

/// Smooth, synthetic, well-conditioned cage weights; the time does not depend on their values.
CageWeights some_weights(const Points& rest, Points& cage) {
    Random random(3);
    const Eigen::Vector3d low = rest.rowwise().minCoeff(), size = rest.rowwise().maxCoeff() - low;
    cage.resize(3, cage_size);
    for (Eigen::Index j = 0; j < cage_size; ++j)
        for (int k = 0; k < 3; ++k) cage(k, j) = low[k] + size[k] * random.uniform(-0.2, 1.2);
    CageWeights weights(rest.cols(), cage_size);
    for (Eigen::Index i = 0; i < rest.cols(); ++i) {
        weights.row(i) =
            (1e-3 * size.squaredNorm() + (cage.colwise() - rest.col(i)).colwise().squaredNorm().array()).square().inverse();
        weights.row(i) /= weights.row(i).sum();
    }
    return weights;
}

enum class Kind { edges, planes, rigid_groups };

/// One iteration through a cage of 200 vertices, with half of 100,000 vertices constrained.
void through_cage(benchmark::State& state, Kind kind) {
    const Points rest = points_of_mesh(target(100'000));
    Points cage;
    const CageWeights weights = some_weights(rest, cage);
    ConstraintList constraints;
    const int half = static_cast<int>(rest.cols() / 2);
    if (kind == Kind::edges) {
        for (int i = 0; i < half; ++i) constraints.push_back(make_constraint(kinds::EdgeStrain{{0.9, 0.9}}, {i, i + 1}, 1, rest));
    } else {
        for (int group = 0; group < 5; ++group) {
            std::vector<int> ids;
            for (int i = group * (half / 5); i < (group + 1) * (half / 5); ++i) ids.push_back(i);
            constraints.push_back(
                make_constraint(kind == Kind::planes ? ConstraintKind(kinds::Plane{}) : kinds::Rigid{}, ids, 1, rest));
        }
    }
    constraints.push_back(make_constraint(kinds::Closeness{}, {static_cast<int>(rest.cols()) - 1}, 1, rest));
    const std::size_t rows = kind == Kind::edges ? static_cast<std::size_t>(half) : 0;
    CageSpaceSolver solver(std::move(constraints), weights, cage);
    solver.initialize();
    Points c = 1.1 * cage;
    const SolveSummary first = solver.solve(c, plain(1));
    double count = 0, time = 0;
    for ([[maybe_unused]] const auto lap : state) {
        c = 1.1 * cage;
        const SolveSummary summary = solver.solve(c, plain(iterations));
        count += summary.iterations;
        time += summary.seconds.back() - summary.seconds.front();
    }
    state.counters["iteration_ms"] = 1e3 * time / count;
    state.counters["iterations"] = count / static_cast<double>(state.iterations());
    state.counters["factor_s"] = first.times.factor;
    // The rows of M are read once per iteration.
    state.SetBytesProcessed(static_cast<std::int64_t>(count * static_cast<double>(rows * cage_size * sizeof(double))));
}

/// An interactive edit: a teapot of 60,000 vertices in a cage of 200, its flowers rigid and on one level. All handles get new
/// targets, followed by 20 iterations and the update of all mesh vertices. Cage, weights and factorisation do not change
/// between edits and are computed before.
void interactive_edit(benchmark::State& state) {
    MakeOptions make_options;
    make_options.vertices = 60'000;
    const SyntheticMesh teapot = make_mesh(synthetic_object("teapot"), make_options);
    const Mesh cage_mesh = make_cage(teapot.mesh).cage;
    const Points mesh_points = points_of_mesh(teapot.mesh), cage = points_of_mesh(cage_mesh);
    // Additional rows for the handles, below those of the mesh, so that the handles have targets.
    const Eigen::Index n = mesh_points.cols(), handles = cage.cols();
    CageWeights weights(n + handles, handles);
    weights.topRows(n) = compute_coordinates("mean-value", cage_mesh, teapot.mesh).vertex;
    weights.bottomRows(handles).setIdentity();
    Points rest(3, n + handles);
    rest << mesh_points, cage;
    std::vector<int> ids(static_cast<std::size_t>(handles));
    std::iota(ids.begin(), ids.end(), static_cast<int>(n));
    ConstraintList constraints;
    constraints.push_back(make_constraint(kinds::Closeness{}, ids, 1, rest));
    std::vector<int> members;
    kinds::MeansOnLevel level{Eigen::Vector3d::UnitZ()};
    int count = 0;
    for (const std::vector<int>& flower : flowers_of(teapot)) {
        constraints.push_back(make_constraint(kinds::Rigid{}, flower, 50, rest));
        members.insert(members.end(), flower.begin(), flower.end());
        level.groups.insert(level.groups.end(), flower.size(), count++);
    }
    constraints.push_back(make_constraint(level, members, 50, rest));
    CageSpaceSolver solver(std::move(constraints), weights, cage);
    solver.initialize();
    SolveOptions options;
    options.iterations = 20;
    options.tolerance = 0;
    double targets = 0, update = 0, laps = 0, total_iterations = 0;
    SolveTimes times;
    for ([[maybe_unused]] const auto lap : state) {
        const auto now = std::chrono::steady_clock::now;
        const auto begin = now();
        Points edited = cage;  // stretched a little more in each lap
        edited.row(2) *= 1.4 + 0.01 * laps;
        solver.set_target(0, edited);
        const auto set = now();
        const SolveSummary summary = solver.solve(edited, options);
        const auto solved = now();
        benchmark::DoNotOptimize(points_of(weights, edited).data());
        update += std::chrono::duration<double>(now() - solved).count();
        targets += std::chrono::duration<double>(set - begin).count();
        times.project += summary.times.project;
        times.solve += summary.times.solve;
        times.accelerate += summary.times.accelerate;
        total_iterations += summary.iterations;
        laps += 1;
        if (!summary.usable) state.SkipWithError("not solved");
    }
    state.counters["iterations"] = total_iterations / laps;
    state.counters["targets_ms"] = 1e3 * targets / laps;  // including their part of the right-hand side
    state.counters["project_ms"] = 1e3 * times.project / laps;
    state.counters["solve_ms"] = 1e3 * times.solve / laps;
    state.counters["accelerate_ms"] = 1e3 * times.accelerate / laps;
    state.counters["mesh_ms"] = 1e3 * update / laps;
}

}  // namespace

void register_solver_benchmarks() {
    const auto add = [](const std::string& name, auto run) {
        with_both_times(benchmark::RegisterBenchmark(name.c_str(), [run](benchmark::State& state) { run(state); }));
    };
    for (const std::size_t vertices : {20'000, 50'000, 100'000, 200'000, 500'000}) {
        const std::string size = std::to_string(vertices);
        add("solver/laplacian_and_plane/" + size, [vertices](benchmark::State& state) { laplacian_and_plane(state, vertices); });
        add("solver/closeness_and_plane/" + size, [vertices](benchmark::State& state) { closeness_and_plane(state, vertices); });
    }
    for (const int window : {0, 2, 5, 10})
        add("solver/same_level/window:" + std::to_string(window),
            [window](benchmark::State& state) { same_level(state, window); });
    add("solver/cage/interactive_edit", interactive_edit);
    add("solver/cage/edges", [](benchmark::State& state) { through_cage(state, Kind::edges); });
    add("solver/cage/planes", [](benchmark::State& state) { through_cage(state, Kind::planes); });
    add("solver/cage/rigid_groups", [](benchmark::State& state) { through_cage(state, Kind::rigid_groups); });
}

}  // namespace ostraka::bench
