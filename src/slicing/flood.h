// Pools of liquid below a horizontal plane: components of the space without clay. Private to the module.
#pragma once

#include "ostraka/mesh/disjoint_sets.h"
#include "ostraka/mesh/mesh.h"
#include "ostraka/slicing/slice.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace ostraka::detail {

/// One side of the surface at a vertex: where a pool is wet.
struct WetPlace {
    Index vertex = no_index;
    int side = 0;  ///< 0: the side to which the normals point; 1: the other
};

/// The space below one plane. Nodes of `sets`: the two sides of each piece of the surface (2 piece + side), then the regions of
/// the plane; the first region is the unbounded one.
struct Waterline {
    double level = 0;
    std::vector<Index> piece;  ///< for each vertex: its piece; no_index: at or above the plane
    Index pieces = 0;
    std::vector<std::uint8_t> open;  ///< for each piece: 1 if a border lies below the plane
    DisjointSets sets{0};
    /// A closed contour: its signed area, the sides of its piece inside and outside, the region around it.
    struct Loop {
        double area = 0;
        Index inside = 0, outside = 0;  ///< nodes
        Index parent = 0;               ///< the region around the loop, 0: the unbounded one
        bool clay = false;              ///< true: the region within is enclosed by an odd number of closed components
        Index component = 0;            ///< component of the mesh
    };
    std::vector<Loop> loops;
    std::size_t crossing = 0;  ///< number of loops that cross others

    [[nodiscard]] Index region(std::size_t loop) const { return 2 * pieces + 1 + static_cast<Index>(loop); }
    [[nodiscard]] Index unbounded() const { return 2 * pieces; }
    /// The set of a place; no_index if the vertex is not below the plane.
    [[nodiscard]] Index set_of(const WetPlace& place) {
        const Index p = piece[place.vertex];
        return p == no_index ? no_index : sets.find(2 * p + static_cast<Index>(place.side));
    }
    /// True if a set lies between two walls of one component: there is clay, though the component has a border somewhere.
    [[nodiscard]] bool between_walls(Index set) {
        const Index outside = sets.find(unbounded());
        if (set == outside) return false;
        for (std::size_t i = 0; i < loops.size(); ++i) {
            if (loops[i].parent == 0 || loops[loops[i].parent - 1].component != loops[i].component) continue;
            const Index inner = sets.find(region(i));
            if (sets.find(region(loops[i].parent - 1)) == set && inner != set && inner != outside) return true;
        }
        return false;
    }
    /// True if the place is below the plane and connected with the unbounded region.
    [[nodiscard]] bool spilled(const WetPlace& place) {
        const Index set = set_of(place);
        return set != no_index && set == sets.find(unbounded());
    }
};

/// Volume below a plane at the selected sides of the pieces.
struct PoolSize {
    double volume = 0, wetted = 0, surface = 0;
    double squared_areas = 0;  ///< sum over the vertices of the square of a vertex's share of the wetted area
    Index lowest = no_index;   ///< lowest wet vertex
    bool open = false;         ///< true: a border of the mesh is wet
};

/// A mesh prepared for planes across one direction.
class Flood {
public:
    Flood(const Mesh& mesh, const SliceFrame& frame);

    /// Different heights of the vertices with faces, ascending.
    [[nodiscard]] const std::vector<double>& heights() const { return heights_; }
    [[nodiscard]] double height(Index vertex) const { return places_[vertex].z(); }
    [[nodiscard]] double box_volume() const { return box_volume_; }

    [[nodiscard]] Waterline at(double level) const;
    /// The level at which the pool at `place` overflows: the largest height up to which it is separate from the unbounded region;
    /// none if it is sealed. `level`: a level at which it is known to be separate.
    [[nodiscard]] std::optional<double> overflow(const WetPlace& place, double level) const;
    /// Volume at each side of each piece, by node.
    [[nodiscard]] std::vector<double> side_volumes(const Waterline& line) const;
    /// Size of the pool that consists of the selected nodes (sides of pieces).
    [[nodiscard]] PoolSize size(const Waterline& line, const std::vector<std::uint8_t>& selected) const;

private:
    void trace_loops(Waterline& line) const;
    void join_sides(Waterline& line, std::vector<std::vector<Eigen::Vector2d>> outlines,
                    const std::vector<std::pair<Index, Eigen::Vector2d>>& ends) const;
    void nest_loops(Waterline& line, const std::vector<std::vector<Eigen::Vector2d>>& outlines) const;
    [[nodiscard]] static Index region_at(const Waterline& line, const std::vector<std::vector<Eigen::Vector2d>>& outlines,
                                         const Eigen::Vector2d& place);
    void link_floating(Waterline& line, const std::vector<std::vector<Eigen::Vector2d>>& outlines) const;
    [[nodiscard]] Eigen::Vector2d crossing(Halfedge h, double level) const;
    template <class Visit>
    void clipped_triangles(const Waterline& line, const Visit& visit) const;

    const Mesh& mesh_;
    Eigen::Vector3d up_;
    std::vector<Eigen::Vector3d> places_;  ///< in the frame, relative to the centre of the box (x, y) and the frame (z)
    std::vector<std::array<Index, 3>> corners_;
    std::vector<Index> component_;      ///< for each vertex: root of its component of the mesh
    std::vector<std::uint8_t> closed_;  ///< by root: 1 if the component has no border
    std::vector<Index> tops_;           ///< the topmost vertex of each component
    std::vector<double> heights_;
    double box_volume_ = 0;
};

}  // namespace ostraka::detail
