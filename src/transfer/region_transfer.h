// The interior of a transferred region.
#pragma once

#include "face_parts.h"
#include "ostraka/annotation/annotation.h"
#include "path_tracer.h"

#include <functional>
#include <mutex>
#include <optional>

namespace ostraka {

/// The outlines of a region as paths. Where an outline runs along the border of an open mesh it is cut: the border of the
/// target bounds the region there.
std::vector<SourcePath> region_paths(const Mesh& mesh, const std::vector<Index>& faces);

/// The longest of the shortest paths within the edges of a walk, approximately (two sweeps): what a region that shrank to a
/// tree of edges leaves as a line.
std::vector<Index> diameter_path(const std::vector<Index>& walk);

/// What lies within the outlines of a region, and its measures.
struct FilledRegion {
    std::vector<bool> selected;  ///< a flag per face; no flags if the outlines vanished
    double area = 0, perimeter = 0;
};

class RegionTransfer {
public:
    RegionTransfer(const Mesh& source, const AnnotationSet& set, const SurfaceSearch& target, const TransferOptions& options);

    /// Takes the outlines as traced, by annotation, on `mesh`: the target, or the target refined with `origin` giving each face's
    /// old one. Both outlive this.
    void set_outlines(const std::vector<std::vector<TracedPath>>& traced, const Mesh& mesh, const std::vector<Index>* origin);

    /// What lies within a region's outlines. Where these make no sense, the score is marked as voted: then a vote must follow.
    /// Regions may be filled side by side.
    FilledRegion fill(std::size_t region, TransferScore& score);
    /// Each face asked for its place on the source.
    std::vector<bool> vote(std::size_t region);
    /// The faces that the outlines run through taken in, or left out, as the options say.
    void cover(std::vector<bool>& selected, const std::vector<SourcePath>& vertex_paths, TransferScore& score) const;

    /// Whether a place on the target lies in some faces of the mesh.
    [[nodiscard]] std::function<bool(const SurfaceHit&)> membership(const std::vector<Index>& faces) const;

    [[nodiscard]] double target_edge() const { return target_edge_; }

    /// Built when it is first asked for, by any thread.
    const SurfaceSearch& source_search();

private:
    /// The outlines of a region on the target.
    struct Traced {
        std::vector<Halfedge> edges;
        double length = 0;
        std::size_t pieces = 0, vanished = 0;
    };
    [[nodiscard]] Traced edges_of(const std::vector<TracedPath>& paths) const;

    const Mesh& source_;
    const AnnotationSet& set_;
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
