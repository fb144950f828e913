// Faces cut along curves, one at a time.
#pragma once

#include "ostraka/geom/insert_curves.h"

#include <map>
#include <utility>
#include <vector>

namespace ostraka {

/// Gives each node of the curves, which must outlive it, a vertex (old vertices keep their index, new ones are counted on) and
/// cuts single faces.
class FaceCutter {
public:
    FaceCutter(const Mesh& mesh, const std::vector<SurfaceCurve>& curves);

    /// Vertex at each node, per curve.
    [[nodiscard]] const std::vector<std::vector<Index>>& node_vertex() const { return node_vertex_; }
    /// The same with the vertices between: where the piece runs along an edge that has other vertices, or where curves cross it
    /// inside a face that was cut already.
    [[nodiscard]] std::vector<Index> path(std::size_t curve) const;
    /// Faces that curves cross or touch with a node on an edge, ascending.
    [[nodiscard]] std::vector<Index> faces() const;
    /// The triangles that a face becomes; crossings of curves inside it may add points.
    std::vector<std::array<Index, 3>> cut(Index face);
    /// Places of the new vertices, in the order of their index.
    [[nodiscard]] const std::vector<SurfaceNode>& new_nodes() const { return nodes_; }
    /// Old edge -> the new vertices on it with their parameters, ascending.
    [[nodiscard]] const std::map<Index, std::vector<std::pair<double, Index>>>& on_edge() const { return on_edge_; }
    [[nodiscard]] const Point& point(Index v) const {
        return v < mesh_.number_of_vertices() ? mesh_.point(Vertex(v)) : nodes_[v - mesh_.number_of_vertices()].point;
    }

private:
    /// What happens inside one face.
    struct Cut {
        std::vector<Index> inner;                       ///< vertices strictly inside
        std::vector<std::pair<Index, Index>> segments;  ///< pieces of curves, by vertex
    };
    Index add_node(const SurfaceNode& node);
    void place_nodes(const std::vector<SurfaceCurve>& curves);
    [[nodiscard]] std::vector<Index> border(Index face) const;
    bool triangulate(Index face, const Cut& cut, const std::vector<Index>& vertex_path, bool with_curves,
                     std::vector<std::array<Index, 3>>& triangles);

    const Mesh& mesh_;
    const std::vector<SurfaceCurve>& curves_;
    std::vector<SurfaceNode> nodes_;
    std::vector<std::vector<Index>> node_vertex_;
    std::map<Index, std::vector<std::pair<double, Index>>> on_edge_;  ///< vertices on an edge, by parameter
    std::map<Index, Cut> cuts_;
    std::map<std::pair<Index, Index>, std::vector<Index>>
        crossed_;  ///< pieces that others cross: the vertices between their ends
};

}  // namespace ostraka
