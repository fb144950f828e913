// Computes the interior of transferred regions.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "transfer/face_parts.h"
#include "transfer/path_tracer.h"

#include <functional>
#include <mutex>
#include <optional>

namespace ostraka {

/// The line that represents a region that shrank to a tree of edges: an approximation (by two sweeps) of the longest shortest
/// path between two vertices within the edges of `walk`.
std::vector<Index> diameter_path(const std::vector<Index>& walk);

/// The faces within the outlines of a region, and their total area and perimeter.
struct FilledRegion {
    std::vector<bool> selected;  ///< for each face, whether it is in the region; empty if the outlines vanished
    double area = 0, perimeter = 0;
};

/// Computes the faces of the target that belong to each region.
class RegionTransfer {
public:
    RegionTransfer(AnnotatedMeshView source, const SurfaceSearch& target, const TransferOptions& options);

    /// Sets the traced outlines (for each annotation, its paths) on `mesh`: the target, or the refined target with `origin`, for
    /// each face its old face. Mesh and `origin` must outlive this object.
    void set_outlines(const std::vector<std::vector<TracedPath>>& traced, const Mesh& mesh, const std::vector<Index>* origin);

    /// The faces within the outlines of a region. If the outlines are inconsistent, the score is marked as `voted`, and `vote`
    /// must be called. Regions may be filled in parallel.
    FilledRegion fill(std::size_t region, TransferScore& score);
    /// The faces of a region, determined for each face by its corresponding place on the source.
    std::vector<bool> vote(std::size_t region);
    /// Includes or excludes the faces that the outlines cross, as the option `cover` demands.
    void cover(std::vector<bool>& selected, const std::vector<SourcePath>& vertex_paths, TransferScore& score) const;

    /// Returns a function that is true for places on the target in these faces.
    [[nodiscard]] std::function<bool(const SurfaceHit&)> membership(const std::vector<Index>& faces) const;

    [[nodiscard]] double target_edge() const { return target_edge_; }  ///< typical edge length of the target

    /// Search tree of the source, built at the first call, from any thread.
    const SurfaceSearch& source_search();

private:
    /// The outlines of a region on the target.
    struct Traced {
        std::vector<Halfedge> edges;           ///< halfedges of the outline, with the region to the left
        double length = 0;                     ///< total length of the outline
        std::size_t pieces = 0, vanished = 0;  ///< number of connected pieces of the outline, and number of those that vanished
    };
    [[nodiscard]] Traced edges_of(const std::vector<TracedPath>& paths) const;  ///< outline edges of the traced paths

    const AnnotatedMeshView source_;
    const SurfaceSearch& search_;
    const TransferOptions& options_;
    double target_edge_;
    const Mesh* mesh_ = nullptr;
    /// For each face of the refined target, its face of the target; null: not refined.
    const std::vector<Index>* origin_ = nullptr;
    std::vector<Traced> traced_;  ///< for each annotation, its outlines on the target
    std::optional<FaceParts> parts_;
    std::once_flag source_search_once_;
    std::optional<SurfaceSearch> source_search_;
};

}  // namespace ostraka
