// Traces paths of source vertices on the target: as edge paths, or as curves across faces.
#pragma once

#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_trace.h"
#include "ostraka/transfer/transfer.h"

#include <map>
#include <unordered_map>
#include <vector>

namespace ostraka {

/// A path of consecutive vertices of an outline or a poly-line on the source.
struct SourcePath {
    std::vector<Index> vertices;  ///< a closed path does not repeat its first vertex
    bool closed = false;
    bool ends_on_border = false;  ///< true: an open path, part of an outline cut at the border of the mesh
};

/// An edge path on the target.
struct TracedPath {
    std::vector<Index> walk;  ///< all vertices visited, before spikes are removed
    std::vector<Index> path;  ///< vertices left after the removal of spikes; empty if the path vanished
    bool closed = false;
};

/// Traces paths of the source on the target.
class PathTracer {
public:
    PathTracer(const Mesh& source, const SurfaceSearch& target, const TransferOptions& options);

    /// Finds the correspondences of these source vertices, using all threads.
    void match(std::vector<Index> vertices);
    /// Correspondence of a source vertex found by `match`.
    [[nodiscard]] const Correspondence& place(Index vertex) const { return places_.at(vertex); }

    /// The correspondences of a path's vertices after a check for layers: correspondences of consecutive vertices must be
    /// connected by a path not much longer than the source path between the vertices. The longest consistent run of vertices is
    /// trusted; other vertices are assigned another of their candidates, or dropped. `score` counts the changes.
    std::vector<Correspondence> settle(const SourcePath& vertex_path, TransferScore& score);

    /// Traces a path along edges of the target (thesis, Algorithm 1); `score` counts detours.
    TracedPath trace_edges(const SourcePath& vertex_path, TransferScore& score);

    /// Traces a path as curves across faces of the target; each source edge gives one or more curves, which are cached so that
    /// outlines with a common edge share the curve.
    struct Step {
        std::size_t curve;  ///< index into `curves()`
        bool backwards;     ///< true: the curve is traversed backwards
    };
    std::vector<Step> trace_curves(const SourcePath& vertex_path, TransferScore& score);
    [[nodiscard]] const std::vector<SurfaceCurve>& curves() const { return curves_; }  ///< all curves traced so far

private:
    /// Path between two target vertices, at most `limit` long, searched from the lower to the higher index so that both
    /// directions agree.
    const std::vector<Index>& path(Index a, Index b, double limit);
    /// Max length of the path between two corresponding vertices.
    [[nodiscard]] double limit(const Correspondence& a, const Correspondence& b, double source_length) const;
    [[nodiscard]] double longest_edge(Index face) const;  ///< length of the face's longest edge
    /// Connects two target vertices by an edge path.
    std::vector<Index> connect(Index a, Index b, double longest, TransferScore& score, const std::vector<bool>* used);

    const Mesh& source_;
    const SurfaceSearch& search_;
    const Mesh& target_;
    const TransferOptions& options_;
    PathMetric metric_;
    PathSearch paths_;
    std::unordered_map<Index, Correspondence> places_;  ///< from a source vertex to its correspondence
    /// From two target vertices, the lower first, to the path between them.
    std::map<std::pair<Index, Index>, std::vector<Index>> path_cache_;
    std::vector<SurfaceCurve> curves_;
    std::map<std::pair<Index, Index>, std::size_t> curve_cache_;  ///< from two source vertices to the index of their curve
};

}  // namespace ostraka
