// Transfer of annotations along the edges of the target.
#pragma once

#include "transfer/path_tracer.h"
#include "transfer/region_transfer.h"

#include <optional>
#include <vector>

namespace ostraka {

/// Appends a remark to a note.
void add_note(std::string& note, const std::string& text);

/// An annotation that is being transferred to the target.
struct MovedAnnotation {
    const Annotation* from;  ///< annotation of the source
    Annotation to;           ///< annotation of the target
    TransferScore score;     ///< accuracy of the transfer
    bool by_curves = false;  ///< true: the annotation is projected by its curves
};

/// Transfers points to vertices; poly-lines and outlines become edge paths between corresponding vertices (thesis, Algorithm 1),
/// or edges inserted into the target; regions are filled from their outlines. The arguments must outlive this object.
class EdgeTransfer {
public:
    EdgeTransfer(AnnotatedMeshView source, const SurfaceSearch& target, const TransferOptions& options, PathTracer& tracer);

    /// The source vertices whose correspondences the tracer must know before `trace`.
    [[nodiscard]] std::vector<Index> vertices() const;
    /// Computes paths and points on the target; with options.refine, also the refined mesh.
    void trace();
    /// Computes the regions from their outlines on the target.
    void fill();

    /// The annotations being transferred, one for each annotation of the set.
    [[nodiscard]] std::vector<MovedAnnotation>& moved() { return moved_; }
    /// The refined target; empty without options.refine.
    [[nodiscard]] std::optional<InsertedCurves>& refined() { return refined_; }
    /// The mesh to which the annotations are transferred: the target, or the refined target.
    [[nodiscard]] const Mesh& mesh() const { return refined_ ? refined_->mesh : target_; }
    [[nodiscard]] RegionTransfer& regions() { return regions_; }  ///< computes the faces of regions

private:
    void begin(std::size_t i);  ///< starts the transfer of annotation i
    void trace(std::size_t i);  ///< traces the paths of annotation i
    void insert();              ///< inserts the traced curves into the target
    /// The path along the curves inserted into the target.
    [[nodiscard]] TracedPath walked(const SourcePath& vertex_path, const std::vector<PathTracer::Step>& steps,
                                    PathSearch& paths) const;
    void finish_line(std::size_t i);                                       ///< completes a transferred line
    void finish_region(std::size_t i, const std::vector<bool>& selected);  ///< completes a transferred region
    template <class Body>
    void for_each_annotation(const Body& body) const;

    const AnnotatedMeshView source_;
    const SurfaceSearch& search_;
    const Mesh& target_;
    const TransferOptions& options_;
    PathTracer& tracer_;
    RegionTransfer regions_;
    std::vector<std::vector<SourcePath>> vertex_paths_;  ///< for each annotation, its paths on the source
    std::vector<std::vector<TracedPath>> traced_;        ///< for each annotation, its paths on the target
    std::vector<MovedAnnotation> moved_;
    std::optional<InsertedCurves> refined_;
};

}  // namespace ostraka
