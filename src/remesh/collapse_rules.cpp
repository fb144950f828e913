#include "remesh/collapse_rules.h"

#include "remesh/collapse.h"

namespace ostraka {

CollapseRules::CollapseRules(const Mesh& mesh, Marks& marks, bool protect)
    : marks_(marks), protect_(protect), role_(mesh.number_of_vertices(), free) {
    for (const Vertex v : mesh.vertices()) {
        if (!mesh.is_isolated(v)) role_[v] = role(mesh, v);
        any_ = any_ || role_[v] != free;
    }
}

CollapseRules::Role CollapseRules::role(const Mesh& mesh, Vertex v) const {
    if (marks_.vertices[v]) return fixed;
    std::size_t marked = 0;
    for_each_incoming(mesh, v, [&](Halfedge h) { marked += marks_.edges[mesh.edge(h)]; });
    if (marked == 0) return free;
    return protect_ || marked != 2 ? fixed : on_curve;
}

std::optional<CollapsePlan> CollapseRules::plan(const Mesh& mesh, Edge e) const {
    const Halfedge h = mesh.halfedge(e, 0), o = mesh.opposite(h);
    const Vertex u = mesh.source(h), v = mesh.target(h);
    const bool border_u = mesh.is_border(u, false), border_v = mesh.is_border(v, false);
    bool pin_u = border_u && !border_v, pin_v = border_v && !border_u;
    if (border_u && border_v && !mesh.is_border(e)) return {};
    if (any_ && keep_) {
        const bool curve_u = role_[u] != free, curve_v = role_[v] != free;
        if (curve_u && curve_v) {
            if (!marks_.edges[e]) return {};
            for (const Halfedge side : {h, o})
                if (!mesh.is_border(side) && marks_.edges[mesh.edge(mesh.next(side))] && marks_.edges[mesh.edge(mesh.prev(side))])
                    return {};
        }
        pin_u = pin_u || role_[u] == fixed || (curve_u && !curve_v);
        pin_v = pin_v || role_[v] == fixed || (curve_v && !curve_u);
    }
    if (pin_u && pin_v) return {};
    if (pin_u) return CollapsePlan{o, true};
    if (pin_v) return CollapsePlan{h, true};
    return CollapsePlan{u < v ? o : h, false};
}

void CollapseRules::before_collapse(const Mesh& mesh, Halfedge h) {
    if (!any_) return;
    const Halfedge o = mesh.opposite(h);
    const Vertex u = mesh.source(h), v = mesh.target(h);
    recompute_ = !keep_ && (role_[u] != free || role_[v] != free);
    if (!keep_ && role_[u] != free && role_[v] != free) broken_ = true;
    const auto unite = [&](Halfedge kept, Halfedge removed) {
        if (marks_.edges[mesh.edge(removed)]) marks_.edges[mesh.edge(kept)] = true;
    };
    if (!mesh.is_border(h)) unite(mesh.next(h), mesh.prev(h));
    if (!mesh.is_border(o)) unite(mesh.prev(o), mesh.next(o));
    if (marks_.vertices[u]) marks_.vertices[v] = true;
    role_[v] = std::max(role_[u], role_[v]);
}

void CollapseRules::after_collapse(const Mesh& mesh, Vertex kept) {
    if (!recompute_) return;
    recompute_ = false;
    for_each_incoming(mesh, kept, [&](Halfedge h) { role_[mesh.source(h)] = role(mesh, mesh.source(h)); });
    role_[kept] = role(mesh, kept);
}

}  // namespace ostraka
