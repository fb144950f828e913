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

/// The region enclosed by curves: classification of all faces.
struct CurveFilling {
    std::vector<FaceSide> sides;  ///< for each face: its position relative to the region
    /// For each face cut by curves, ascending: index, and fraction of its area inside the region.
    std::vector<std::pair<Index, double>> cut;
    double border = 0;  ///< length of the mesh border inside the region
    /// Number of contradictions between curves: faces that lie to the left of one curve and to the right of another, plus
    /// crossings of curves.
    std::size_t conflicts = 0;

    /// Area of the region.
    [[nodiscard]] double area(const Mesh& mesh) const;
    /// Faces with at least half of their area inside, ascending.
    [[nodiscard]] std::vector<Index> majority() const;
};

/// Computes the region to the left of the curves, plus the connected components that contain a face of `seeds`. Each curve is
/// closed (its last node is its first) or ends at the border of the mesh. If curves run along edges of a face but not through
/// its interior, the face is `in` or `out`. Time: O(n + k) for n faces and k segments of curves, or O(n + k log k) if several
/// stretches of curves traverse the same faces.
CurveFilling fill_curves(const Mesh& mesh, const std::vector<SurfaceCurve>& curves, const std::vector<Index>& seeds = {});

/// Classifies points in cut faces as inside or outside.
class CutFaces {
public:
    /// Triangulates the faces that the filling marks as cut, and classifies the triangles.
    CutFaces(const Mesh& mesh, const std::vector<SurfaceCurve>& curves, const CurveFilling& filling);
    /// True if the point `place` of a cut face lies inside the region.
    [[nodiscard]] bool inside(Index face, const Point& place) const;

private:
    struct Piece {
        std::array<Point, 3> corners;
        bool inside;  ///< true: inside the region
    };
    std::vector<Index> faces_;  ///< indices of the cut faces, ascending
    /// For each entry of `faces_`: index of its first piece; one more entry for the end.
    std::vector<std::size_t> first_;
    std::vector<Piece> pieces_;
};

}  // namespace ostraka
