// The region enclosed by closed curves on the surface, computed without adding vertices.
#pragma once

#include "ostraka/geom/surface_trace.h"
#include "ostraka/mesh/mesh.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace ostraka {

/// Position of a face relative to a region.
enum class FaceSide : std::uint8_t { out, in, cut };

struct CurveFilling {
    std::vector<FaceSide> sides;                ///< one per face
    std::vector<std::pair<Index, double>> cut;  ///< the faces cut by curves, ascending, with the fraction of their area inside
    double border = 0;                          ///< length of the mesh border inside the region
    /// Number of contradictions between curves: faces to the left of one and to the right of another, crossings.
    std::size_t conflicts = 0;

    /// Area of the region.
    [[nodiscard]] double area(const Mesh& mesh) const;
    /// Faces with at least half of their area inside, ascending.
    [[nodiscard]] std::vector<Index> majority() const;
};

/// The region to the left of the curves, plus the connected components of the faces in `seeds`. Each curve is closed (its last
/// node is its first) or ends at the border of the mesh. A face whose edges, but not whose interior, the curves traverse is in
/// or out. O(n) for the flags; O(k) for the k pieces of the curves, except for faces that several stretches of curves traverse,
/// which cost O(k log k).
CurveFilling fill_curves(const Mesh& mesh, const std::vector<SurfaceCurve>& curves, const std::vector<Index>& seeds = {});

/// Classifies points in cut faces as inside or outside.
class CutFaces {
public:
    /// Triangulates the faces that the filling marks as cut, and classifies the triangles.
    CutFaces(const Mesh& mesh, const std::vector<SurfaceCurve>& curves, const CurveFilling& filling);
    /// Whether a point of a cut face is inside.
    [[nodiscard]] bool inside(Index face, const Point& place) const;

private:
    struct Piece {
        std::array<Point, 3> corners;
        bool inside;
    };
    std::vector<Index> faces_;        ///< ascending
    std::vector<std::size_t> first_;  ///< first piece of each face, and the total number
    std::vector<Piece> pieces_;
};

}  // namespace ostraka
