// Coordinates of points in a cage: each point as a combination of the vertices (and, for Green coordinates, the face normals) of
// a closed triangle mesh, so that moving the cage moves the points (thesis, section 4.1.3; doc/coordinates.md).
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// A row for each point; rows are contiguous.
using WeightMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The same, of which only what is not zero is stored, row by row.
using SparseWeights = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

struct Coordinates {
    std::string kind;           ///< "mean-value", "green" ...
    WeightMatrix vertex;        ///< points x cage vertices, columns in the order of the cage's vertices
    WeightMatrix normal;        ///< points x cage faces, in units of length; 0 x 0 for kinds without a normal term
    SparseWeights sparse = {};  ///< `vertex` again, of kinds most of whose weights are zero; 0 x 0 for others
    /// Of kinds on tetrahedra, seconds that each phase took: tetrahedra, weights at their nodes, points.
    std::vector<std::pair<std::string, double>> seconds = {};
    [[nodiscard]] bool has_normals() const { return normal.size() > 0; }
    [[nodiscard]] bool is_sparse() const { return sparse.rows() > 0; }
    /// The share of the weights that are stored: 1 where all are.
    [[nodiscard]] double stored_share() const;
};

struct CoordinateOptions {
    /// A point nearer to a vertex, an edge or a face of the cage than this share of the cage's diagonal counts as lying on it.
    double snap = 4e-15;
    /// Of kinds on tetrahedra inside the cage: about how many nodes these have, and which weights are left out.
    std::uint64_t nodes = 20000;
    double drop = 1e-4;
    /// Of local coordinates: steps at most, and the share by which the total variation falls in ten steps that ends them.
    int iterations = 300;
    double tolerance = 1e-4;
    /// Of cages within cages: over what share of an inner cage's diagonal its hold rises from where the mesh enters it.
    double fade = 0.15;

    void describe(OptionList& visit);
};

/// A kind of coordinates. `compute` may rely on a cage that is closed, of triangles, without garbage, and on finite numbers.
struct CoordinateKind {
    std::string name, about;
    bool on_cage = true;        ///< defined for points on the cage, and outside
    bool with_normals = false;  ///< has a normal term: not for constrained deformation (thesis, equation 4.9)
    std::function<Coordinates(const Mesh& cage, const std::vector<Point>& points, const CoordinateOptions&)> compute;
};

/// Adds a kind to those that names can be given of, or replaces the one of that name. Not while others compute.
void add_coordinate_kind(CoordinateKind kind);
/// The kinds there are: "mean-value", "green", "harmonic", "local" and "positive-mean-value", and those that were added.
std::vector<std::string> coordinate_kinds();
/// Throws Error (usage) that lists the kinds if there is none of that name.
const CoordinateKind& coordinate_kind(const std::string& name);

/// Coordinates of `points` in `cage`, in time and memory proportional to points x (vertices + faces); the same to the bit for
/// any number of threads. Throws Error (usage) for an unknown kind, Error (input) for a cage that is empty, open, not of
/// triangles, without volume or not finite, for points that are not finite, and, naming the first of them, for points where the
/// kind is not defined.
///
/// mean-value: Ju, Schaefer and Warren, Mean value coordinates for closed triangular meshes, 2005, in vector form; for points
/// inside, outside and on the cage. On a face, edge or vertex they are the linear interpolation there.
/// green: Lipman, Levin and Cohen-Or, Green coordinates, 2008; for points strictly inside; the cage is oriented outward.
/// The others are for points inside and on a cage that does not cross itself. Their weights are sparse, and in every row none is
/// negative, they sum to one and give the point, to rounding: rows are projected to that after all else.
/// harmonic: Joshi, Meyer, DeRose, Green and Sanocki, Harmonic coordinates for character articulation, 2007; by linear finite
/// elements on tetrahedra inside the cage.
/// local: Zhang, Deng, Liu, Patanè, Bouaziz, Hormann and Liu, Local barycentric coordinates, 2014; on the same tetrahedra, each
/// gradient weighted by its distance from the cage vertex within the cage.
/// positive-mean-value: Lipman, Kopf, Cohen-Or and Levin, GPU-assisted positive mean value coordinates, 2007: mean value
/// coordinates of what each point sees of the cage, by evenly spread rays.
Coordinates compute_coordinates(const std::string& kind, const Mesh& cage, const std::vector<Point>& points,
                                const CoordinateOptions& options = {});
/// As above, for the vertices of a mesh; in a cage that holds others, of all of them together (coords/nested.h).
Coordinates compute_coordinates(const std::string& kind, const Mesh& cage, const Mesh& mesh,
                                const CoordinateOptions& options = {});
/// The points of a mesh, in the order of its vertices.
std::vector<Point> points_of(const Mesh& mesh);

/// Where the points come to lie when the vertices of the cage move to `cage_points`; Green coordinates scale the normals by the
/// stretch of their faces (section 3 of the paper). Throws Error (usage) if the numbers do not fit.
std::vector<Point> deformed(const Coordinates& coordinates, const Mesh& rest_cage, const std::vector<Point>& cage_points);

/// The normals of the faces, each as long as its face is stretched with respect to the rest cage: what the normal weights
/// multiply. Zero for faces without area at rest.
std::vector<Vector> stretched_normals(const Mesh& rest_cage, const std::vector<Point>& cage_points);

}  // namespace ostraka
