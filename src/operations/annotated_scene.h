// Annotations as things to draw.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/render/scene.h"

namespace ostraka {

/// Adds colours, lines, dots and legend of the annotations of `mesh` to the scene, and their unit. Where the scene shows values,
/// regions are outlines in their colours; else their faces are painted, the smallest on top, and of an outline what no smaller
/// region covers is drawn.
void draw_annotations(Scene& scene, const Mesh& mesh, const AnnotationSet& set);

}  // namespace ostraka
