// Shared by the experiments on semantic constraints: objects, methods of solution, measures and files of results.
#pragma once

#include "convergence.h"
#include "harness.h"
#include "scenes.h"

#include "ostraka/figures/table.h"
#include "ostraka/semantic/deform.h"
#include "ostraka/solver/make_constraint.h"

#include <functional>

namespace ostraka::experiments {

struct SemanticOptions {
    std::string output, data;
    std::uint64_t vertices = 0;
    int convergence = 0;
    void list_options(OptionList& list) {
        list("output", output, "folder for tables, plots and meshes").positional().required();
        list("vertices", vertices, "number of vertices of synthetic objects; 0: as in the thesis");
        list("convergence", convergence, "number of iterations, plain and accelerated, that are compared; 0: none",
             Range{0, 100000});
        list("data", data, "folder of the project's recipes, such as teapot.recipe.json");
    }
};

/// An object with its annotations.
struct Subject {
    Mesh mesh;
    AnnotationSet set;
    [[nodiscard]] const Annotation& part(const std::string& tag) const { return tagged(set, tag); }
    [[nodiscard]] int id(const std::string& tag) const { return part(tag).id; }
    [[nodiscard]] std::vector<Index> vertices(const std::string& tag) const { return vertices_of(mesh, part(tag)); }
};

/// A synthetic object; with `warp`, its points are transformed before it is annotated.
Subject synthetic_subject(const Path& data, const std::string& object, std::uint64_t vertices,
                          const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& warp = {});

/// One result of an experiment.
struct Outcome {
    std::string name;  ///< row of the table
    std::string file;  ///< name of the mesh file, without folder and extension
    std::vector<Point> points;
    SolveSummary summary;
    int rounds = 0;
    double seconds = 0;
    [[nodiscard]] bool solved() const { return summary.iterations > 0; }
    /// The text for a solved outcome, nothing for a given shape.
    [[nodiscard]] std::string if_solved(const std::string& text) const { return solved() ? text : ""; }
};

Relationship constraint(int id, const std::string& type, std::vector<int> members, const std::string& parameters, double weight);

using Constraints = std::vector<std::unique_ptr<Constraint>>;

/// Trials of one edit of an object: given shapes, the thesis's method and this library's.
class Trials {
public:
    Trials(const Subject& subject, std::vector<Point> edited) : subject_(subject), edited_(std::move(edited)) {}

    void given(const std::string& name, const std::string& file, const std::vector<Point>& points) {
        outcomes.push_back({name, file, points, {}});
    }
    /// Solves constraints directly, like the thesis's prototype, starting from the edited shape.
    void thesis(const std::string& name, const std::string& file, Constraints constraints, const SolveOptions& options);
    /// Runs `deform` without a cage from the edited shape; all displaced vertices are handles.
    void deformed(const std::string& name, const std::string& file, const RelationGraph& graph, DeformOptions options);

    /// Writes each shape as a PLY with the annotations' colours, and NAME.npy with `value_per_face` of all but the first (NaN:
    /// none). Adds a row of name, iterations, seconds and cells(outcome) for each outcome that has cells.
    void write(const Path& folder, TextTable& table, const std::function<std::vector<std::string>(const Outcome&)>& cells,
               const std::function<std::vector<double>(const Outcome&)>& value_per_face) const;

    std::vector<Outcome> outcomes;

private:
    const Subject& subject_;
    std::vector<Point> edited_;
};

/// A table for trials: the columns after name, iterations and seconds.
TextTable trial_table(std::vector<std::string> columns);
/// Prints the table and writes it to FOLDER/NAME.
void write_table(const TextTable& table, const Path& folder, const std::string& name);

SolveSummary solve_thesis(const Subject& subject, const std::vector<Point>& edited, Constraints constraints,
                          const SolveOptions& options, std::vector<Point>* points = nullptr);
DeformResult solve_deformed(const Subject& subject, const std::vector<Point>& edited, const RelationGraph& graph,
                            DeformOptions options, const std::string& name = {});
/// Problems to compare plain and accelerated iterations by.
Problem thesis_problem(const std::string& name, const std::string& title, const Subject& subject, std::vector<Point> edited,
                       std::function<Constraints()> constraints);
Problem deform_problem(const std::string& name, const std::string& title, const Subject& subject, std::vector<Point> edited,
                       RelationGraph graph, DeformOptions options);

/// Weight of closeness in the thesis's method, which does not state what fixes the other vertices.
inline constexpr double closeness_weight = 0.01;
/// Closeness of every vertex to its position in `edited`.
void add_closeness(Constraints& list, const Subject& subject, const std::vector<Point>& edited, double weight);
/// A Laplacian constraint on each of these vertices and its neighbours.
void add_laplacians(Constraints& list, const Subject& subject, const std::vector<Index>& vertices, double weight);

Eigen::Vector3d centre_of(const std::vector<Point>& points, const std::vector<Index>& vertices);
/// Vertices that a region shares with other faces; with `other`, only with faces of that annotation.
std::vector<Index> joint_of(const Mesh& mesh, const Annotation& part, const Annotation* other = nullptr);
/// Root mean square distance of vertices from the best rigid copy of their original positions.
double rigid_distance(const Subject& subject, const std::vector<Index>& vertices, const std::vector<Point>& points);
/// max(|s1 - 1|, |s2 - 1|) per face of the singular values of the map from one shape to another.
std::vector<double> distortions(const Mesh& mesh, const std::vector<Point>& from, const std::vector<Point>& to);
/// Area-weighted mean over some faces of a value per face.
double mean_over(const Mesh& mesh, const std::vector<Index>& faces, const std::vector<double>& values);
/// "mean (max)" of the displacements of vertices between two shapes.
std::string moved_text(const std::vector<Index>& vertices, const std::vector<Point>& from, const std::vector<Point>& to,
                       int after_point);

}  // namespace ostraka::experiments
