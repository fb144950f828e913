// What closed curves over the surface enclose, without a vertex added.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/geom/surface_trace.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace ostraka {

/// Where a face is with regard to a region.
enum class FaceSide : std::uint8_t { out, in, cut };

struct CurveFilling {
    std::vector<FaceSide> sides;                ///< one per face
    std::vector<std::pair<Index, double>> cut;  ///< the faces that are cut, ascending: the share of their area inside
    double border = 0;                          ///< length of the mesh's border inside
    /// Places at which the curves contradict each other: faces to the left of one and to the right of another, crossings.
    std::size_t conflicts = 0;

    /// The area inside.
    [[nodiscard]] double area(const Mesh& mesh) const;
    /// The faces of which at least half is inside, ascending.
    [[nodiscard]] std::vector<Index> majority() const;
};

/// The region to the left of the curves, and the whole components of the faces in `seeds`. Each curve is closed (its last node is
/// its first) or ends at the border of the mesh. A face that curves only run along the edges of is in or out. O(n) for the
/// flags; O(k) for the k pieces of the curves but for faces that several stretches of curves run through, O(k log k) for these.
CurveFilling fill_curves(const Mesh& mesh, const std::vector<SurfaceCurve>& curves, const std::vector<Index>& seeds = {});

/// Tells inside from outside at places within cut faces.
class CutFaces {
public:
    /// Faces that the filling says are cut, each as triangles with their side.
    CutFaces(const Mesh& mesh, const std::vector<SurfaceCurve>& curves, const CurveFilling& filling);
    /// Whether a place of a cut face is inside.
    [[nodiscard]] bool inside(Index face, const Point& place) const;

private:
    struct Piece {
        std::array<Point, 3> corners;
        bool inside;
    };
    std::vector<Index> faces_;        ///< ascending
    std::vector<std::size_t> first_;  ///< of the pieces of each face, and the end
    std::vector<Piece> pieces_;
};

}  // namespace ostraka
