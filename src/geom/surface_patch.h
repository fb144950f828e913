// Parts of a mesh cut out for algorithms that are too expensive on the whole mesh.
#pragma once

#include "ostraka/geom/point_tree.h"
#include "ostraka/geom/submesh.h"

#include <functional>
#include <vector>

namespace ostraka {

/// The faces accepted by `inside` that are connected with faces of `start` through vertices of accepted faces, ascending.
std::vector<Index> grow_faces(const Mesh& mesh, const std::vector<Face>& start, const std::function<bool(Face)>& inside);

/// Conservative test whether a face may contain a point within `limit` of one of the points; false negatives do not occur.
bool may_hold_near(const Mesh& mesh, Face face, const PointTree& points, double limit);

/// A subset of the faces as a separate mesh, translated by `origin` and scaled by a power of two to a size of about one. A
/// vertex at which the faces form several fans is duplicated for each fan.
struct SurfacePatch : SubMesh {
    double scale = 1;  ///< length in the whole mesh = scale * length in the patch
};
SurfacePatch cut_out(const Mesh& mesh, std::vector<Index> faces, const Point& origin);

}  // namespace ostraka
