// Curves on a mesh that are straight in each face, and tracing of plane sections from face to face.
#pragma once

#include "ostraka/geom/surface_point.h"
#include "ostraka/mesh/mesh.h"

#include <optional>
#include <vector>

namespace ostraka {

/// A curve on the surface of a mesh: each straight piece from points[i] to points[i + 1] lies in one face.
struct SurfaceCurve {
    std::vector<SurfacePoint> points;  ///< ends of the straight pieces, in order
    /// For each piece: index of the face that contains it (either face for a piece along an edge).
    std::vector<Index> faces;
    [[nodiscard]] double length(const Mesh& mesh) const;  ///< total length of the pieces
};

/// The curve through points; each two consecutive points must lie in a common face. Throws Error (input) if a point does not fit
/// the mesh (`check_surface_point`) or if consecutive points have no common face.
SurfaceCurve curve_through(const Mesh& mesh, const std::vector<SurfacePoint>& points);

/// Traces the intersection of the surface with the plane through both points and the direction `up` (for example the mean surface
/// normal) from `from` to `to`. The result is nullopt if the trace reaches the border, does not reach `to`, or becomes longer
/// than `limit`. Time: linear in the number of faces crossed.
std::optional<SurfaceCurve> trace_line(const Mesh& mesh, const SurfacePoint& from, const SurfacePoint& to, const Vector& up,
                                       double limit);

}  // namespace ostraka
