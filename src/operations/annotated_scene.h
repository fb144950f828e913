// Annotations as things to draw.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/render/render.h"

namespace ostraka {

struct AnnotationStyle {
    bool smooth = false;    ///< borders of regions and lines without the steps of the mesh
    bool painted = true;    ///< regions are faces in their colours; else outlines, as where the scene shows values
    bool measures = false;  ///< measures with their pins and values
};

/// Adds colours, lines, dots and legend of the annotations of `mesh` to the scene, and their unit. Where the scene shows values,
/// regions are outlines in their colours; else their faces are painted, the smallest on top, and of an outline what no smaller
/// region covers is drawn. Each has a label.
void draw_annotations(Scene& scene, const Mesh& mesh, const AnnotationSet& set, const AnnotationStyle& style = {});

/// Their upward direction as `render` takes it.
std::string up_words(const AnnotationSet& set);

/// A small picture of an object and its annotations, if it has any.
Picture thumbnail(const Mesh& mesh, const AnnotationSet* set, const std::string& size);

/// Adds the edges and control points of a cage, which hide nothing and are not hidden.
void draw_cage(Scene& scene, const Mesh& cage);

}  // namespace ostraka
