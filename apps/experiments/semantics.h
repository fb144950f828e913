// Shared by the experiments on semantic constraints: objects, solution methods, measures of results, tables and files.
#pragma once

#include "ostraka/report/plot.h"
#include "ostraka/report/table.h"
#include "ostraka/semantic/deform.h"
#include "ostraka/solver/make_constraint.h"
#include "ostraka/synthetic/synthetic_object.h"

#include <functional>
#include <string>
#include <vector>

namespace ostraka::experiments {

/// An object with its annotations.
struct Subject {
    Mesh mesh;
    AnnotationSet set;
    [[nodiscard]] double diagonal() const { return box_diagonal(mesh); }
    /// The id of the annotation with this tag. Throws Error (input) if there is none.
    [[nodiscard]] int id(const std::string& tag) const;
    [[nodiscard]] const Annotation& part(const std::string& tag) const { return *set.find(id(tag)); }
};

/// A synthetic object; with `warp`, its points are transformed before it is annotated.
Subject synthetic_subject(const Path& data, const std::string& object, std::uint64_t vertices,
                          const std::function<Point(const Point&)>& warp = {});

/// One result of an experiment.
struct Outcome {
    std::string name;  ///< row of the table
    std::string file;  ///< name of the mesh file, without folder and extension
    std::vector<Point> points;
    SolveSummary summary;
    int rounds = 0;
    double seconds = 0;
    std::vector<ConstraintReport> constraints;
};

Relationship constraint(int id, const std::string& type, std::vector<int> members, const std::string& parameters, double weight);

/// Runs `deform` without a cage from a shape given point by point; all displaced vertices are handles.
Outcome deformed_from(const Subject& subject, const std::vector<Point>& edited, const RelationGraph& graph, DeformOptions options,
                      const std::string& name, const std::string& file);

using Constraints = std::vector<std::unique_ptr<Constraint>>;
/// Solves constraints directly, like the thesis's prototype, starting from the edited shape.
Outcome solved_from(const Subject& subject, const std::vector<Point>& edited, Constraints constraints,
                    const SolveOptions& options, const std::string& name, const std::string& file);
/// Closeness of every vertex to its position in `edited`.
void add_closeness(Constraints& list, const Subject& subject, const std::vector<Point>& edited, double weight);
/// A Laplacian constraint of type `kind` on each of these vertices and its neighbours.
void add_laplacians(Constraints& list, const Subject& subject, const std::vector<Index>& vertices, const ConstraintKind& kind,
                    double weight);

Points columns(const std::vector<Point>& points);
Eigen::Vector3d mean_of(const std::vector<Point>& points, const std::vector<Index>& vertices);
/// Vertices that a region shares with other faces; with `other`, only with faces of that annotation.
std::vector<Index> joint_of(const Mesh& mesh, const Annotation& part, const Annotation* other = nullptr);
/// Root mean square distance of vertices from the best rigid copy of their original positions.
double rigid_distance(const Subject& subject, const std::vector<Index>& vertices, const std::vector<Point>& points);

/// Singular values of the map from each face of one shape to the same face of another, in descending order.
std::vector<std::array<double, 2>> stretches(const Mesh& mesh, const std::vector<Point>& from, const std::vector<Point>& to);
/// max(|s1 - 1|, |s2 - 1|) per face.
std::vector<double> distortions(const Mesh& mesh, const std::vector<Point>& from, const std::vector<Point>& to);

/// Area-weighted mean over some faces of a value per face.
double mean_over(const Mesh& mesh, const std::vector<Index>& faces, const std::vector<double>& values);

/// Number of iterations or rounds; empty if nothing was solved.
std::string iterations_of(const Outcome& outcome);
/// Mean and maximum displacement of vertices between two shapes.
std::array<double, 2> moved(const std::vector<Index>& vertices, const std::vector<Point>& from, const std::vector<Point>& to);
/// "mean (max)".
std::string both(const std::array<double, 2>& mean_and_max, int after_point);

std::string digits(double value, int after_point);

/// Writes the result as a PLY with the annotations' colours and, if given, one value per face as FILE.npy (NaN: none).
void write_outcome(const Path& folder, const Subject& subject, const Outcome& outcome,
                   const std::vector<double>& face_values = {});

/// A problem solved with plain and with accelerated iterations from the same start; the comparison writes a table and a plot to
/// FOLDER/convergence-NAME.
struct Problem {
    std::string name, title;
    std::function<SolveSummary(const SolveOptions&)> solve;
};
void compare_convergence(const Path& folder, const std::vector<Problem>& problems, int iterations);

}  // namespace ostraka::experiments
