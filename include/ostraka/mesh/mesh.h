// The kernel, the mesh type and basic queries used by all modules.
#pragma once

#include <CGAL/Bbox_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

/// CGAL kernel with exact predicates and constructions in double precision.
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;
using Mesh = CGAL::Surface_mesh<Point>;  ///< halfedge mesh of triangles
using Vertex = Mesh::Vertex_index;
using Halfedge = Mesh::Halfedge_index;
using Edge = Mesh::Edge_index;
using Face = Mesh::Face_index;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Index of a vertex or of a face in a file or a plain array.
using Index = std::uint32_t;
inline constexpr Index no_index = static_cast<Index>(-1);  ///< index of no element

/// Indexed triangles as read from a file, without any guarantee about the topology.
struct TriangleSoup {
    std::vector<std::array<double, 3>> points;  ///< coordinates of the points, in the unit of the file
    /// Indices of the corners of each triangle, counter-clockwise seen from outside.
    std::vector<std::array<Index, 3>> triangles;
};

/// Reasons why a triangle soup is not an oriented 2-manifold (with or without border).
struct ManifoldDefects {
    std::size_t repeated_corners = 0;   ///< number of triangles with a repeated vertex
    std::size_t nonmanifold_edges = 0;  ///< number of edges with more than two triangles
    std::size_t misoriented_edges = 0;  ///< number of edges that two triangles traverse in the same direction
    /// Number of vertices with several fans of triangles; counted only if no edge has a defect.
    std::size_t nonmanifold_vertices = 0;
    Index example_triangle = no_index;  ///< index of a triangle at which the first defect was found
    /// True if there is at least one defect.
    [[nodiscard]] bool any() const { return repeated_corners + nonmanifold_edges + misoriented_edges + nonmanifold_vertices > 0; }
};

/// Builds the halfedge mesh in linear time, keeping the order of vertices and triangles and the isolated vertices. Returns the
/// defects found; `mesh` is empty if there are defects. Throws Error if an index of a triangle is out of range.
ManifoldDefects try_build_mesh(const TriangleSoup& soup, Mesh& mesh);

/// Builds the halfedge mesh like `try_build_mesh`, but throws an Error that names the defects if there are any.
Mesh build_mesh(const TriangleSoup& soup);

/// The points and triangles of a mesh in index order; the mesh must have no garbage (removed elements).
TriangleSoup to_soup(const Mesh& mesh);

/// The corners of a triangle, starting at the target of its stored halfedge, so that a mesh built from a soup returns the
/// corner order of the soup.
std::array<Vertex, 3> corners(const Mesh& mesh, Face face);

/// Area vector of a face: half the cross product of two edges (length = area, direction = outward normal).
Vector area_vector(const Mesh& mesh, Face face);
double face_area(const Mesh& mesh, Face face);  ///< area of a face
double surface_area(const Mesh& mesh);          ///< sum of the areas of all faces
Point centroid(const Mesh& mesh, Face face);    ///< mean of the corners of a face

/// Sum of the adjacent faces' area vectors weighted by the corner angle, normalised (Thuermer and Wuethrich 1998); the null
/// vector if the sum is null.
Vector vertex_normal(const Mesh& mesh, Vertex vertex);

/// Axis-aligned bounding box of the vertices with faces (of all vertices if no vertex has a face).
CGAL::Bbox_3 bounding_box(const Mesh& mesh);
/// Length of the diagonal of the bounding box; all relative tolerances refer to this length.
double box_diagonal(const Mesh& mesh);
/// Mean edge length; 0 for a mesh without edges.
double mean_edge_length(const Mesh& mesh);

/// The halfedge from `a` to `b`; the null halfedge if there is none. Time: linear in the size of the one-ring of `a`.
Halfedge find_halfedge(const Mesh& mesh, Vertex a, Vertex b);

/// SHA-256 (hexadecimal) of the indexed geometry of a mesh: vertex and face counts as uint64, coordinates as float64 (negative
/// zero as zero), triangle indices as uint32, all little-endian. The checksum is equal for files of any format that hold the same
/// mesh.
std::string mesh_checksum(const Mesh& mesh);

}  // namespace ostraka

// Compiled once, with the library.
/// @cond
extern template CGAL::Surface_mesh<ostraka::Point>::Surface_mesh();
extern template CGAL::Surface_mesh<ostraka::Point>::Surface_mesh(const CGAL::Surface_mesh<ostraka::Point>&);
extern template CGAL::Surface_mesh<ostraka::Point>::Surface_mesh(CGAL::Surface_mesh<ostraka::Point>&&);
extern template CGAL::Surface_mesh<ostraka::Point>& CGAL::Surface_mesh<ostraka::Point>::operator=(
    const CGAL::Surface_mesh<ostraka::Point>&);
extern template class CGAL::Properties::Property_container<ostraka::Mesh, ostraka::Vertex>;
extern template class CGAL::Properties::Property_container<ostraka::Mesh, ostraka::Halfedge>;
extern template class CGAL::Properties::Property_container<ostraka::Mesh, ostraka::Edge>;
extern template class CGAL::Properties::Property_container<ostraka::Mesh, ostraka::Face>;
extern template class CGAL::Properties::Property_array<ostraka::Mesh::Vertex_connectivity>;
extern template class CGAL::Properties::Property_array<ostraka::Mesh::Halfedge_connectivity>;
extern template class CGAL::Properties::Property_array<ostraka::Mesh::Face_connectivity>;
extern template class CGAL::Properties::Property_array<ostraka::Point>;
extern template class std::vector<ostraka::Point>;
extern template class std::vector<ostraka::Vertex>;
extern template class std::vector<ostraka::Halfedge>;
extern template class std::vector<ostraka::Face>;
/// @endcond
