// A mesh with its annotations, colours and labels, which are preserved when its resolution changes.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/annotation/annotation_maps.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/remesh/refine.h"
#include "ostraka/remesh/simplify.h"

#include <memory>
#include <optional>

namespace ostraka {

/// All data of the mesh are updated by each call of `simplify` and `refine`, which may be called repeatedly. Per-corner texture
/// coordinates are dropped; a note reports it.
class BoundMesh {
public:
    /// `annotated`: annotations of the mesh, if any.
    explicit BoundMesh(MeshFile file, std::optional<AnnotationSet> annotated = {});

    /// Simplifies the mesh. Outlines of regions, poly-lines and points are marked as meaningful parts; with `options.outlines`
    /// = protect, the pins of measures as well. Throws as ostraka::simplify does.
    SimplifyResult simplify(const SimplifyOptions& options);
    /// Refines the mesh. New vertices get the mean of the colours and texture coordinates of the two vertices that they lie
    /// between, and the label of one of them. Throws as ostraka::refine does.
    RefineResult refine(const RefineOptions& options);

    /// Current state. Measures and known descriptors of the annotations are recomputed after each step.
    Mesh mesh;
    MeshExtras extras;
    std::optional<AnnotationSet> annotations;
    std::vector<std::string> notes;

    struct Totals {
        std::size_t vertices = 0, faces = 0;
        double area = 0;
    };
    /// At construction, and now.
    Totals before, after;

    struct Size {
        std::size_t elements = 0;     ///< number of faces, segments or points
        double area = 0, length = 0;  ///< length: perimeter of a region, length of a line
    };
    /// Change of an annotation since construction.
    struct Change {
        int id = 0;
        std::string tag;
        AnnotationType type = AnnotationType::region;  ///< at construction
        Size before, after;
        bool degenerate = false;  ///< it has another type now, for example because a region lost all its faces
        std::string note;         ///< "lost", or a description of the change
    };
    std::vector<Change> changes;  ///< in the order of the annotations at construction

private:
    void keep_curved();
    AnnotationTable attach();
    /// Reads back the annotations attached by `attach`; `vertex_map` maps the vertices of the mesh at that time.
    void detach(const AnnotationTable& table, const std::vector<Index>& vertex_map);
    [[nodiscard]] MarkedParts marked(const AnnotationTable& table, bool pins) const;
    [[nodiscard]] Size size_of(const Annotation& annotation) const;

    /// The object before a step, kept if some annotations are free: their curves are projected onto the resulting mesh.
    std::shared_ptr<const AnnotatedMesh> curved_;
};

}  // namespace ostraka
