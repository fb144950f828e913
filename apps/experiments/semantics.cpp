#include "semantics.h"

#include "convergence.h"

#include "ostraka/annotation/colouring.h"
#include "ostraka/core/error.h"
#include "ostraka/core/npy.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/select/recipe.h"
#include "ostraka/synthetic/make_mesh.h"

#include <Eigen/SVD>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <set>

namespace ostraka::experiments {

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// An edit that moves the differing vertices to their target positions.
Edit moved_to(const std::vector<Point>& from, const std::vector<Point>& to) {
    EditStep::MeshVertices vertices;
    EditStep::MoveTo move;
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (from[i] == to[i]) continue;
        vertices.indices.push_back(static_cast<Index>(i));
        move.places.push_back(eigen(to[i]));
    }
    if (vertices.indices.empty()) return {};
    EditStep step;
    step.select = std::move(vertices);
    step.operation = std::move(move);
    return {{std::move(step)}};
}

}  // namespace

int Subject::id(const std::string& tag) const {
    for (const Annotation& annotation : set.annotations)
        if (annotation.tag == tag) return annotation.id;
    fail_input(tag, "no annotation has this tag", "see the recipe that the experiment names");
}

Subject synthetic_subject(const Path& data, const std::string& object, std::uint64_t vertices,
                          const std::function<Point(const Point&)>& warp) {
    SyntheticMesh made = make_mesh(synthetic_object(object), {.vertices = vertices});
    if (warp)
        for (const Vertex v : made.mesh.vertices()) made.mesh.point(v) = warp(made.mesh.point(v));
    AnnotationSet set = apply_recipe(data / (object + ".recipe.json"), made.mesh, made.face_labels);
    return {std::move(made.mesh), std::move(set)};
}

Relationship constraint(int id, const std::string& type, std::vector<int> members, const std::string& parameters, double weight) {
    Relationship r;
    r.id = id;
    r.type = type;
    r.annotations = std::move(members);
    r.is_constraint = true;
    r.weight = weight;
    r.constraint = parameters;
    return r;
}

Outcome deformed_from(const Subject& subject, const std::vector<Point>& edited, const RelationGraph& graph, DeformOptions options,
                      const std::string& name, const std::string& file) {
    options.conflicts = 0;
    if (options.solve.tolerance < 1e-9) options.passes = 1;  // a fixed number of iterations is requested
    const Edit edit = moved_to(points_of(subject.mesh), edited);
    const auto start = std::chrono::steady_clock::now();
    DeformResult result = deform({subject.mesh, subject.set}, graph, edit, name, options);
    return {name, file, result.points, result.summary, result.rounds, seconds_since(start), std::move(result.constraints)};
}

Outcome solved_from(const Subject& subject, const std::vector<Point>& edited, Constraints constraints,
                    const SolveOptions& options, const std::string& name, const std::string& file) {
    const auto start = std::chrono::steady_clock::now();
    MeshSpaceSolver solver(std::move(constraints), columns(points_of(subject.mesh)));
    Points points = columns(edited);
    Outcome outcome;
    outcome.name = name;
    outcome.file = file;
    outcome.summary = solver.solve(points, options);
    outcome.seconds = seconds_since(start);
    for (Eigen::Index i = 0; i < points.cols(); ++i) outcome.points.push_back(point_of(points.col(i)));
    return outcome;
}

void add_closeness(Constraints& list, const Subject& subject, const std::vector<Point>& edited, double weight) {
    std::vector<int> ids;
    for (const Vertex v : subject.mesh.vertices()) ids.push_back(static_cast<int>(v.idx()));
    list.push_back(make_constraint(kinds::Closeness{columns(edited)}, ids, weight, columns(points_of(subject.mesh))));
}

void add_laplacians(Constraints& list, const Subject& subject, const std::vector<Index>& vertices, const ConstraintKind& kind,
                    double weight) {
    const Points rest = columns(points_of(subject.mesh));
    for (const Index v : vertices) {
        std::vector<int> ids{static_cast<int>(v)};
        for (const Vertex w : subject.mesh.vertices_around_target(subject.mesh.halfedge(Vertex(v))))
            ids.push_back(static_cast<int>(w.idx()));
        list.push_back(make_constraint(kind, ids, weight, rest));
    }
}

Points columns(const std::vector<Point>& list) {
    Points points(3, static_cast<Eigen::Index>(list.size()));
    for (std::size_t i = 0; i < list.size(); ++i) points.col(static_cast<Eigen::Index>(i)) = eigen(list[i]);
    return points;
}

Eigen::Vector3d mean_of(const std::vector<Point>& points, const std::vector<Index>& vertices) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Index v : vertices) mean += eigen(points[v]) / static_cast<double>(vertices.size());
    return mean;
}

