// Annotations of a mesh that is moved, or converted to another unit.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/geom/rigid_fit.h"

#include <string>

namespace ostraka {

/// The unit in which lengths given in `unit` are expressed after multiplication by `scale`: "mm" and 0.001 give "m". `unit`
/// itself for a scale of 1; empty if no known unit matches (to 1 %).
std::string unit_scaled(const std::string& unit, double scale);

/// Annotations after a motion of the mesh. Directions (upward direction, directions of bounding measures) follow the mesh; the
/// unit of the coordinates becomes `unit`, also for measures and computed descriptors (not for descriptors entered manually).
/// After a motion that mirrors, the annotations fit a mesh in which the second and the third corner of each face are exchanged
/// (move_triangles): curves through faces are adapted, outlines keep the interior to the left. Statistics of thickness and
/// curvature are scaled; other values are not recomputed (`refresh_measures` recomputes them). Descriptors whose file no longer
/// fits are marked stale: axes, and maps of lengths whose values no longer agree with the mesh.
AnnotationSet moved_annotations(AnnotatedMeshView object, const Motion& motion, const std::string& unit);

}  // namespace ostraka
