// Simplification by edge collapses, with all attached data carried along.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

struct SimplifyOptions {
    std::uint64_t vertices = 0;                                      ///< target number of vertices
    enum class Method { qem, lindstrom_turk } method = Method::qem;  ///< cost of a collapse and position of its vertex
    enum class Outlines { follow, protect, ignore } outlines = Outlines::follow;  ///< treatment of the marked edges
    /// Maximum rotation of a face normal per collapse, degrees; relaxed if the number cannot be reached otherwise.
    double max_normal_change = 60;
    double outline_weight = 1;  ///< weight of the distance from marked edges, relative to the distance from faces (qem only)
    double border_weight = 1;   ///< weight of the distance from border edges (qem only)

    void describe(OptionList& visit);
};

/// Semantic parts of the mesh: outlines and poly-lines as edges, annotated points as vertices. Empty = none.
struct MarkedParts {
    std::vector<bool> edges;     ///< one flag per edge, or empty
    std::vector<bool> vertices;  ///< one flag per vertex, or empty
};

/// Is called for every merge while both elements still exist, so that values bound to them can be merged. Faces need no
/// merging: a face either stays, with its values in every property map, or is removed.
class CollapseVisitor {
public:
    virtual ~CollapseVisitor() = default;
    virtual void merge_vertices(Mesh& /*mesh*/, Vertex /*kept*/, Vertex /*removed*/) {}
    virtual void merge_edges(Mesh& /*mesh*/, Edge /*kept*/, Edge /*removed*/) {}
};

struct SimplifyResult {
    /// Old vertex -> new vertex that represents it; no_index for isolated vertices, which are removed.
    std::vector<Index> vertex_map;
    std::vector<Index> face_map;  ///< old face -> new face, or no_index if it was removed
    std::size_t collapses = 0;
    bool reached = false;          ///< whether the target number was reached exactly
    std::string stop_reason;       ///< message: why the simplification stopped
    bool outlines_broken = false;  ///< whether marked edges were merged to reach the number (never if protected)
    std::size_t isolated_dropped = 0;
};

/// Collapses edges in the order of their cost until `options.vertices` are left. The mesh stays manifold and keeps its topology
/// (genus, components, borders) and orientation; no face is flipped. Property maps of kept elements keep their values; the
/// garbage is collected. Neighbouring vertices stay neighbours or are merged, so a poly-line mapped through `vertex_map` is a
/// poly-line. O(n log n). Deterministic. Throws Error (usage) if the mesh has fewer vertices than requested or the number of
/// flags does not match the mesh. If the number cannot be reached, the result gives the reason and contains the smallest mesh
/// found.
///
/// Sources: Garland and Heckbert, "Surface simplification using quadric error metrics", 1997; Lindstrom and Turk, "Fast and
/// memory efficient polygonal simplification", 1998; link conditions: Dey, Edelsbrunner, Guha and Nekhayev, "Topology preserving
/// edge contraction", 1999.
SimplifyResult simplify(Mesh& mesh, const SimplifyOptions& options, const MarkedParts& marked = {},
                        CollapseVisitor* visitor = nullptr);

}  // namespace ostraka
