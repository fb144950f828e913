// The scenes of experiments: objects at several resolutions, regions, motions, coloured meshes.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/core/options.h"
#include "ostraka/files/file.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/geom/with_points.h"
#include "ostraka/relation/graph.h"
#include "ostraka/semantic/edit.h"
#include "ostraka/stats/random.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka::experiments {

/// "50K", "2M".
std::string size_name(std::size_t vertices);

Mesh made_mesh(const std::string& object, std::uint64_t vertices, std::uint64_t seed = 1);
/// A synthetic object, "made:NAME", or a mesh file.
Mesh read_or_make(const std::string& source, std::uint64_t vertices, std::uint64_t seed = 1);
/// A copy with at most `vertices` vertices.
Mesh simplified(Mesh mesh, std::uint64_t vertices);
/// Subdivided smoothly (Loop) until it has at least `vertices` vertices.
Mesh refined(Mesh mesh, std::uint64_t vertices);
/// Remeshed with about `vertices` vertices.
Mesh remeshed(const Mesh& mesh, std::uint64_t vertices);
/// Splits "TEMPLATE=MEMBER". Throws Error (usage) if there is no equals sign.
std::pair<std::string, std::string> split_pair(const std::string& pair);

/// The annotation with this tag. Throws Error (input) if there is none.
const Annotation& tagged(const AnnotationSet& set, const std::string& tag);
/// An annotated mesh whose parts are found by their tags.
struct Subject : AnnotatedMesh {
    [[nodiscard]] const Annotation& part(const std::string& tag) const { return tagged(annotations, tag); }
    [[nodiscard]] int id(const std::string& tag) const { return part(tag).id; }
    [[nodiscard]] std::vector<Index> vertices(const std::string& tag) const { return vertices_of(mesh, part(tag)); }
};

/// Options of experiments on an annotated mesh.
struct AnnotatedOptions {
    std::string mesh, annotations, output = "experiments-output";
    void declare_options(OptionList& list) {
        list("mesh", mesh, "mesh file").positional().required();
        list("annotations", annotations, "annotations of the mesh (.ant.json)").positional().required();
        list("output", output, "output folder");
    }
    [[nodiscard]] Subject read() const;
};

/// A copy whose vertices are at warp(position), Eigen::Vector3d to Eigen::Vector3d.
template <class Warp>
Mesh warped(Mesh mesh, const Warp& warp) {
    for (const Vertex v : mesh.vertices()) mesh.point(v) = point_of(Eigen::Vector3d(warp(eigen(mesh.point(v)))));
    return mesh;
}
template <class Warp>
std::vector<Point> warped(std::vector<Point> points, const Warp& warp) {
    for (Point& p : points) p = point_of(Eigen::Vector3d(warp(eigen(p))));
    return points;
}
/// Three normally distributed numbers; z is drawn first.
inline Eigen::Vector3d normal_vector(Random& random) {
    const double z = random.normal(), y = random.normal(), x = random.normal();
    return {x, y, z};
}

/// The faces nearest to a vertex (by edge paths), up to a share of the mesh's area.
std::vector<Index> disc(const Mesh& mesh, Vertex seed, double share);
/// Farthest-point sampling of vertices, starting with the one farthest from the centre.
std::vector<Index> spread_out(const Mesh& mesh, const std::vector<Index>& among, std::size_t count);
std::vector<Index> all_vertices(const Mesh& mesh);
Annotation landmark(int id, const std::string& tag, Index vertex);
Relationship constraint(int id, const std::string& type, std::vector<int> members, const std::string& parameters, double weight);
/// Adds a measure of the part's height, along z, in mm; returns its value.
double add_height(const Mesh& mesh, Annotation& part, const std::string& name);
/// Calls take(barycentric weights) for the centroids of the n^2 equal triangles that divide a triangle.
template <class Take>
void for_each_part(int n, const Take& take) {
    for (int u = 0; u < n; ++u)
        for (int v = 0; u + v < n; ++v)
            for (int half = 0; half < (u + v + 1 < n ? 2 : 1); ++half) {
                const double s = (u + (half == 0 ? 1.0 : 2.0) / 3) / n, t = (v + (half == 0 ? 1.0 : 2.0) / 3) / n;
                take(std::array{1 - s - t, s, t});
            }
}

double degrees_of(const Motion& motion);
/// Root mean square displacement of the vertices.
double off_of(const Mesh& mesh, const Motion& motion);
/// The first three rows of a matrix in a file.
template <class Rows>
Motion motion_of(const Rows& matrix) {
    Motion motion;
    for (unsigned i = 0; i < 3; ++i)
        for (unsigned j = 0; j < 4; ++j) (j < 3 ? motion.rotation(i, j) : motion.translation(i)) = matrix[i][j].GetDouble();
    return motion;
}

/// The columns as points.
std::vector<Point> mesh_points(const Eigen::Matrix3Xd& columns);
/// Length of each vertex's displacement between two shapes.
std::vector<double> displacements(const std::vector<Point>& from, const std::vector<Point>& to);
/// Writes a PLY whose vertices are coloured by one value each, also stored as the property "quality". The colour scale runs
/// from 0 to `maximum`, so that several meshes can share it; without `maximum`, over the given values.
void write_coloured(const Path& file, const Mesh& mesh, const std::vector<double>& values, std::optional<double> maximum = {});

}  // namespace ostraka::experiments
