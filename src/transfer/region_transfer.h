// Interior of transferred regions.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "transfer/face_parts.h"
#include "transfer/path_tracer.h"

#include <functional>
#include <mutex>
#include <optional>

namespace ostraka {

/// Approximation (by two sweeps) of the longest of the shortest paths within the edges of a walk: the line that represents a
/// region that shrank to a tree of edges.
std::vector<Index> diameter_path(const std::vector<Index>& walk);

/// The faces within the outlines of a region, and their measures.
struct FilledRegion {
    std::vector<bool> selected;  ///< one flag per face; empty if the outlines vanished
    double area = 0, perimeter = 0;
};

class RegionTransfer {
public:
    RegionTransfer(AnnotatedMeshView source, const SurfaceSearch& target, const TransferOptions& options);

    /// Sets the traced outlines, by annotation, on `mesh`: the target, or the refined target with `origin` giving the old face
    /// of each face. Both must outlive this object.
    void set_outlines(const std::vector<std::vector<TracedPath>>& traced, const Mesh& mesh, const std::vector<Index>* origin);

    /// The faces within the outlines of a region. If the outlines are inconsistent, the score is marked as voted, and `vote`
    /// must be called. Regions may be filled in parallel.
    FilledRegion fill(std::size_t region, TransferScore& score);
    /// Classifies each face by its corresponding place on the source.
    std::vector<bool> vote(std::size_t region);
    /// Includes or excludes the faces that the outlines cross, as the options demand.
    void cover(std::vector<bool>& selected, const std::vector<SourcePath>& vertex_paths, TransferScore& score) const;

    /// Returns a predicate: whether a place on the target lies in the given faces of the mesh.
    [[nodiscard]] std::function<bool(const SurfaceHit&)> membership(const std::vector<Index>& faces) const;

    [[nodiscard]] double target_edge() const { return target_edge_; }

    /// Built at the first call, from any thread.
    const SurfaceSearch& source_search();

private:
    /// The outlines of a region on the target.
    struct Traced {
        std::vector<Halfedge> edges;
        double length = 0;
        std::size_t pieces = 0, vanished = 0;
    };
    [[nodiscard]] Traced edges_of(const std::vector<TracedPath>& paths) const;

    const AnnotatedMeshView source_;
    const SurfaceSearch& search_;
    const TransferOptions& options_;
    double target_edge_;
    const Mesh* mesh_ = nullptr;
    const std::vector<Index>* origin_ = nullptr;
    std::vector<Traced> traced_;  ///< by annotation
    std::optional<FaceParts> parts_;
    std::once_flag source_search_once_;
    std::optional<SurfaceSearch> source_search_;
};

}  // namespace ostraka
