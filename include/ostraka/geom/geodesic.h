// Exact geodesic distances on a triangle mesh: the lengths of the shortest curves over its faces.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/geom/surface_trace.h"

#include <limits>
#include <optional>
#include <vector>

namespace ostraka {

/// For every vertex the length of the shortest curve over the faces to the nearest of `sources`, in the mesh's unit (Chen and Han
/// 1990 with the filters of Xin and Wang 2009, as CGAL implements them). Infinite where no curve arrives, or only one longer than
/// `limit`. With a limit only the faces within that Euclidean distance of a source are worked on. Where a face without area
/// hinders the exact method, the shortest edge path is given, which is never shorter. Time and memory grow with the square of
/// the number of faces at worst, near n log n in practice: 50,000 faces take seconds and hundreds of megabytes.
/// Throws Error (usage) without sources, for a source that is not a vertex, or for a limit that is negative or not a number.
std::vector<double> geodesic_distances(const Mesh& mesh, const std::vector<Index>& sources,
                                       double limit = std::numeric_limits<double>::infinity());

/// For every vertex the length of the shortest way along edges from vertices that start with the given lengths; infinite where
/// none arrives, or only one longer than `limit`.
std::vector<double> edge_distances(const Mesh& mesh, const std::vector<std::pair<Vertex, double>>& start,
                                   double limit = std::numeric_limits<double>::infinity());

/// The length of the shortest curve over the faces between two places; infinite if none joins them. Only the faces that a curve
/// no longer than the shortest edge path can meet are worked on. Throws Error (usage) for a place that is not on the mesh.
double geodesic_distance(const Mesh& mesh, const SurfaceNode& from, const SurfaceNode& to);

/// The shortest curve over the faces between two places, straight in each face; nothing if none joins them. Where a face without
/// area hinders the exact method, the shortest edge path.
std::optional<SurfaceCurve> geodesic_curve(const Mesh& mesh, const SurfaceNode& from, const SurfaceNode& to);

}  // namespace ostraka
