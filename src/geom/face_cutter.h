// Subdivision of single faces along curves.
#pragma once

#include "ostraka/geom/insert_curves.h"

#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace ostraka {

/// Subdivides single faces of a mesh along curves. Each point of the curves gets a vertex: old vertices keep their indices, and
/// new vertices follow. Mesh and curves must outlive this object.
class FaceCutter {
public:
    FaceCutter(const Mesh& mesh, const std::vector<SurfaceCurve>& curves);

    /// For each curve and each of its points: index of the vertex.
    [[nodiscard]] const std::vector<std::vector<Index>>& node_vertex() const { return node_vertex_; }
    /// All vertices along a curve: the vertices at its points, other vertices on an edge that a piece follows, and crossings of
    /// curves inside faces that have already been cut.
    [[nodiscard]] std::vector<Index> path(std::size_t curve) const;
    /// Faces that curves cross or touch at a point on an edge, ascending.
    [[nodiscard]] std::vector<Index> faces() const;
    /// The triangles that replace a face, as indices of vertices; crossings of curves inside the face may add vertices.
    std::vector<std::array<Index, 3>> cut(Index face);
    /// For each new vertex, in index order: its position on the uncut mesh.
    [[nodiscard]] const std::vector<SurfacePoint>& new_points() const { return points_; }
    /// Coordinates of each new vertex.
    [[nodiscard]] const std::vector<Point>& new_positions() const { return positions_; }
    /// Index of an old edge -> (fraction along the edge's first halfedge, index) of each new vertex on the edge, by ascending
    /// fraction.
    [[nodiscard]] const std::map<Index, std::vector<std::pair<double, Index>>>& on_edge() const { return on_edge_; }
    /// Coordinates of an old or new vertex.
    [[nodiscard]] const Point& point(Index v) const {
        return v < mesh_.number_of_vertices() ? mesh_.point(Vertex(v)) : positions_[v - mesh_.number_of_vertices()];
    }

private:
    /// Vertices and segments to insert into one face.
    struct Cut {
        std::vector<Index> inner;                       ///< vertices strictly inside the face
        std::vector<std::pair<Index, Index>> segments;  ///< pieces of curves, as pairs of vertices
    };
    Index add_point(const SurfacePoint& p);
    Index vertex_at(const SurfacePoint& p);
    [[nodiscard]] std::vector<Index> border(Index face) const;
    class FaceTriangulation;

    const Mesh& mesh_;
    const std::vector<SurfaceCurve>& curves_;
    std::vector<SurfacePoint> points_;
    std::vector<Point> positions_;
    std::vector<std::vector<Index>> node_vertex_;
    std::map<Index, std::vector<std::pair<double, Index>>>
        on_edge_;  ///< index of an old edge -> (fraction along its first halfedge, vertex), by ascending fraction
    std::map<std::pair<Index, double>, Index> edge_vertex_;
    std::map<std::tuple<Index, double, double>, Index> face_vertex_;
    std::map<Index, Cut> cuts_;
    std::map<std::pair<Index, Index>, std::vector<Index>>
        crossed_;  ///< pieces that others cross, by their ends -> vertices between the ends
};

}  // namespace ostraka
