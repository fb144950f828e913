// Parts of a mesh cut out for work that is too costly on all of it.
#pragma once

#include "ostraka/geom/point_tree.h"
#include "ostraka/geom/submesh.h"

#include <functional>
#include <vector>

namespace ostraka {

/// The faces that `inside` accepts and that are joined with those of `start` over vertices of accepted faces, ascending.
std::vector<Index> grow_faces(const Mesh& mesh, const std::vector<Face>& start, const std::function<bool(Face)>& inside);

/// Whether a face may hold a point within `limit` of one of the points: never wrongly no.
bool may_hold_near(const Mesh& mesh, Face face, const PointTree& points, double limit);

/// Some faces of a mesh as a mesh of its own, moved to `origin` and scaled by a power of two so that it measures about one.
/// A vertex at which the faces form several fans is there once for each.
struct SurfacePatch : SubMesh {
    double scale = 1;  ///< length in the whole mesh = scale times length in the patch
};
SurfacePatch cut_out(const Mesh& mesh, std::vector<Index> faces, const Point& origin);

}  // namespace ostraka
