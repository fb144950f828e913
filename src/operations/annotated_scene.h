// Annotations as drawable elements of a scene.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/render/render.h"

namespace ostraka {

struct AnnotationStyle {
    bool smooth = false;    ///< smooth borders of regions and smooth lines, not along mesh edges
    bool painted = true;    ///< paint the faces of regions; otherwise draw outlines, as in scenes that show values
    bool measures = false;  ///< draw measures with their pins and values
};

/// Adds colours, lines, points, labels and the legend of the annotations to the scene, and the unit. If the scene
/// shows values, regions are drawn as coloured outlines; otherwise their faces are painted, the smallest region on top, and
/// outlines are drawn except where a smaller region covers them.
void draw_annotations(Scene& scene, AnnotatedMeshView object, const AnnotationStyle& style = {});

/// Their up direction in the text form that `render` accepts.
std::string up_words(const AnnotationSet& set);

/// A small picture of an object with its annotations, if any.
Picture thumbnail(const Mesh& mesh, const AnnotationSet* set, const std::string& size);

/// Adds the edges and control points of a cage, drawn without occlusion.
void draw_cage(Scene& scene, const Mesh& cage);

}  // namespace ostraka
