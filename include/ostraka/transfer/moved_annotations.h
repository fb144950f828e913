// Annotations of a mesh that is moved, or converted to another unit.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/geom/rigid_fit.h"

#include <string>

namespace ostraka {

/// The unit in which lengths given in `unit` are expressed after multiplication by `scale`: "mm" and 0.001 give "m". `unit`
/// itself for a scale of 1; empty if no known unit matches (to 1 %).
std::string unit_scaled(const std::string& unit, double scale);

/// Annotations after a motion of the mesh: rotates directions (upward direction, directions of bounding measures) with the mesh
/// and sets the unit of the coordinates to `unit`, also for measures and computed descriptors (not for descriptors entered
/// manually). Values are not recomputed; `refresh_measures` recomputes them.
AnnotationSet moved_annotations(AnnotatedMeshView object, const Motion& motion, const std::string& unit);

}  // namespace ostraka
