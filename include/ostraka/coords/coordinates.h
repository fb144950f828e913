// Cage coordinates: each point is a combination of the vertices (and, for Green coordinates, the face normals) of a closed
// triangle mesh, so that moving the cage moves the points (thesis, section 4.1.3; doc/coordinates.md).
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace ostraka {

/// Dense weights, one row per point; the weights of a row are contiguous in memory.
using WeightMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Sparse weights, one row per point, stored row by row.
using SparseWeights = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// Weights of points with respect to a cage.
struct Coordinates {
    std::string kind;     ///< "mean-value", "green" ...
    WeightMatrix vertex;  ///< weight of each cage vertex (column) for each point (row)
    /// Weight of each cage face normal (column) for each point (row), in units of length; for kinds without a normal term a
    /// matrix of size 0 x 0.
    WeightMatrix normal;
    /// Sparse copy of `vertex` for kinds whose weights are mostly zero; for other kinds a matrix of size 0 x 0.
    SparseWeights sparse = {};
    /// For kinds computed on tetrahedra: name and seconds of each phase (tetrahedralisation, weights at the nodes, weights of the
    /// points).
    std::vector<std::pair<std::string, double>> seconds = {};
    [[nodiscard]] bool has_normals() const { return normal.size() > 0; }  ///< true for kinds with a normal term
    [[nodiscard]] bool is_sparse() const { return sparse.rows() > 0; }    ///< true if `sparse` is filled
    /// The fraction of the weights that are stored; 1 for dense weights.
    [[nodiscard]] double stored_share() const;
};

/// Options of `compute_coordinates`.
struct CoordinateOptions {
    /// A point closer than this distance to a vertex, an edge or a face of the cage counts as lying on that element; relative to
    /// the cage's diagonal.
    double snap = 4e-15;
    /// Approximate number of nodes, for kinds computed on tetrahedra inside the cage.
    std::uint64_t nodes = 20000;
    /// Weights below this value are dropped, for kinds with sparse weights.
    double drop = 1e-4;
    /// Maximum number of iterations, for local coordinates.
    int iterations = 300;
    /// Local coordinates: stop when ten iterations reduce the total variation by less than this fraction.
    double tolerance = 1e-4;
    /// For nested cages: the influence of an inner cage rises from 0, where the mesh enters the inner cage, to 1 over this
    /// distance; relative to the inner cage's diagonal.
    double fade = 0.15;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// A kind of cage coordinates that can be computed by name.
struct CoordinateKind {
    std::string name, about;  ///< name of the kind; description for help texts
    bool on_cage = true;      ///< true: defined also for points on the cage and outside
    /// True: has a normal term and cannot be used for constrained deformation (thesis, equation 4.9).
    bool with_normals = false;
    /// Function that computes coordinates of this kind. The caller ensures that the cage is a closed triangle mesh without
    /// removed elements, and that all coordinates are finite.
    std::function<Coordinates(const Mesh& cage, const std::vector<Point>& points, const CoordinateOptions&)> compute;
};

/// Registers a kind of coordinates under its name; a kind of the same name is replaced. Not thread-safe: do not call while
/// coordinates are computed.
void add_coordinate_kind(CoordinateKind kind);
/// The names of all kinds of coordinates: "mean-value", "green", "harmonic", "local", "positive-mean-value" and the registered
/// ones.
std::vector<std::string> coordinate_kinds();
/// The kind of this name. Throws Error (usage) that lists all kinds if there is no kind of this name.
const CoordinateKind& coordinate_kind(const std::string& name);

/// Coordinates of `points` in `cage`. Time and memory are proportional to points x (vertices + faces); the result is the same
/// to the bit for any number of threads. Throws Error (usage) for an unknown kind; Error (input) for a cage that is empty,
/// open, not a triangle mesh, without volume or not finite, for points that are not finite, and for points at which coordinates
/// of this kind are not defined (the message names the first such point).
///
/// mean-value: Ju, Schaefer and Warren, Mean value coordinates for closed triangular meshes, 2005, in vector form; for points
/// inside, outside and on the cage. On a face, edge or vertex of the cage, mean value coordinates are linear interpolation.
/// green: Lipman, Levin and Cohen-Or, Green coordinates, 2008; for points strictly inside; the cage is oriented outward.
/// The kinds harmonic, local and positive-mean-value are for points inside and on a cage without self-intersections.
/// The weights of these kinds are sparse. As a last step, every row is projected to weights that are non-negative, sum to one and
/// reproduce the point up to rounding. harmonic: Joshi, Meyer, DeRose, Green and Sanocki, Harmonic coordinates for character
/// articulation, 2007; computed by linear finite elements on tetrahedra inside the cage. local: Zhang, Deng, Liu, Patanè,
/// Bouaziz, Hormann and Liu, Local barycentric coordinates, 2014; computed on the same tetrahedra; each gradient is weighted by
/// its distance, within the cage, from the cage vertex. positive-mean-value: Lipman, Kopf, Cohen-Or and Levin, GPU-assisted
/// positive mean value coordinates, 2007: mean value coordinates restricted to the part of the cage that is visible from the
/// point, computed by evenly distributed rays.
Coordinates compute_coordinates(const std::string& kind, const Mesh& cage, const std::vector<Point>& points,
                                const CoordinateOptions& options = {});
/// Coordinates of the vertices of a mesh in `cage`. If the cage contains other cages, the coordinates cover all nested cages
/// (coords/nested.h). Errors and running time are as for `compute_coordinates` of a list of points.
Coordinates compute_coordinates(const std::string& kind, const Mesh& cage, const Mesh& mesh,
                                const CoordinateOptions& options = {});
/// The points of a mesh, in the order of its vertices.
std::vector<Point> points_of(const Mesh& mesh);

/// The positions of the points when the cage vertices are at `cage_points`. Green coordinates scale the normals by the stretch of
/// their faces (section 3 of the paper). Throws Error (usage) if the sizes do not match.
std::vector<Point> deformed(const Coordinates& coordinates, const Mesh& rest_cage, const std::vector<Point>& cage_points);

/// The face normals to which Green coordinates apply the normal weights. The length of each normal is the stretch of its face
/// relative to the undeformed cage. The normal of a face without area in the undeformed cage is zero.
std::vector<Vector> stretched_normals(const Mesh& rest_cage, const std::vector<Point>& cage_points);

}  // namespace ostraka
