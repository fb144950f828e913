// Transfer of annotations along the edges of the target.
#pragma once

#include "transfer/path_tracer.h"
#include "transfer/region_transfer.h"

#include <optional>
#include <vector>

namespace ostraka {

/// Appends a remark to a note.
void add_note(std::string& note, const std::string& text);

/// An annotation on its way to the target.
struct MovedAnnotation {
    const Annotation* from;
    Annotation to;
    TransferScore score;
    bool by_curves = false;  ///< projected by its curves
};

/// Points go to vertices; poly-lines and outlines become edge paths between corresponding vertices (thesis, Algorithm 1), or
/// edges inserted into the target; regions are filled from their outlines. The arguments must outlive this object.
class EdgeTransfer {
public:
    EdgeTransfer(AnnotatedMeshView source, const SurfaceSearch& target, const TransferOptions& options, PathTracer& tracer);

    /// The vertices whose correspondences the tracer must know before `trace`.
    [[nodiscard]] std::vector<Index> vertices() const;
    /// Computes paths and points; with options.refine, the refined mesh.
    void trace();
    /// Computes the regions from their outlines.
    void fill();

    /// One for each annotation of the set.
    [[nodiscard]] std::vector<MovedAnnotation>& moved() { return moved_; }
    [[nodiscard]] std::optional<InsertedCurves>& refined() { return refined_; }
    /// The target, or the refined mesh.
    [[nodiscard]] const Mesh& mesh() const { return refined_ ? refined_->mesh : target_; }
    [[nodiscard]] RegionTransfer& regions() { return regions_; }

private:
    void begin(std::size_t i);
    void trace(std::size_t i);
    void insert();
    [[nodiscard]] TracedPath walked(const SourcePath& vertex_path, const std::vector<PathTracer::Step>& steps,
                                    PathSearch& paths) const;
    void finish_line(std::size_t i);
    void finish_region(std::size_t i, const std::vector<bool>& selected);
    template <class Body>
    void for_each_annotation(const Body& body) const;

    const AnnotatedMeshView source_;
    const SurfaceSearch& search_;
    const Mesh& target_;
    const TransferOptions& options_;
    PathTracer& tracer_;
    RegionTransfer regions_;
    std::vector<std::vector<SourcePath>> vertex_paths_;  ///< by annotation
    std::vector<std::vector<TracedPath>> traced_;        ///< by annotation
    std::vector<MovedAnnotation> moved_;
    std::optional<InsertedCurves> refined_;
};

}  // namespace ostraka
