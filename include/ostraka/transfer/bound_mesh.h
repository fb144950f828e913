// Changes the resolution of a mesh while its annotations, colours, labels and texture are preserved.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/annotation/annotation_maps.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/remesh/refine.h"
#include "ostraka/remesh/simplify.h"

#include <memory>
#include <optional>

namespace ostraka {

/// A mesh with its annotations, colours, labels, texture and values. Each call of `simplify` and `refine` updates these data;
/// both may be called repeatedly. Seams of the texture are simplified along their curves, and the texture coordinates of
/// corners are interpolated on the surface.
class BoundMesh {
public:
    /// `annotated`: annotations of the mesh; empty: none.
    explicit BoundMesh(MeshFile file, std::optional<AnnotationSet> annotated = {});

    /// Simplifies the mesh. Outlines of regions, poly-lines and points are marked as parts to be preserved; with
    /// `options.outlines` = protect, the pins of measures are marked as well, and so is the border if a region covers the whole
    /// mesh. Throws the same errors as ostraka::simplify.
    SimplifyResult simplify(const SimplifyOptions& options);
    /// Refines the mesh. A new vertex gets the mean of the colours and values of the two vertices between which it was
    /// inserted, and the label of one of them; a new corner gets the mean of the texture coordinates. Throws the same errors as
    /// ostraka::refine.
    RefineResult refine(const RefineOptions& options);

    /// Current state of the mesh and its data. Measures and known descriptors of the annotations are recomputed after each step.
    Mesh mesh;
    MeshExtras extras;                         ///< colours, labels, texture and values
    std::optional<AnnotationSet> annotations;  ///< annotations of the mesh; empty: none
    std::vector<std::string> notes;            ///< messages about data that could not be preserved

    /// Size of the mesh.
    struct Totals {
        std::size_t vertices = 0, faces = 0;
        double area = 0;  ///< surface area
    };
    /// Size of the mesh at construction, and now.
    Totals before, after;

    /// Size of an annotation.
    struct Size {
        std::size_t elements = 0;     ///< number of faces, segments or points
        double area = 0, length = 0;  ///< length: perimeter of a region, or length of a line
    };
    /// Change of an annotation since construction.
    struct Change {
        int id = 0;                                    ///< id of the annotation
        std::string tag;                               ///< tag of the annotation
        AnnotationType type = AnnotationType::region;  ///< type at construction
        Size before, after;                            ///< size at construction, and now
        bool degenerate = false;  ///< true: the annotation has another type now, for example because a region lost all its faces
        std::string note;         ///< "lost", or a description of the change; empty: no remark
    };
    std::vector<Change> changes;  ///< one entry per annotation, in the order at construction

private:
    /// Stores a copy of the mesh and the annotations before a step, if some annotations are free.
    void keep_curved();
    /// Stores the annotations in property maps of the mesh, so that they are preserved when the mesh changes.
    AnnotationTable attach();
    /// Reads back the annotations attached by `attach`; `vertex_map`: for each vertex of the mesh when `attach` was called, its
    /// current vertex.
    void detach(const AnnotationTable& table, const std::vector<Index>& vertex_map);
    /// The elements that simplification has to preserve. `protects`: true to mark the pins of measures as well, and the border
    /// if a region is the whole mesh.
    [[nodiscard]] MarkedParts marked(const AnnotationTable& table, bool protects) const;
    [[nodiscard]] Size size_of(const Annotation& annotation) const;  ///< current size of an annotation

    /// The object before a step, kept if some annotations are free: their curves are projected onto the resulting mesh.
    std::shared_ptr<const AnnotatedMesh> curved_;
};

}  // namespace ostraka
