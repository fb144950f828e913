// Simplifies a mesh by edge collapses; values in the mesh's property maps are preserved.
#pragma once

#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ostraka {

struct SimplifyOptions {
    std::uint64_t vertices = 0;                                      ///< target number of vertices
    enum class Method { qem, lindstrom_turk } method = Method::qem;  ///< cost of a collapse, and position of the remaining vertex
    /// Treatment of marked edges. follow: they are simplified along their curves; protect: they are unchanged; ignore: they are
    /// treated like other edges.
    enum class Outlines { follow, protect, ignore } outlines = Outlines::follow;
    /// Max rotation of a face normal by one collapse, degrees; the limit is raised if the target number cannot be reached
    /// otherwise.
    double max_normal_change = 60;
    /// Weight of the distance from marked edges, relative to the weight of the distance from faces (method qem only).
    double outline_weight = 1;
    /// Weight of the distance from border edges, relative to the weight of the distance from faces (method qem only).
    double border_weight = 1;
    /// True: border vertices and edges are unchanged, so that the mesh still fits neighbouring tiles.
    bool keep_border = false;
    double seam_drift = 0.001;  ///< max distance of the seams of the texture from where they were, as a share of the diagonal

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Edges and vertices of annotations: outlines and poly-lines as edges, annotated points as vertices.
struct MarkedParts {
    std::vector<bool> edges;     ///< for each edge, whether it is marked; empty: none is marked
    std::vector<bool> vertices;  ///< for each vertex, whether it is marked; empty: none is marked
    /// For each edge: true if texture coordinates or materials differ between its two faces; empty: there are no such edges.
    /// Seams are always simplified along their curves, as with Outlines::follow, and are never merged.
    std::vector<bool> seams = {};
};

/// Callbacks for every merge of two vertices or edges. The callbacks are called while both elements still exist, so that values
/// of these elements can be merged. Faces need no callback: a face either keeps its values in all property maps, or is removed.
class CollapseVisitor {
public:
    virtual ~CollapseVisitor() = default;
    /// Called before vertex `removed` is merged into vertex `kept`.
    virtual void merge_vertices(Mesh& /*mesh*/, Vertex /*kept*/, Vertex /*removed*/) {}
    /// Called before edge `removed` is merged into edge `kept`.
    virtual void merge_edges(Mesh& /*mesh*/, Edge /*kept*/, Edge /*removed*/) {}
    /// Called before the source of `h` is merged into its target, and before the target moves to `position`.
    virtual void place_vertex(Mesh& /*mesh*/, Halfedge /*h*/, const Point& /*position*/) {}
    /// Called before `kept` replaces `replaced` in the face of `replaced`, so that data of the face's corner can be moved.
    virtual void replace_halfedge(Mesh& /*mesh*/, Halfedge /*kept*/, Halfedge /*replaced*/) {}
};

struct SimplifyResult {
    /// For each old vertex, the new vertex that represents it; no_index for isolated vertices, which are removed.
    std::vector<Index> vertex_map;
    std::vector<Index> face_map;  ///< for each old face, its index in the new mesh; no_index if it was removed
    std::size_t collapses = 0;    ///< number of collapses
    bool reached = false;         ///< true: the mesh has exactly the target number of vertices
    std::string stop_reason;      ///< why the simplification stopped, as a sentence
    /// True: marked curves were merged to reach the target number (never if marked edges are protected).
    bool outlines_broken = false;
    std::size_t isolated_dropped = 0;  ///< number of isolated vertices that were removed
};

/// Collapses edges in ascending order of cost until `options.vertices` vertices are left. The mesh stays manifold and keeps its
/// topology (genus, components, borders) and orientation; no face is flipped. Remaining elements keep their values in property
/// maps; removed elements are deleted (garbage collection). Neighbouring vertices stay neighbours or are merged, so that a
/// poly-line mapped through `vertex_map` is a poly-line. Time: O(n log n). The result is deterministic. Throws Error (usage) if
/// the mesh has fewer vertices than requested or the number of flags does not match the mesh. If the target number cannot be
/// reached, the result gives the reason and the mesh is the smallest that was found.
///
/// Sources: Garland and Heckbert, "Surface simplification using quadric error metrics", 1997; Lindstrom and Turk, "Fast and
/// memory efficient polygonal simplification", 1998; link conditions: Dey, Edelsbrunner, Guha and Nekhayev, "Topology preserving
/// edge contraction", 1999.
SimplifyResult simplify(Mesh& mesh, const SimplifyOptions& options, const MarkedParts& marked = {},
                        CollapseVisitor* visitor = nullptr);

}  // namespace ostraka
