// Fewer vertices by edge collapses, with everything that is bound to the mesh carried along.
#pragma once

#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

struct SimplifyOptions {
    std::uint64_t vertices = 0;                                      ///< wanted number of vertices
    enum class Method { qem, lindstrom_turk } method = Method::qem;  ///< what a collapse costs and where its vertex goes
    enum class Outlines { follow, protect, ignore } outlines = Outlines::follow;  ///< what happens to the marked edges
    double max_normal_change = 60;  ///< degrees a face may turn in one collapse, as long as the number can be reached so
    double outline_weight = 1;      ///< weight of the distance to marked edges, relative to the distance to faces (qem only)
    double border_weight = 1;       ///< weight of the distance to border edges (qem only)

    void describe(OptionList& visit);
};

/// Parts of the mesh that mean something: outlines and poly-lines as edges, annotated points as vertices. Empty = none.
struct MarkedParts {
    std::vector<bool> edges;     ///< one flag per edge, or empty
    std::vector<bool> vertices;  ///< one flag per vertex, or empty
};

/// Told of every merge while both elements still exist, so that values bound to them can be united. Faces need no merging:
/// a face either stays, with its values in every property map, or vanishes.
class CollapseVisitor {
public:
    virtual ~CollapseVisitor() = default;
    virtual void merge_vertices(Mesh& /*mesh*/, Vertex /*kept*/, Vertex /*removed*/) {}
    virtual void merge_edges(Mesh& /*mesh*/, Edge /*kept*/, Edge /*removed*/) {}
};

struct SimplifyResult {
    std::vector<Index> vertex_map;  ///< old vertex -> new vertex it is part of; no_index for isolated vertices, which are dropped
    std::vector<Index> face_map;    ///< old face -> new face, or no_index if it vanished
    std::size_t collapses = 0;
    bool reached = false;          ///< the wanted number was reached exactly
    std::string stop_reason;       ///< in words
    bool outlines_broken = false;  ///< marked edges had to be merged to reach the number (never when protected)
    std::size_t isolated_dropped = 0;
};

/// Collapses edges in the order of their cost until `options.vertices` are left. Keeps the mesh manifold, its topology (genus,
/// components, borders), orientation; no face is turned over. Property maps of kept elements keep their values; the garbage is
/// collected. Of two merged vertices, neighbours stay neighbours or become equal, so a poly-line mapped through `vertex_map` is a
/// poly-line. O(n log n). Deterministic. Throws Error (usage) if the mesh has fewer vertices than wanted or the flags do not fit
/// it. If the number cannot be reached, the result says why and holds the smallest mesh found.
///
/// Sources: Garland and Heckbert, "Surface simplification using quadric error metrics", 1997; Lindstrom and Turk, "Fast and
/// memory efficient polygonal simplification", 1998; link conditions: Dey, Edelsbrunner, Guha and Nekhayev, "Topology preserving
/// edge contraction", 1999.
SimplifyResult simplify(Mesh& mesh, const SimplifyOptions& options, const MarkedParts& marked = {},
                        CollapseVisitor* visitor = nullptr);

}  // namespace ostraka
