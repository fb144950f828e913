// Annotations as things to draw.
#pragma once

#include "ostraka/core/file.h"
#include "ostraka/render/render.h"

namespace ostraka::app {

/// Reads the annotations of `mesh` and adds their colours, lines, dots and legend to the scene; takes the unit and, unless
/// the options say otherwise, the upward axis from the file.
void add_annotations(Scene& scene, RenderOptions& options, const Mesh& mesh, const Path& file);

}  // namespace ostraka::app
