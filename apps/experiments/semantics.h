// What the experiments on semantic constraints share: objects, ways to solve, measures of the results, tables and files.
#pragma once

#include "ostraka/report/plot.h"
#include "ostraka/report/table.h"
#include "ostraka/semantic/deform.h"
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

/// A synthetic object, its points moved before it is annotated if `warp` is given.
Subject synthetic_subject(const Path& data, const std::string& object, std::uint64_t vertices,
                          const std::function<Point(const Point&)>& warp = {});

/// One result of an experiment.
struct Outcome {
    std::string name;  ///< a row of the table
    std::string file;  ///< of the mesh, without folder and extension
    std::vector<Point> points;
    SolveSummary summary;
    int rounds = 0;
    double seconds = 0;
    std::vector<ConstraintReport> constraints;
};

Relationship constraint(int id, const std::string& type, std::vector<int> members, const std::string& parameters, double weight);

/// `deform` without a cage from a shape given point by point: what it moves are the handles.
Outcome deformed_from(const Subject& subject, const std::vector<Point>& edited, const RelationGraph& graph, DeformOptions options,
                      const std::string& name, const std::string& file);

using Constraints = std::vector<std::unique_ptr<Constraint>>;
/// Constraints as the thesis's prototype hands them to its solver, from the edited shape on.
Outcome solved_from(const Subject& subject, const std::vector<Point>& edited, Constraints constraints,
                    const SolveOptions& options, const std::string& name, const std::string& file);
/// Every vertex at its place in `edited`.
void add_closeness(Constraints& list, const Subject& subject, const std::vector<Point>& edited, double weight);
/// `kind` (of Laplacian) on each of these vertices and its neighbours.
void add_laplacians(Constraints& list, const Subject& subject, const std::vector<Index>& vertices, const std::string& kind,
                    double weight);

Points columns(const std::vector<Point>& points);
Eigen::Vector3d mean_of(const std::vector<Point>& points, const std::vector<Index>& vertices);
/// Vertices of a region that other faces use as well, where it joins the rest; only where it joins `other` if that is given.
std::vector<Index> joint_of(const Mesh& mesh, const Annotation& part, const Annotation* other = nullptr);
/// Root mean square distance of vertices from the best rigid copy of what they were.
double rigid_distance(const Subject& subject, const std::vector<Index>& vertices, const std::vector<Point>& points);

/// Singular values of the map from each face of one shape to the same face of another, the greater first.
std::vector<std::array<double, 2>> stretches(const Mesh& mesh, const std::vector<Point>& from, const std::vector<Point>& to);
/// max(|s1 - 1|, |s2 - 1|) of each face.
std::vector<double> distortions(const Mesh& mesh, const std::vector<Point>& from, const std::vector<Point>& to);

/// Of one value a face over some faces, by area.
double mean_over(const Mesh& mesh, const std::vector<Index>& faces, const std::vector<double>& values);

/// Iterations or rounds, nothing where nothing was solved.
std::string iterations_of(const Outcome& outcome);
/// Mean and greatest distance of vertices between two shapes.
std::array<double, 2> moved(const std::vector<Index>& vertices, const std::vector<Point>& from, const std::vector<Point>& to);
/// "mean (most)".
std::string both(const std::array<double, 2>& mean_and_max, int after_point);

std::string digits(double value, int after_point);

/// The result as a PLY in the annotations' colours, with one number a face as FILE.npy (not a number: none) if there are some.
void write_outcome(const Path& folder, const Subject& subject, const Outcome& outcome,
                   const std::vector<double>& face_values = {});

/// One problem solved plainly and with acceleration, from the same start: table and plot in FOLDER/convergence-NAME.
struct Problem {
    std::string name, title;
    std::function<SolveSummary(const SolveOptions&)> solve;
};
void compare_convergence(const Path& folder, const std::vector<Problem>& problems, int iterations);

}  // namespace ostraka::experiments
