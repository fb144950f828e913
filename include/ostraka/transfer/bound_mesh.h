// A mesh together with what is bound to it - annotations, colours, labels - while its resolution changes.
#pragma once

#include "ostraka/annotation/annotation_maps.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/remesh/refine.h"
#include "ostraka/remesh/simplify.h"

#include <memory>
#include <optional>

namespace ostraka {

/// Everything bound to the mesh follows each call of `simplify` and `refine`, of which there may be several. Texture coordinates
/// per corner are not carried, which the notes say.
class BoundMesh {
public:
    /// `annotated`: annotations of the mesh, if it has any.
    explicit BoundMesh(MeshFile file, std::optional<AnnotationSet> annotated = {});

    /// Outlines of regions, poly-lines and points are marked as what means something, and with `options.outlines` protect the
    /// pins of measures too. Throws as ostraka::simplify.
    SimplifyResult simplify(const SimplifyOptions& options);
    /// New vertices get the mean of the colours and texture coordinates of the two they lie between, and the label of one. Throws
    /// as ostraka::refine.
    RefineResult refine(const RefineOptions& options);

    /// As they are now. Measures and known descriptors of the annotations are computed anew after each step.
    Mesh mesh;
    MeshExtras extras;
    std::optional<AnnotationSet> annotations;
    std::vector<std::string> notes;

    struct Totals {
        std::size_t vertices = 0, faces = 0;
        double area = 0;
    };
    /// When it was made, and now.
    Totals before, after;

    struct Size {
        std::size_t elements = 0;     ///< faces, links or points
        double area = 0, length = 0;  ///< length: perimeter of a region, length of a line
    };
    /// What became of an annotation since this was made.
    struct Change {
        int id = 0;
        std::string tag;
        AnnotationType type = AnnotationType::region;  ///< at first
        Size before, after;
        bool degenerate = false;  ///< it is of another type now, as a region without faces is
        std::string note;         ///< "lost", or what had to be done to it
    };
    std::vector<Change> changes;  ///< in the order of the annotations at first

private:
    /// Mesh and annotations before a step, where some are free: their curves are laid on what it leaves.
    struct Curved {
        Mesh mesh;
        AnnotationSet annotations;
    };
    void keep_curved();
    AnnotationTable attach();
    /// Reads back what `attach` bound; `vertex_map` from the mesh as it was then.
    void detach(const AnnotationTable& table, const std::vector<Index>& vertex_map);
    [[nodiscard]] MarkedParts marked(const AnnotationTable& table, bool pins) const;
    [[nodiscard]] Size size_of(const Annotation& annotation) const;

    std::shared_ptr<const Curved> curved_;
};

}  // namespace ostraka
