#include "semantics.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/annotation/colouring.h"
#include "ostraka/files/npy.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/select/recipe.h"
#include "ostraka/synthetic/make_mesh.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace ostraka::experiments {

namespace {

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

Subject synthetic_subject(const Path& data, const std::string& object, std::uint64_t vertices,
                          const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& warp) {
    SyntheticMesh made = make_mesh(synthetic_object(object), {.vertices = vertices});
    if (warp) made.mesh = warped(std::move(made.mesh), warp);
    AnnotationSet set = apply_recipe(data / (object + ".recipe.json"), made.mesh, made.face_labels);
    return {{std::move(made.mesh), std::move(set)}};
}

Method thesis_method(const Subject& subject, std::vector<Point> edited, std::function<Constraints()> constraints) {
    return [&subject, edited = std::move(edited), constraints = std::move(constraints)](const SolveOptions& options) {
        Constraints list = constraints();
        Outcome outcome;
        const Stopwatch watch;
        MeshSpaceSolver solver(std::move(list), columns_of(subject.mesh));
        Points x = columns_of(edited);
        outcome.summary = solver.solve(x, options);
        outcome.points = mesh_points(x);
        outcome.seconds = watch.seconds().wall;
        return outcome;
    };
}

Method deform_method(const Subject& subject, std::vector<Point> edited, RelationGraph graph, DeformOptions options) {
    return [&subject, edited = std::move(edited), graph = std::make_shared<const RelationGraph>(std::move(graph)),
            options](const SolveOptions& solve) {
        DeformOptions deforming = options;
        deforming.solve = solve;
        deforming.conflicts = 0;
        if (solve.tolerance < 1e-9) deforming.passes = 1;  // a fixed number of iterations is requested
        const Stopwatch watch;
        DeformResult result = deform({subject}, *graph, moved_to(points_of(subject.mesh), edited), "experiment", deforming);
        return Outcome{"", "", std::move(result.points), std::move(result.summary), result.rounds, watch.seconds().wall};
    };
}

Problem problem_of(const std::string& name, const std::string& title, Method method) {
    return {name, title, [method = std::move(method)](int iterations, int window) {
                return method({iterations, 1e-10, 0, window}).summary;
            }};
}

void Trials::solved(const std::string& name, const std::string& file, const Method& method, const SolveOptions& options) {
    fmt::print(stderr, "  {}\n", name);
    outcomes.push_back(method(options));
    outcomes.back().name = name;
    outcomes.back().file = file;
}

TextTable trial_table(std::vector<std::string> columns) {
    columns.insert(columns.begin(), {"run", "iterations", "s"});
    return TextTable(columns);
}

void Trials::write(const Path& folder, TextTable& table, const std::function<std::vector<std::string>(const Outcome&)>& cells,
                   const std::function<std::vector<double>(const Outcome&)>& value_per_face) const {
    for (const Outcome& outcome : outcomes) {
        const Mesh mesh = with_points(subject.mesh, outcome.points);
        write_mesh(folder / (outcome.file + ".ply"), mesh, colour_by_annotation({mesh, subject.annotations}),
                   {.comment = outcome.name});
        if (&outcome != &outcomes.front()) {
            const std::vector<double> values = value_per_face(outcome);
            write_npy(folder / (outcome.file + ".npy"), std::span(values), {values.size()});
        }
        const std::vector<std::string> measured = cells(outcome);
        if (measured.empty()) continue;
        const int iterations = outcome.summary.iterations;
        std::vector<std::string> row{outcome.name,
                                     outcome.rounds > 0 ? fmt::format("{} rounds", outcome.rounds)
                                     : iterations > 0   ? std::to_string(iterations)
                                                        : "",
                                     outcome.if_solved(fixed(outcome.seconds, 2))};
        row.insert(row.end(), measured.begin(), measured.end());
        table.add(row);
    }
}

void add_closeness(Constraints& list, const Subject& subject, const std::vector<Point>& edited, double weight) {
    const std::vector<Index> all = all_vertices(subject.mesh);
    list.push_back(
        make_constraint(kinds::Closeness{columns_of(edited)}, {all.begin(), all.end()}, weight, columns_of(subject.mesh)));
}

void add_laplacians(Constraints& list, const Subject& subject, const std::vector<Index>& vertices, double weight) {
    const Points rest = columns_of(subject.mesh);
    for (const Index v : vertices) {
        std::vector<int> ids{static_cast<int>(v)};
        for (const Vertex w : subject.mesh.vertices_around_target(subject.mesh.halfedge(Vertex(v))))
            ids.push_back(static_cast<int>(w.idx()));
        list.push_back(make_constraint(kinds::Laplacian{}, ids, weight, rest));
    }
}

Eigen::Vector3d centre_of(const std::vector<Point>& points, const std::vector<Index>& vertices) {
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
    const auto rigid = make_constraint(kinds::Rigid{}, {vertices.begin(), vertices.end()}, 1, columns_of(subject.mesh));
    return std::sqrt(rigid->squared_distance(columns_of(points)) / static_cast<double>(vertices.size()));
}

std::vector<double> distortions(const Mesh& mesh, const std::vector<Point>& from, const std::vector<Point>& to) {
    std::vector<double> values;
    for (const Face f : mesh.faces()) {
        const auto [a, b, c] = corners(mesh, f);
        const auto frame = [a = a, b = b, c = c](const std::vector<Point>& p) {
            const Eigen::Vector3d u = eigen(p[b] - p[a]), v = eigen(p[c] - p[a]), x = u.normalized();
            Eigen::Matrix2d m;
            m << u.norm(), x.dot(v), 0, (v - x * x.dot(v)).norm();
            return m;
        };
        const Eigen::Vector2d s = singular_values(frame(to) * frame(from).inverse());
        values.push_back(std::max(std::abs(s[0] - 1), std::abs(s[1] - 1)));
    }
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

double smooth_step(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

std::string moved_text(const std::vector<Index>& vertices, const std::vector<Point>& from, const std::vector<Point>& to,
                       int after_point) {
    const auto [mean, max] = mean_and_max(displacements(from, to), vertices);
    return fixed(mean, after_point) + " (" + fixed(max, after_point) + ")";
}

}  // namespace ostraka::experiments
