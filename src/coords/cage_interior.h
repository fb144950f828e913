// Tetrahedralisation of the interior of a cage.
#pragma once

#include "ostraka/geom/surface_search.h"
#include "ostraka/mesh/mesh.h"

#include <Eigen/Geometry>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace ostraka::coords {

/// A point inside a cage as a convex combination of the corners of a tetrahedron.
struct InteriorPlace {
    std::array<Index, 4> nodes{};     ///< indices of the corners
    std::array<double, 4> weights{};  ///< one per corner, with sum 1
};

/// Tetrahedra that fill a cage and include the vertices and edges of the cage (CGAL's mesher, without optimisation). In unit
/// coordinates the middle of the cage is the origin and its diagonal is 1.
class CageInterior {
public:
    /// Meshes the cage with approximately `nodes` nodes. Throws Error (input) that names the kind of coordinates for a cage
    /// with self-intersections or without volume.
    CageInterior(const Mesh& cage, std::size_t nodes, const std::string& kind);
    ~CageInterior();
    CageInterior(const CageInterior&) = delete;
    CageInterior& operator=(const CageInterior&) = delete;

    /// Positions in unit coordinates.
    [[nodiscard]] const std::vector<Eigen::Vector3d>& nodes() const { return nodes_; }
    /// Tetrahedra: indices of four nodes.
    [[nodiscard]] const std::vector<std::array<Index, 4>>& cells() const { return cells_; }
    /// For each node: its position on the cage; `face` is no_index for nodes in the interior.
    [[nodiscard]] const std::vector<SurfaceHit>& on_cage() const { return on_cage_; }
    /// True for nodes in the interior.
    [[nodiscard]] bool is_within(Index node) const { return on_cage_[node].face == no_index; }
    /// The tetrahedron and weights of a point inside the cage, in unit coordinates. For a point outside all tetrahedra: the
    /// tetrahedron and weights of the closest position in a tetrahedron.
    [[nodiscard]] InteriorPlace locate(const Eigen::Vector3d& p) const;

private:
    struct Mesher;
    /// Fills the cage with tetrahedra of about this size; returns false if the mesher fails.
    static bool fill(const Mesh& cage, double size, Mesher& mesher);
    std::unique_ptr<Mesher> mesher_;
    std::vector<Eigen::Vector3d> nodes_;
    std::vector<std::array<Index, 4>> cells_;
    std::vector<SurfaceHit> on_cage_;
};

/// A cage in unit coordinates: moved so that the middle of its bounding box is the origin, and scaled to diagonal 1.
struct UnitCage {
    explicit UnitCage(const Mesh& cage);
    /// Converts a point to unit coordinates.
    [[nodiscard]] Eigen::Vector3d unit(const Point& p) const;
    Mesh mesh;                             ///< the cage in unit coordinates
    std::vector<Eigen::Vector3d> corners;  ///< vertices of the cage in unit coordinates
    Point middle{0, 0, 0};                 ///< middle of the bounding box, in input coordinates
    double diagonal = 1;                   ///< diagonal of the bounding box, in input units
};

}  // namespace ostraka::coords
