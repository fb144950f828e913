// Selections by a scalar value per vertex or face.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <limits>
#include <string>
#include <vector>

namespace ostraka {

/// One value per vertex or face; NaN where there is none.
struct ScalarMap {
    std::vector<double> values;
    bool on_faces = false;
};

/// Closed interval from `above` to `below`.
struct ScalarRange {
    double above = -std::numeric_limits<double>::infinity(), below = std::numeric_limits<double>::infinity();
    [[nodiscard]] bool contains(double x) const { return above <= x && x <= below; }
};

/// The coordinate of each vertex along a direction, in the mesh's unit; if `share`, scaled to 0 at the lowest vertex that has a
/// face and 1 at the highest. Throws Error (input) for a direction without length.
ScalarMap coordinate_map(const Mesh& mesh, const Vector& direction, bool share, const std::string& where);

/// Faces whose value is in the interval; for a map on vertices the value of a face is the mean of its corners.
std::vector<bool> faces_between(const Mesh& mesh, const ScalarMap& map, const ScalarRange& interval);
/// Vertices that have a face and whose value is in the interval; for a map on faces the value of a vertex is the area-weighted
/// mean of the faces around it.
std::vector<Index> vertices_between(const Mesh& mesh, const ScalarMap& map, const ScalarRange& interval);

/// The quantile of a map: the value below which the map lies on this share (0 to 1) of the area. Throws Error (input) if the
/// map has no value.
double quantile_of(const Mesh& mesh, const ScalarMap& map, double share, const std::string& where);

struct SegmentOptions {
    int clusters = 5;
    double smoothing = 0.26;

    void describe(OptionList& visit);
};

/// Segments of similar thickness (Shapira, Shamir and Cohen-Or 2008, as CGAL implements it). The values of `thickness`, one per
/// face, are smoothed over the faces, clustered by a mixture of Gaussians and cut at concave places of the surface (graph cut);
/// connected faces of one cluster form a segment. Returns the segment index of each face; 0 is the segment of largest area.
/// Throws Error (input) for a mesh without faces, Error (usage) for options out of range or a wrong number of values.
std::vector<Index> segment(const Mesh& mesh, const std::vector<double>& thickness, const SegmentOptions& options = {});

}  // namespace ostraka
