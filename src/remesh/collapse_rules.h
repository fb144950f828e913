// Collapses allowed by borders and marked parts, and the end that keeps its position.
#pragma once

#include "remesh/metric.h"

#include <cstdint>
#include <optional>

namespace ostraka {

struct CollapsePlan {
    Halfedge halfedge;    ///< its source is removed
    bool pinned = false;  ///< its target keeps its point
};

/// The marked edges form curves on the surface. While outlines are kept, a collapse must not merge two curves, close a curve
/// up, or move a vertex off its curve. Ends and branch points of curves and marked vertices keep their position (link condition
/// for embedded curves; compare Vivodtzev, Bonneau and Le Texier, "Topology preserving simplification of 2D non-manifold meshes
/// with embedded structures", 2005).
class CollapseRules {
public:
    CollapseRules(const Mesh& mesh, Marks& marks, bool protect);

    void keep_outlines(bool keep) { keep_ = keep; }
    [[nodiscard]] bool any_marks() const { return any_; }
    [[nodiscard]] bool broken() const { return broken_; }

    /// None if the edge must not be collapsed.
    [[nodiscard]] std::optional<CollapsePlan> plan(const Mesh& mesh, Edge e) const;
    /// Merges the marks of the edges and vertices that are about to be merged.
    void before_collapse(const Mesh& mesh, Halfedge h);
    void after_collapse(const Mesh& mesh, Vertex kept);

private:
    enum Role : std::uint8_t { free, on_curve, fixed };
    [[nodiscard]] Role role(const Mesh& mesh, Vertex v) const;

    Marks& marks_;
    bool protect_;
    bool keep_ = true;
    bool any_ = false;
    bool broken_ = false;
    bool recompute_ = false;
    std::vector<Role> role_;
};

}  // namespace ostraka
