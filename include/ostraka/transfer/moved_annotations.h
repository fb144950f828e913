// Updates annotations when their mesh is moved or converted to another unit.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/geom/rigid_fit.h"

#include <string>

namespace ostraka {

/// The unit of lengths that were given in `unit` and then multiplied by `scale`: "mm" and 0.001 give "m". The result is `unit`
/// for a scale of 1, and empty if no known unit matches (to 1 %).
std::string unit_scaled(const std::string& unit, double scale);

/// Annotations after a motion of the mesh. Directions (the upward direction, directions of bounding measures) are rotated with
/// the mesh; the unit of the coordinates becomes `unit`, also for measures and computed descriptors (not for descriptors
/// entered manually). If the motion includes a reflection, the result belongs to a mesh in which the second and the third
/// corner of each face are exchanged (move_triangles): curves through faces are adapted, and outlines still have the interior
/// to the left. Statistics of thickness and curvature are scaled; other values are not recomputed (`refresh_measures`
/// recomputes them). Descriptors stored in files that the motion makes invalid are marked stale: axes, and maps of lengths.
AnnotationSet moved_annotations(AnnotatedMeshView object, const Motion& motion, const std::string& unit);

/// The object with its faces turned over (`turned_over` of the mesh): vertices and faces keep their indices, curves through faces
/// are adapted, and outlines still have the interior to the left.
AnnotatedMesh turned_over(AnnotatedMeshView object);

}  // namespace ostraka
