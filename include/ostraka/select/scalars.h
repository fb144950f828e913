// Selections by a number that each vertex or face has.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"

#include <limits>
#include <string>
#include <vector>

namespace ostraka {

/// One number a vertex or a face; NaN where there is none.
struct ScalarMap {
    std::vector<double> values;
    bool on_faces = false;
};

/// From `above` to `below`, both included.
struct ScalarRange {
    double above = -std::numeric_limits<double>::infinity(), below = std::numeric_limits<double>::infinity();
    [[nodiscard]] bool contains(double x) const { return above <= x && x <= below; }
};

/// The coordinate along a direction, of each vertex. With `share` 0 at the lowest vertex that has a face and 1 at the highest,
/// else in the mesh's unit. Throws Error (input) for a direction without length.
ScalarMap coordinate_map(const Mesh& mesh, const Vector& direction, bool share, const std::string& where);

/// Faces whose value (of a map on vertices: the mean of its corners) lies in the interval.
std::vector<bool> faces_between(const Mesh& mesh, const ScalarMap& map, const ScalarRange& interval);
/// Vertices that have a face and whose value (of a map on faces: the mean around them, weighted by area) lies in the interval.
std::vector<Index> vertices_between(const Mesh& mesh, const ScalarMap& map, const ScalarRange& interval);

/// The value below which the map lies on this share of the area (0 to 1). Throws Error (input) without any value.
double quantile_of(const Mesh& mesh, const ScalarMap& map, double share, const std::string& where);

struct SegmentOptions {
    int clusters = 5;
    double smoothing = 0.26;

    void describe(OptionList& visit);
};

/// Parts of like thickness (Shapira, Shamir and Cohen-Or 2008, as CGAL implements it): the values of `thickness`, one a face, are
/// smoothed over faces, distinguished by a mixture of Gaussians and cut where the surface is hollow (graph cut); connected faces
/// of one level are a segment. Returns the number of each face's segment, 0 for the largest by area. Throws Error (input) where
/// there is no face, and Error (usage) for options out of range or values that are not one a face.
std::vector<Index> segment(const Mesh& mesh, const std::vector<double>& thickness, const SegmentOptions& options = {});

}  // namespace ostraka
