// Annotations of a mesh that is moved or converted to another unit.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/geom/rigid_fit.h"

#include <string>

namespace ostraka {

/// The unit of length in which values in `unit` are multiplied by `scale`: "mm" and 0.001 give "m". Unchanged for a scale of 1;
/// empty if no known unit matches (to 1 %).
std::string unit_scaled(const std::string& unit, double scale);

/// Rotates directions (up, those of bounding measures) with the mesh and sets the unit of the coordinates after the motion,
/// `unit`, also for measures and computed descriptors (not for those entered manually). Values are not recomputed;
/// `refresh_measures` does that.
AnnotationSet moved_annotations(AnnotatedMeshView object, const Motion& motion, const std::string& unit);

}  // namespace ostraka
