// The surface divided into triangles of about the size of a texel, with the colours of the surface at their corners (nodes).
#pragma once

#include "ostraka/geom/surface_point.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/surface_colour.h"
#include "ostraka/mesh/mesh.h"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace ostraka {

/// A face divided into n^2 triangles, further divided where a neighbour across an edge is finer. Shared by all faces with the
/// same numbers of divisions.
struct FaceDivision {
    struct Node {
        std::array<double, 3> weights;  ///< barycentric coordinates in the face
        int place;                      ///< 0 to 2: that corner; 3 + k: the edge from corner k to the next; 6: inside the face
        Index index;  ///< along the edge from corner k: number of the node; inside: number among the inner nodes of the face
    };
    Index n = 1;                                  ///< number of divisions of each edge
    std::vector<Node> nodes;                      ///< corners of the triangles
    std::vector<std::array<Index, 3>> triangles;  ///< indices of nodes, in the orientation of the face
    std::vector<Index> cell_begin;  ///< for each of the n^2 triangles of the plain division: its first triangle; and the end
    Index inner = 0;                ///< number of nodes inside the face
};

/// Largest number of divisions of an edge, and of nodes of a grid.
inline constexpr Index max_edge_divisions = 1024;
inline constexpr double max_grid_nodes = 8e6;

/// Nodes are numbered: first the vertices of the mesh, then the nodes on its edges, then those inside its faces. Deterministic.
class TexelGrid {
public:
    /// Divides each face so that its longest edge has a power of two of parts, nearest to `spacing`; the spacing is increased
    /// until there are at most `max_grid_nodes` nodes. `mesh` must outlive the object. Throws Error (failure) if memory does not
    /// suffice.
    TexelGrid(const Mesh& mesh, double spacing);

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    [[nodiscard]] std::size_t size() const { return size_; }   ///< number of nodes
    [[nodiscard]] double spacing() const { return spacing_; }  ///< distance of nodes, in the unit of the mesh
    [[nodiscard]] const FaceDivision& division(Face face) const { return *division_[face]; }
    /// Numbers of the nodes of a face, in the order of its division.
    void nodes_of(Face face, std::vector<Index>& numbers) const;
    [[nodiscard]] Index node_on_edge(Edge edge, Index position) const;  ///< position 0 is the source of halfedge(edge, 0)
    [[nodiscard]] Index edge_divisions(Edge edge) const { return Index{1} << edge_log_[edge]; }
    /// Nodes that share an edge of the grid with the node.
    [[nodiscard]] std::pair<const Index*, const Index*> neighbours(std::size_t node) const {
        return {neighbour_.data() + neighbour_begin_[node], neighbour_.data() + neighbour_begin_[node + 1]};
    }
    /// Area of a node: a third of that of the grid's triangles around it.
    [[nodiscard]] const std::vector<float>& areas() const { return area_; }
    /// The triangle of a face's division that contains the point.
    [[nodiscard]] std::size_t triangle_at(Face face, const std::array<double, 3>& weights) const;
    /// The node of the face nearest to the point, in the triangle that contains it.
    [[nodiscard]] Index nearest_node(Face face, const std::array<double, 3>& weights) const;

    /// The point on the edge between two nodes of a triangle of the face, at the share `share` of the way from the node with the
    /// smaller number to that with the larger one. The same bits from both faces of an edge.
    [[nodiscard]] SurfacePoint between(Face face, Index a, Index b, const std::vector<Index>& numbers, double share) const;

    /// The mean of each value and those around it, `rounds` times: half the value and half the mean of its neighbours.
    template <class Value>
    void blur(std::vector<Value>& values, int rounds) const;

private:
    void divide(double spacing);
    void number();
    void connect();

    const Mesh& mesh_;
    double spacing_;
    std::size_t size_ = 0;
    std::vector<std::uint8_t> face_log_, edge_log_;
    std::vector<Index> edge_begin_, face_begin_;
    std::map<std::array<std::uint8_t, 4>, FaceDivision> divisions_;
    std::vector<const FaceDivision*> division_;
    std::vector<std::size_t> neighbour_begin_;
    std::vector<Index> neighbour_;
    std::vector<float> area_;
};

/// Curves between nodes keep this share of the spacing away from them.
inline constexpr double nearest_to_node = 1.0 / 64;

using LabNode = std::array<float, 3>;  ///< colour of a node in CIELAB

/// The surface at the resolution of its image, with its colours.
struct TexelColours {
    /// Spacing: the root of the area of the faces with an image per texel of the image; without an image a half of the mean edge
    /// length, or for colours of faces a sixth. Colours at seams are means of those of both sides, read within the charts.
    /// Throws Error (input) for an image that cannot be decoded.
    TexelColours(const Mesh& mesh, const MeshExtras& extras, const std::string& where);
    TexelColours(const Mesh& mesh, const MeshExtras& extras, const SurfaceColour& surface);
    TexelGrid grid;
    std::vector<LabNode> lab;  ///< one colour per node
};

}  // namespace ostraka
