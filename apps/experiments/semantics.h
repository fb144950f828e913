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
    void declare_options(OptionList& list) {
        list("output", output, "folder for tables, plots and meshes").positional().required();
        list("vertices", vertices, "number of vertices of synthetic objects; 0: as in the thesis");
        list("convergence", convergence, "number of iterations, plain and accelerated, that are compared; 0: none",
             Range{0, 100000});
        list("data", data, "folder of the project's recipes, such as teapot.recipe.json");
    }
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

using Constraints = std::vector<std::unique_ptr<Constraint>>;
/// Solves from an edited shape; the outcome has no names.
using Method = std::function<Outcome(const SolveOptions&)>;
/// Solves constraints directly, like the thesis's prototype.
Method thesis_method(const Subject& subject, std::vector<Point> edited, std::function<Constraints()> constraints);
/// Runs `deform` without a cage; all displaced vertices are handles.
Method deform_method(const Subject& subject, std::vector<Point> edited, RelationGraph graph, DeformOptions options = {});
/// A problem to compare plain and accelerated iterations by.
Problem problem_of(const std::string& name, const std::string& title, Method method);
inline const SolveOptions five{5, 0, 0, 0}, many{2000, 1e-7, 0, 5}, usual = DeformOptions().solve;

/// Trials of one edit of an object: given shapes, the thesis's method and this library's.
struct Trials {
    const Subject& subject;
    std::vector<Outcome> outcomes = {};

    void given(const std::string& name, const std::string& file, const std::vector<Point>& points) {
        outcomes.push_back({name, file, points, {}});
    }
    void solved(const std::string& name, const std::string& file, const Method& method, const SolveOptions& options = usual);
    /// Writes each shape as a PLY with the annotations' colours, and NAME.npy with `value_per_face` of all but the first (NaN:
    /// none). Adds a row of name, iterations, seconds and cells(outcome) for each outcome that has cells.
    void write(const Path& folder, TextTable& table, const std::function<std::vector<std::string>(const Outcome&)>& cells,
               const std::function<std::vector<double>(const Outcome&)>& value_per_face) const;
};

/// A table for trials: the columns after name, iterations and seconds.
TextTable trial_table(std::vector<std::string> columns);

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
/// 0 up to `from`, 1 beyond `to`.
double smooth_step(double from, double to, double x);
/// "mean (max)" of the displacements of vertices between two shapes.
std::string moved_text(const std::vector<Index>& vertices, const std::vector<Point>& from, const std::vector<Point>& to,
                       int after_point);

/// Figure 5.19: a finger in proportion to another.
void proportions_of_hand(const SemanticOptions& options, Subject& subject, std::vector<Problem>& problems);

}  // namespace ostraka::experiments
