// Exact geodesic distances on a triangle mesh: lengths of the shortest curves across faces.
#pragma once

#include "ostraka/geom/surface_trace.h"
#include "ostraka/mesh/mesh.h"

#include <limits>
#include <optional>
#include <vector>

namespace ostraka {

/// For each vertex, the geodesic distance to the closest of the vertices in `sources`, in the mesh's unit (Chen and Han 1990 with
/// the filters of Xin and Wang 2009, as implemented by CGAL). The distance is infinite if no curve of length up to `limit`
/// reaches the vertex. With a limit, only the faces within this Euclidean distance of a source are processed. Where a degenerate
/// face prevents the exact method, the length of the shortest edge path is returned, which is never smaller than the geodesic
/// distance. Time and memory are quadratic in the number of faces in the worst case, near n log n in practice: 50,000 faces take
/// seconds and hundreds of megabytes. Throws Error (usage) if there is no source, if a source is not a vertex, or if the limit is
/// negative or NaN.
std::vector<double> geodesic_distances(const Mesh& mesh, const std::vector<Index>& sources,
                                       double limit = std::numeric_limits<double>::infinity());

/// For each vertex, the length of the shortest path along edges from a vertex in `start`. Each start vertex has an initial
/// length, which is added to the length of the path; infinite if no path of length up to `limit` reaches the vertex.
std::vector<double> edge_distances(const Mesh& mesh, const std::vector<std::pair<Vertex, double>>& start,
                                   double limit = std::numeric_limits<double>::infinity());

/// Geodesic distance between two points on the surface; infinite if the points are not connected. Only faces that can lie on a
/// curve no longer than the shortest edge path are processed. Throws Error (usage) for a point that is not on the mesh.
double geodesic_distance(const Mesh& mesh, const SurfacePoint& from, const SurfacePoint& to);

/// Shortest curve on the surface between two points, straight in each face; nullopt if the points are not connected. If a
/// degenerate face prevents the exact method, the shortest edge path is returned.
std::optional<SurfaceCurve> geodesic_curve(const Mesh& mesh, const SurfacePoint& from, const SurfacePoint& to);

}  // namespace ostraka
