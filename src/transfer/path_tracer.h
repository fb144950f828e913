// Paths of source vertices drawn on the target: edge paths, or curves across faces.
#pragma once

#include "ostraka/geom/shortest_path.h"
#include "ostraka/geom/surface_trace.h"
#include "ostraka/transfer/transfer.h"

#include <map>
#include <unordered_map>
#include <vector>

namespace ostraka {

/// Successive vertices of an outline or a poly-line on the source.
struct SourcePath {
    std::vector<Index> vertices;  ///< a closed path does not repeat its first vertex
    bool closed = false;
    bool ends_on_border = false;  ///< an open path cut from an outline where it met the border
};

/// A path on the target.
struct TracedPath {
    std::vector<Index> walk;  ///< all vertices passed, before pruning
    std::vector<Index> path;  ///< what is left after spikes were dealt with; empty if the path shrank to nothing
    bool closed = false;
};

class PathTracer {
public:
    PathTracer(const Mesh& source, const SurfaceSearch& target, const TransferOptions& options);

    /// Finds the places of many vertices at once (all threads).
    void match(std::vector<Index> vertices);
    [[nodiscard]] const Correspondence& place(Index vertex) const { return places_.at(vertex); }

    /// The places of a path's vertices after the check for layers: neighbours must be joined by a path not much longer than
    /// the path between them. The longest run of vertices that agree is trusted; others are placed again among their
    /// candidates, or left out.
    std::vector<Correspondence> settle(const SourcePath& vertex_path, TransferScore& score);

    /// Thesis, Algorithm 1.
    TracedPath trace_edges(const SourcePath& vertex_path, TransferScore& score);

    /// The path as lines from face to face; each source edge gives one or more curves, cached so that outlines that share
    /// an edge share the curve. Returns, per step, the index into `curves()` and whether it is run backwards.
    struct Step {
        std::size_t curve;
        bool backwards;
    };
    std::vector<Step> trace_curves(const SourcePath& vertex_path, TransferScore& score);
    [[nodiscard]] const std::vector<SurfaceCurve>& curves() const { return curves_; }

private:
    /// Path between two target vertices, found from the lower to the higher index so that both directions agree.
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

/// Takes out "a, b, a" again and again; `closed` looks across the end as well. A closed path of fewer than three vertices
/// becomes empty.
std::vector<Index> prune_spikes(const std::vector<Index>& walk, bool closed);

}  // namespace ostraka
