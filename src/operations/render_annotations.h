// Annotations as things to draw.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/render/scene.h"

namespace ostraka {

/// Adds colours, lines, dots and legend of the annotations of `mesh` to the scene, and their unit.
void draw_annotations(Scene& scene, const Mesh& mesh, const AnnotationSet& set);

}  // namespace ostraka
