// Cuts out parts of a mesh for algorithms that are too expensive on the whole mesh.
#pragma once

#include "ostraka/geom/point_tree.h"
#include "ostraka/geom/submesh.h"

#include <functional>
#include <vector>

namespace ostraka {

/// The faces accepted by `inside` that are connected with faces of `start` through vertices of accepted faces, ascending.
std::vector<Index> grow_faces(const Mesh& mesh, const std::vector<Face>& start, const std::function<bool(Face)>& inside);

/// True if the face may contain a point within `limit` of one of `points`. Never false if the face contains such a point.
bool may_hold_near(const Mesh& mesh, Face face, const PointTree& points, double limit);

/// Some faces of a mesh as a separate mesh, translated so that `origin` is at the origin and scaled by a power of two to a size
/// of about one. A vertex at which the faces form several fans is duplicated for each fan.
struct SurfacePatch : SubMesh {
    double scale = 1;  ///< length in the whole mesh = scale * length in the patch
};
/// Cuts out the listed faces as a separate mesh, translated and scaled.
SurfacePatch cut_out(const Mesh& mesh, std::vector<Index> faces, const Point& origin);

}  // namespace ostraka
