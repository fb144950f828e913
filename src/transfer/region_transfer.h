// The interior of a transferred region.
#pragma once

#include "path_tracer.h"

#include <functional>
#include <memory>

namespace ostraka {

/// The outlines of a region as paths. Where an outline runs along the border of an open mesh it is cut: the border of the
/// target bounds the region there.
std::vector<SourcePath> region_paths(const Mesh& mesh, const std::vector<Index>& faces);

/// The longest of the shortest paths within the edges of a walk, approximately (two sweeps): what a region that shrank to a
/// tree of edges leaves as a line.
std::vector<Index> diameter_path(const std::vector<Index>& walk);

class RegionTransfer {
public:
    RegionTransfer(const Mesh& source, const SurfaceSearch& target, const TransferOptions& options);
    ~RegionTransfer();

    /// Flags of the faces of `mesh` (the target, or the target refined with `origin` giving each face's old one).
    std::vector<bool> fill(const std::vector<Index>& region, const std::vector<TracedPath>& traced,
                           const std::vector<SourcePath>& vertex_paths, const Mesh& mesh, const std::vector<Index>* origin,
                           TransferScore& score);

    /// Whether a place on the target lies in `faces` of `mesh`.
    std::function<bool(const SurfaceHit&)> membership(const std::vector<Index>& faces, const Mesh& mesh,
                                                      const std::vector<Index>* origin);

    [[nodiscard]] double target_edge() const { return target_edge_; }

private:
    void cover(std::vector<bool>& selected, const std::vector<SourcePath>& vertex_paths, TransferScore& score);

    const Mesh& source_;
    const SurfaceSearch& search_;
    const TransferOptions& options_;
    double target_edge_;
    std::unique_ptr<SurfaceSearch> source_search_;
};

}  // namespace ostraka
