// Subdivision of single faces along curves.
#pragma once

#include "ostraka/geom/insert_curves.h"

#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace ostraka {

/// Assigns a vertex to each point of the curves, which must outlive this object (old vertices keep their indices, new ones
/// follow), and subdivides single faces.
class FaceCutter {
public:
    FaceCutter(const Mesh& mesh, const std::vector<SurfaceCurve>& curves);

    /// Vertex at each point, per curve.
    [[nodiscard]] const std::vector<std::vector<Index>>& node_vertex() const { return node_vertex_; }
    /// The same with the vertices in between: other vertices on an edge that a piece follows, and crossings of curves inside a
    /// face that has already been cut.
    [[nodiscard]] std::vector<Index> path(std::size_t curve) const;
    /// Faces that curves cross or touch at a point on an edge, ascending.
    [[nodiscard]] std::vector<Index> faces() const;
    /// The triangles that replace a face; crossings of curves inside it may add vertices.
    std::vector<std::array<Index, 3>> cut(Index face);
    /// The new vertices, in index order: their places and coordinates.
    [[nodiscard]] const std::vector<SurfacePoint>& new_points() const { return points_; }
    [[nodiscard]] const std::vector<Point>& new_positions() const { return positions_; }
    /// Old edge -> the new vertices on it with their fractions along its first halfedge, ascending.
    [[nodiscard]] const std::map<Index, std::vector<std::pair<double, Index>>>& on_edge() const { return on_edge_; }
    [[nodiscard]] const Point& point(Index v) const {
        return v < mesh_.number_of_vertices() ? mesh_.point(Vertex(v)) : positions_[v - mesh_.number_of_vertices()];
    }

private:
    /// Elements inside one face.
    struct Cut {
        std::vector<Index> inner;                       ///< vertices strictly inside
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
        on_edge_;  ///< vertices on an edge, by fraction along its first halfedge
    std::map<std::pair<Index, double>, Index> edge_vertex_;
    std::map<std::tuple<Index, double, double>, Index> face_vertex_;
    std::map<Index, Cut> cuts_;
    std::map<std::pair<Index, Index>, std::vector<Index>>
        crossed_;  ///< pieces crossed by others: the vertices between their ends
};

}  // namespace ostraka
