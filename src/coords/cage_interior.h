// The inside of a cage as tetrahedra.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/geom/surface_search.h"

#include <Eigen/Geometry>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace ostraka::coords {

/// A convex combination of nodes.
struct InteriorPlace {
    std::array<Index, 4> nodes{};
    std::array<double, 4> weights{};
};

/// Tetrahedra that fill a cage and have its vertices and edges among theirs (CGAL's mesher, without optimisation). Lengths are
/// shares of the cage's diagonal, places over its middle.
class CageInterior {
public:
    /// About so many nodes. Throws Error (input), naming the kind of coordinates, for a cage that crosses itself or has no
    /// volume.
    CageInterior(const Mesh& cage, std::size_t nodes, const std::string& kind);
    ~CageInterior();
    CageInterior(const CageInterior&) = delete;
    CageInterior& operator=(const CageInterior&) = delete;

    [[nodiscard]] const std::vector<Eigen::Vector3d>& nodes() const { return nodes_; }
    [[nodiscard]] const std::vector<std::array<Index, 4>>& cells() const { return cells_; }
    /// Of each node: where it lies on the cage; no face for nodes within.
    [[nodiscard]] const std::vector<SurfaceHit>& on_cage() const { return on_cage_; }
    [[nodiscard]] bool is_within(Index node) const { return on_cage_[node].face == no_index; }
    /// The place of a point inside the cage (in these lengths); beside the tetrahedra that of the nearest place in one of them.
    [[nodiscard]] InteriorPlace locate(const Eigen::Vector3d& p) const;

private:
    struct Mesher;
    /// False where the mesher fails.
    static bool fill(const Mesh& cage, double size, Mesher& mesher);
    std::unique_ptr<Mesher> mesher_;
    std::vector<Eigen::Vector3d> nodes_;
    std::vector<std::array<Index, 4>> cells_;
    std::vector<SurfaceHit> on_cage_;
};

/// The cage moved to its middle and scaled to diagonal 1.
struct UnitCage {
    explicit UnitCage(const Mesh& cage);
    [[nodiscard]] Eigen::Vector3d unit(const Point& p) const;
    Mesh mesh;
    std::vector<Eigen::Vector3d> corners;
    Point middle{0, 0, 0};
    double diagonal = 1;
};

}  // namespace ostraka::coords
