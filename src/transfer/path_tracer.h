// Paths of source vertices traced on the target: edge paths, or curves across faces.
#pragma once

#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_trace.h"
#include "ostraka/transfer/transfer.h"

#include <map>
#include <unordered_map>
#include <vector>

namespace ostraka {

/// Consecutive vertices of an outline or a poly-line on the source.
struct SourcePath {
    std::vector<Index> vertices;  ///< a closed path does not repeat its first vertex
    bool closed = false;
    bool ends_on_border = false;  ///< an open path that was cut from an outline at the border of the mesh
};

/// A path on the target.
struct TracedPath {
    std::vector<Index> walk;  ///< all vertices visited, before pruning
    std::vector<Index> path;  ///< vertices left after removal of spikes; empty if the path vanished
    bool closed = false;
};

class PathTracer {
public:
    PathTracer(const Mesh& source, const SurfaceSearch& target, const TransferOptions& options);

    /// Finds the correspondences of many vertices at once (all threads).
    void match(std::vector<Index> vertices);
    [[nodiscard]] const Correspondence& place(Index vertex) const { return places_.at(vertex); }

    /// The correspondences of a path's vertices after a check for layers: consecutive ones must be connected by a path not much
    /// longer than the source path between them. The longest consistent run of vertices is trusted; other vertices are assigned
    /// another of their candidates, or dropped.
    std::vector<Correspondence> settle(const SourcePath& vertex_path, TransferScore& score);

    /// Thesis, Algorithm 1.
    TracedPath trace_edges(const SourcePath& vertex_path, TransferScore& score);

    /// The path as curves across faces; each source edge gives one or more curves, which are cached so that outlines with a
    /// common edge share the curve. Returns, per step, the index into `curves()` and whether the curve is traversed backwards.
    struct Step {
        std::size_t curve;
        bool backwards;
    };
    std::vector<Step> trace_curves(const SourcePath& vertex_path, TransferScore& score);
    [[nodiscard]] const std::vector<SurfaceCurve>& curves() const { return curves_; }

private:
    /// Path between two target vertices, searched from the lower to the higher index so that both directions agree.
    const std::vector<Index>& path(Index a, Index b, double limit);
    [[nodiscard]] double limit(const Correspondence& a, const Correspondence& b, double source_length) const;
    [[nodiscard]] double longest_edge(Index face) const;
    std::vector<Index> connect(Index a, Index b, double longest, TransferScore& score, const std::vector<bool>* used);

    const Mesh& source_;
    const SurfaceSearch& search_;
    const Mesh& target_;
    const TransferOptions& options_;
    PathMetric metric_;
    PathSearch paths_;
    std::unordered_map<Index, Correspondence> places_;
    std::map<std::pair<Index, Index>, std::vector<Index>> path_cache_;
    std::vector<SurfaceCurve> curves_;
    std::map<std::pair<Index, Index>, std::size_t> curve_cache_;  ///< by pair of source vertices
};

}  // namespace ostraka
