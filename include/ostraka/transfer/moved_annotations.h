// Annotations of a mesh that is moved or brought to another unit.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/geom/rigid_fit.h"

#include <string>

namespace ostraka {

/// The unit of length in which what was `unit` has `scale` times its number: "mm" and 0.001 give "m". The same for a scale of 1;
/// empty where no unit is known that differs so (to 1 %).
std::string unit_scaled(const std::string& unit, double scale);

/// Directions (up, those of bounding measures) turn with the mesh; `unit` is that of its coordinates then, and so of measures and
/// of descriptors that are computed from it (not of those that people typed in). Values are left for `refresh_measures`.
AnnotationSet moved_annotations(const Mesh& mesh, const AnnotationSet& set, const Motion& motion, const std::string& unit);

}  // namespace ostraka
