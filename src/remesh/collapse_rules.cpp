#include "remesh/collapse_rules.h"

#include "remesh/collapse.h"

#include <algorithm>

namespace ostraka {

CollapseRules::CollapseRules(const Mesh& mesh, Marks& marks, bool protect)
    : marks_(marks), protect_(protect), role_(mesh.number_of_vertices(), free) {
    for (const Vertex v : mesh.vertices()) {
        if (!mesh.is_isolated(v)) role_[v] = role(mesh, v);
        any_ = any_ || is_marked(mesh, v);
    }
    any_seams_ = std::find(marks.seams.begin(), marks.seams.end(), true) != marks.seams.end();
}

void CollapseRules::keep_outlines(const Mesh& mesh, bool keep) {
    if (keep == keep_) return;
    keep_ = keep;
    for (const Vertex v : mesh.vertices())
        if (!mesh.is_isolated(v)) role_[v] = role(mesh, v);
}

bool CollapseRules::is_marked(const Mesh& mesh, Vertex v) const {
    bool marked = marks_.vertices[v];
    if (!mesh.is_isolated(v)) for_each_incoming(mesh, v, [&](Halfedge h) { marked = marked || marks_.edges[mesh.edge(h)]; });
    return marked;
}

CollapseRules::Role CollapseRules::role(const Mesh& mesh, Vertex v) const {
    if (keep_ && marks_.vertices[v]) return fixed;
    std::size_t curves = 0, outlines = 0;
    for_each_incoming(mesh, v, [&](Halfedge h) {
        curves += is_curve(mesh.edge(h));
        outlines += keep_ && marks_.edges[mesh.edge(h)];
    });
    if (curves == 0) return free;
    return (protect_ && outlines > 0) || curves != 2 ? fixed : on_curve;
}

std::optional<CollapsePlan> CollapseRules::plan(const Mesh& mesh, Edge e) const {
    const Halfedge h = mesh.halfedge(e, 0), o = mesh.opposite(h);
    const Vertex u = mesh.source(h), v = mesh.target(h);
    const bool border_u = mesh.is_border(u, false), border_v = mesh.is_border(v, false);
    bool pin_u = border_u && !border_v, pin_v = border_v && !border_u;
    if (border_u && border_v && (marks_.keep_border || !mesh.is_border(e))) return {};
    if (any_seams_ || (any_ && keep_)) {
        const bool curve_u = role_[u] != free, curve_v = role_[v] != free;
        if (curve_u && curve_v) {
            if (!is_curve(e)) return {};
            for (const Halfedge side : {h, o})
                if (!mesh.is_border(side) && is_curve(mesh.edge(mesh.next(side))) && is_curve(mesh.edge(mesh.prev(side))))
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
    if (!any_ && !any_seams_) return;
    const Halfedge o = mesh.opposite(h);
    const Vertex u = mesh.source(h), v = mesh.target(h);
    if (!keep_ && !broken_) broken_ = is_marked(mesh, u) && is_marked(mesh, v);
    const auto unite = [&](Halfedge kept, Halfedge removed) {
        if (marks_.edges[mesh.edge(removed)]) marks_.edges[mesh.edge(kept)] = true;
        if (marks_.seams[mesh.edge(removed)]) marks_.seams[mesh.edge(kept)] = true;
    };
    if (!mesh.is_border(h)) unite(mesh.next(h), mesh.prev(h));
    if (!mesh.is_border(o)) unite(mesh.prev(o), mesh.next(o));
    if (marks_.vertices[u]) marks_.vertices[v] = true;
    role_[v] = std::max(role_[u], role_[v]);
}

}  // namespace ostraka
