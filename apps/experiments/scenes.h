// The scenes of experiments: objects at several resolutions, regions, motions, coloured meshes.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/files/file.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/rigid_fit.h"
#include "ostraka/geom/with_points.h"
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
/// The annotation with this tag. Throws Error (input) if there is none.
const Annotation& tagged(const AnnotationSet& set, const std::string& tag);
Annotation landmark(int id, const std::string& tag, Index vertex);
/// Centre of gravity of the surface.
Eigen::Vector3d surface_centre(const Mesh& mesh);
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

/// A uniformly random rotation, and a shift of about `far`.
Motion random_motion(Random& random, double far);
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

/// Length of each vertex's displacement between two shapes.
std::vector<double> displacements(const std::vector<Point>& from, const std::vector<Point>& to);
/// Writes a PLY whose vertices are coloured by one value each, also stored as the property "quality". The colour scale runs
/// from 0 to `maximum`, so that several meshes can share it; without `maximum`, over the given values.
void write_coloured(const Path& file, const Mesh& mesh, const std::vector<double>& values, std::optional<double> maximum = {});

}  // namespace ostraka::experiments
