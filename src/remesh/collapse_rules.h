// Rules that borders and marked parts impose on collapses, and which vertex of a collapse keeps its position.
#pragma once

#include "remesh/metric.h"

#include <cstdint>
#include <optional>

namespace ostraka {

/// An allowed collapse.
struct CollapsePlan {
    Halfedge halfedge;    ///< halfedge whose source vertex is removed
    bool pinned = false;  ///< true: the target vertex keeps its position
};

/// The marked edges and the seams form curves on the surface. While outlines are kept (seams: always), a collapse must not merge
/// two curves, contract a closed curve, or move a vertex off its curve. Ends and branch points of curves and marked vertices keep
/// their position (link condition for embedded curves; compare Vivodtzev, Bonneau and Le Texier, "Topology preserving
/// simplification of 2D non-manifold meshes with embedded structures", 2005).
class CollapseRules {
public:
    /// `protect`: true if all vertices of marked curves keep their positions.
    CollapseRules(const Mesh& mesh, Marks& marks, bool protect);

    /// Whether later collapses must preserve the curves.
    void keep_outlines(const Mesh& mesh, bool keep);
    [[nodiscard]] bool any_marks() const { return any_; }  ///< whether any edge or vertex is marked
    [[nodiscard]] bool broken() const { return broken_; }  ///< whether curves were merged

    /// The collapse of edge `e`; none if the edge must not be collapsed.
    [[nodiscard]] std::optional<CollapsePlan> plan(const Mesh& mesh, Edge e) const;
    /// Merges the marks of the edges and vertices that the collapse is about to merge.
    void before_collapse(const Mesh& mesh, Halfedge h);

private:
    enum Role : std::uint8_t { free, on_curve, fixed };         ///< relation of a vertex to the curves
    [[nodiscard]] Role role(const Mesh& mesh, Vertex v) const;  ///< relation of a vertex to the curves
    [[nodiscard]] bool is_curve(Edge e) const { return marks_.seams[e] || (keep_ && marks_.edges[e]); }
    /// Whether the vertex, or an edge at it, belongs to an annotation.
    [[nodiscard]] bool is_marked(const Mesh& mesh, Vertex v) const;

    Marks& marks_;
    bool protect_;            ///< true: vertices of marked curves keep their positions
    bool keep_ = true;        ///< true: collapses must preserve the curves
    bool any_ = false;        ///< whether any edge or vertex is marked
    bool any_seams_ = false;  ///< whether there are seams
    bool broken_ = false;     ///< whether curves were merged
    std::vector<Role> role_;  ///< role of each vertex
};

}  // namespace ostraka