std::vector<Index> joint_of(const Mesh& mesh, const Annotation& part, const Annotation* other) {
    const std::vector<bool> inside = face_flags(mesh, part.faces);
    const std::vector<bool> wanted = other != nullptr ? face_flags(mesh, other->faces) : std::vector<bool>(inside.size(), true);
    std::set<Index> list;
    for (const Index f : part.faces)
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(f)))) {
            const Face beyond = mesh.face(mesh.opposite(h));
            if (beyond != Mesh::null_face() && !inside[beyond] && wanted[beyond])
                list.insert({mesh.target(h).idx(), mesh.source(h).idx()});
        }
    return {list.begin(), list.end()};
}

double rigid_distance(const Subject& subject, const std::vector<Index>& vertices, const std::vector<Point>& points) {
    const auto rigid = make_constraint(kinds::Rigid{}, {vertices.begin(), vertices.end()}, 1, columns(points_of(subject.mesh)));
    return std::sqrt(rigid->squared_distance(columns(points)) / static_cast<double>(vertices.size()));
}

std::vector<std::array<double, 2>> stretches(const Mesh& mesh, const std::vector<Point>& from, const std::vector<Point>& to) {
    std::vector<std::array<double, 2>> values;
    for (const Face f : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, f);
        const auto frame = [a = a, b = b, c = c](const std::vector<Point>& p) {
            const Eigen::Vector3d u = eigen(p[b] - p[a]), v = eigen(p[c] - p[a]), x = u.normalized();
            Eigen::Matrix2d m;
            m << u.norm(), x.dot(v), 0, (v - x * x.dot(v)).norm();
            return m;
        };
        const Eigen::Matrix2d map = frame(to) * frame(from).inverse();
        const Eigen::Vector2d s = Eigen::JacobiSVD<Eigen::Matrix2d>(map).singularValues();
        values.push_back({s[0], s[1]});
    }
    return values;
}

std::vector<double> distortions(const Mesh& mesh, const std::vector<Point>& from, const std::vector<Point>& to) {
    std::vector<double> values;
    for (const auto& [s1, s2] : stretches(mesh, from, to)) values.push_back(std::max(std::abs(s1 - 1), std::abs(s2 - 1)));
    return values;
}

double mean_over(const Mesh& mesh, const std::vector<Index>& faces, const std::vector<double>& values) {
    double sum = 0, area = 0;
    for (const Index f : faces) {
        const double weight = face_area(mesh, Face(f));
        sum += weight * values[f];
        area += weight;
    }
    return sum / area;
}

std::string iterations_of(const Outcome& outcome) {
    if (outcome.rounds > 0) return std::to_string(outcome.rounds) + " rounds";
    return outcome.summary.iterations > 0 ? std::to_string(outcome.summary.iterations) : "";
}

std::array<double, 2> moved(const std::vector<Index>& vertices, const std::vector<Point>& from, const std::vector<Point>& to) {
    double mean = 0, maximum = 0;
    for (const Index v : vertices) {
        const double distance = std::sqrt(CGAL::squared_distance(from[v], to[v]));
        mean += distance / static_cast<double>(vertices.size());
        maximum = std::max(maximum, distance);
    }
    return {mean, maximum};
}
std::string both(const std::array<double, 2>& mean_and_max, int after_point) {
    return digits(mean_and_max[0], after_point) + " (" + digits(mean_and_max[1], after_point) + ")";
}

std::string digits(double value, int after_point) {
    char text[48];
    std::snprintf(text, sizeof text, "%.*f", after_point, value);
    return text;
}

void write_outcome(const Path& folder, const Subject& subject, const Outcome& outcome, const std::vector<double>& face_values) {
    Mesh mesh = subject.mesh;
    for (const Vertex v : mesh.vertices()) mesh.point(v) = outcome.points[v];
    write_mesh(folder / (outcome.file + ".ply"), mesh, colour_by_annotation(mesh, subject.set), {.comment = outcome.name});
    if (!face_values.empty()) write_npy(folder / (outcome.file + ".npy"), std::span(face_values), {face_values.size()});
}

void compare_convergence(const Path& folder, const std::vector<Problem>& problems, int iterations) {
    if (iterations == 0) return;
    std::string markdown, csv = convergence_csv_header();
    for (const Problem& problem : problems) {
        const auto with_window = [&](int window, int count) { return problem.solve({count, 1e-10, 0, window}); };
        std::vector<SolveRun> runs;
        runs.push_back({"plain", with_window(0, iterations)});
        for (const int window : {2, 5})
            runs.push_back({"accelerated, window " + std::to_string(window), with_window(window, iterations)});
        const double best = best_objective(runs, with_window(5, 4 * iterations).objective.back());
        markdown += problem.title + ":\n\n" + convergence_header();
        for (const SolveRun& run : runs) {
            const Convergence row = convergence(run, best);
            markdown += convergence_row(row);
            csv += convergence_csv(problem.name, row);
        }
        markdown += '\n';
        write_plot(folder / ("convergence-" + problem.name + ".svg"), convergence_plot(problem.title, runs, best));
    }
    write_file(folder / "convergence.md", markdown);
    write_file(folder / "convergence.csv", csv);
    std::cout << '\n' << markdown;
}

}  // namespace ostraka::experiments
