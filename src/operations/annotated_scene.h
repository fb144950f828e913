// Annotations as drawable elements of a scene.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/render/render.h"

namespace ostraka {

struct AnnotationStyle {
    bool smooth = false;    ///< draw smoothed borders of regions and smoothed lines; false: draw them along mesh edges
    bool painted = true;    ///< fill the faces of regions with colour; false: draw outlines only, as in scenes that show values
    bool measures = false;  ///< draw measures with their end points and values
};

/// Adds colours, lines, points, labels, the legend and the unit of the annotations to the scene. If the scene shows
/// values, regions are drawn as coloured outlines; otherwise the faces of regions are painted, the smallest region on top, and
/// outlines are drawn except where a smaller region covers them.
void draw_annotations(Scene& scene, AnnotatedMeshView object, const AnnotationStyle& style = {});

/// Upward direction stated in the annotations, in the text form that `render` accepts.
std::string up_words(const AnnotationSet& set);

/// A small picture of an object with its texture or colours, on which annotations are drawn as outlines; without them, regions
/// are painted. `set`: annotations to draw, or null; `size`: "WIDTHxHEIGHT" in pixels.
Picture thumbnail(const Mesh& mesh, const AnnotationSet* set, const MeshExtras& extras, const std::string& size);

/// Adds the edges and control points of a cage to the scene; they are drawn even where the object hides them.
void draw_cage(Scene& scene, const Mesh& cage);

}  // namespace ostraka
