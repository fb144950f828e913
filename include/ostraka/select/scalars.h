// Selections of faces and vertices by a scalar value.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <limits>
#include <string>
#include <vector>

namespace ostraka {

/// A scalar field on a mesh: one value per vertex or face; NaN where there is no value.
struct ScalarMap {
    std::vector<double> values;  ///< one value per vertex or face
    bool on_faces = false;       ///< true: one value per face; false: one per vertex
};

/// Closed interval from `above` to `below`.
struct ScalarRange {
    /// Lower and upper bound; infinite: no bound.
    double above = -std::numeric_limits<double>::infinity(), below = std::numeric_limits<double>::infinity();
    [[nodiscard]] bool contains(double x) const { return above <= x && x <= below; }
};

/// The coordinate of each vertex along a direction, in the mesh's unit; if `share`, the coordinate is scaled to 0 at the lowest
/// vertex that has a face and 1 at the highest. `where` names the direction in errors. Throws Error (input) for a direction
/// without length.
ScalarMap coordinate_map(const Mesh& mesh, const Vector& direction, bool share, const std::string& where);

/// For each face, whether its value is in the interval; for a map on vertices the value of a face is the mean of its corners.
std::vector<bool> faces_between(const Mesh& mesh, const ScalarMap& map, const ScalarRange& interval);
/// Indices of the vertices that have a face and whose value is in the interval; for a map on faces the value of a vertex is the
/// area-weighted mean of the faces around the vertex.
std::vector<Index> vertices_between(const Mesh& mesh, const ScalarMap& map, const ScalarRange& interval);

/// The quantile of a map by area: the value below which the map lies on the share `share` (0 to 1) of the surface area. Throws
/// Error (input) if the map has no value.
double quantile_of(const Mesh& mesh, const ScalarMap& map, double share, const std::string& where);

struct SegmentOptions {
    int clusters = 5;         ///< number of thickness levels
    double smoothing = 0.26;  ///< preference for short borders in concave places, 0 to 1

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Segments of similar thickness (Shapira, Shamir and Cohen-Or 2008, as CGAL implements the algorithm). `thickness` has one value
/// per face; the values are smoothed over the faces, clustered by a mixture of Gaussians and cut at concave places of the surface
/// (graph cut); connected faces of one cluster form a segment. Returns the segment index of each face; segment 0 has the largest
/// area. Throws Error (input) for a mesh without faces, Error (usage) for options out of range or a wrong number of values.
std::vector<Index> segment(const Mesh& mesh, const std::vector<double>& thickness, const SegmentOptions& options = {});

}  // namespace ostraka
