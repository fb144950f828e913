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

/// A point in the interior as a convex combination of nodes.
struct InteriorPlace {
    std::array<Index, 4> nodes{};
    std::array<double, 4> weights{};
};

/// Tetrahedra that fill a cage and include its vertices and edges (CGAL's mesher, without optimisation). The cage is moved to
/// the origin by its middle and scaled to diagonal 1.
class CageInterior {
public:
    /// Meshes the cage with approximately `nodes` nodes. Throws Error (input) that names the kind of coordinates for a cage
    /// with self-intersections or without volume.
    CageInterior(const Mesh& cage, std::size_t nodes, const std::string& kind);
    ~CageInterior();
    CageInterior(const CageInterior&) = delete;
    CageInterior& operator=(const CageInterior&) = delete;

    [[nodiscard]] const std::vector<Eigen::Vector3d>& nodes() const { return nodes_; }
    [[nodiscard]] const std::vector<std::array<Index, 4>>& cells() const { return cells_; }
    /// For each node its position on the cage; no face for nodes in the interior.
    [[nodiscard]] const std::vector<SurfaceHit>& on_cage() const { return on_cage_; }
    [[nodiscard]] bool is_within(Index node) const { return on_cage_[node].face == no_index; }
    /// The tetrahedron and weights of a point inside the cage, in unit coordinates. For a point outside all tetrahedra, those
    /// of the closest position in one of them.
    [[nodiscard]] InteriorPlace locate(const Eigen::Vector3d& p) const;

private:
    struct Mesher;
    /// Returns false if the mesher fails.
    static bool fill(const Mesh& cage, double size, Mesher& mesher);
    std::unique_ptr<Mesher> mesher_;
    std::vector<Eigen::Vector3d> nodes_;
    std::vector<std::array<Index, 4>> cells_;
    std::vector<SurfaceHit> on_cage_;
};

/// The cage, moved so that its middle is the origin, and scaled to diagonal 1.
struct UnitCage {
    explicit UnitCage(const Mesh& cage);
    [[nodiscard]] Eigen::Vector3d unit(const Point& p) const;
    Mesh mesh;
    std::vector<Eigen::Vector3d> corners;
    Point middle{0, 0, 0};
    double diagonal = 1;
};

}  // namespace ostraka::coords
