#include "ostraka/annotation/outline.h"

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/mesh/flood.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace ostraka {

namespace {

bool inside(const Mesh& mesh, const std::vector<bool>& selected, Halfedge h) {
    return !mesh.is_border(h) && selected[mesh.face(h)];
}

/// The outline halfedge after `h`, in the same fan of selected faces around the target of `h`.
Halfedge following(const Mesh& mesh, const std::vector<bool>& selected, Halfedge h) {
    Halfedge g = mesh.next(h);
    while (inside(mesh, selected, mesh.opposite(g))) g = mesh.next(mesh.opposite(g));
    return g;
}

template <class Faces>
std::vector<Outline> outlines_of(const Mesh& mesh, const std::vector<bool>& selected, const Faces& faces) {
    check_cancelled();
    std::vector<Outline> outlines;
    std::vector<Halfedge> start;
    for (const Face f : faces) {
        if (!selected[f]) continue;
        for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(f), mesh))
            if (!inside(mesh, selected, mesh.opposite(h))) start.push_back(h);
    }
    std::sort(start.begin(), start.end());
    // Outlines are short compared to the mesh: a sorted list with flags needs less memory than a flag per halfedge.
    std::vector<bool> used(start.size(), false);
    const auto position = [&](Halfedge h) {
        return static_cast<std::size_t>(std::lower_bound(start.begin(), start.end(), h) - start.begin());
    };
    for (std::size_t i = 0; i < start.size(); ++i) {
        if (used[i]) continue;
        Outline outline;
        for (std::size_t at = i; !used[at];) {
            used[at] = true;
            outline.push_back(mesh.source(start[at]));
            at = position(following(mesh, selected, start[at]));
        }
        std::rotate(outline.begin(), std::min_element(outline.begin(), outline.end()), outline.end());
        outlines.push_back(std::move(outline));
    }
    return outlines;
}

}  // namespace

std::vector<Outline> extract_outlines(const Mesh& mesh, const std::vector<bool>& selected) {
    return outlines_of(mesh, selected, mesh.faces());
}

std::vector<Outline> extract_outlines(const Mesh& mesh, const std::vector<Index>& faces) {
    std::vector<bool> selected(mesh.number_of_faces(), false);
    std::vector<Face> list;
    list.reserve(faces.size());
    for (const Index f : faces) {
        if (f >= mesh.number_of_faces())
            fail_input("face " + std::to_string(f),
                       "does not exist; the mesh has " + std::to_string(mesh.number_of_faces()) + " faces");
        selected[f] = true;
        list.emplace_back(f);
    }
    if (!std::is_sorted(list.begin(), list.end())) std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return outlines_of(mesh, selected, list);
}

std::vector<OutlinePath> outline_paths(const Mesh& mesh, const std::vector<Index>& faces) {
    std::vector<OutlinePath> paths;
    for (Outline& outline : extract_outlines(mesh, faces)) {
        const std::size_t n = outline.size();
        std::vector<bool> border(n);
        for (std::size_t i = 0; i < n; ++i)
            border[i] = mesh.is_border(mesh.opposite(find_halfedge(mesh, Vertex(outline[i]), Vertex(outline[(i + 1) % n]))));
        if (std::find(border.begin(), border.end(), true) == border.end()) {
            paths.push_back({std::move(outline), true});
            continue;
        }
        for (std::size_t i = 0; i < n; ++i) {
            if (border[i] || !border[(i + n - 1) % n]) continue;
            std::vector<Index>& path = paths.emplace_back().vertices;
            path.push_back(outline[i]);
            for (std::size_t k = i; !border[k % n]; ++k) path.push_back(outline[(k + 1) % n]);
        }
    }
    return paths;
}

std::vector<Index> prune_spikes(const std::vector<Index>& walk, bool closed) {
    std::vector<Index> path;
    for (const Index v : walk) {
        if (!path.empty() && path.back() == v) continue;
        if (path.size() >= 2 && path[path.size() - 2] == v) path.pop_back();
        else path.push_back(v);
    }
    if (!closed) return path;
    std::size_t first = 0, last = path.size();
    for (;;) {
        if (last - first < 3) return {};
        if (path[first] == path[last - 1]) --last;
        else if (path[first] == path[last - 2]) last -= 1;
        else if (path[first + 1] == path[last - 1]) ++first;
        else break;
    }
    return {path.begin() + static_cast<std::ptrdiff_t>(first), path.begin() + static_cast<std::ptrdiff_t>(last)};
}

namespace {
/// Net number of traversals of each edge in the direction of its first halfedge. (An Edge made from a halfedge remembers that
/// halfedge, so the first one must be requested by number.)
std::map<Edge, int> net_edges(const Mesh& mesh, const std::vector<Halfedge>& edges) {
    std::map<Edge, int> net;
    for (const Halfedge h : edges) net[mesh.edge(h)] += mesh.halfedge(mesh.edge(h), 0) == h ? 1 : -1;
    return net;
}
}  // namespace

Filling fill_outlines(const Mesh& mesh, const std::vector<Outline>& outlines) {
    check_cancelled();
    std::vector<Halfedge> edges;
    for (std::size_t o = 0; o < outlines.size(); ++o) {
        const Outline& outline = outlines[o];
        const auto where = [&](std::size_t i) { return "outline " + std::to_string(o) + ", vertex " + std::to_string(i); };
        if (outline.size() < 3) fail_input("outline " + std::to_string(o), "has fewer than three vertices");
        for (std::size_t i = 0; i < outline.size(); ++i)
            if (outline[i] >= mesh.number_of_vertices())
                fail_input(where(i),
                           "names vertex " + std::to_string(outline[i]) + " of " + std::to_string(mesh.number_of_vertices()),
                           "is the annotation of another mesh?");
        for (std::size_t i = 0; i < outline.size(); ++i) {
            const Index a = outline[i], b = outline[(i + 1) % outline.size()];
            const Halfedge h = find_halfedge(mesh, Vertex(a), Vertex(b));
            if (h == Mesh::null_halfedge())
                fail_input(where(i), "the mesh has no edge from " + std::to_string(a) + " to " + std::to_string(b),
                           "is the annotation of another mesh?");
            edges.push_back(h);
        }
    }
    return fill_edges(mesh, edges);
}

Filling fill_edges(const Mesh& mesh, const std::vector<Halfedge>& edges) {
    const std::map<Edge, int> net = net_edges(mesh, edges);
    Filling filling;
    filling.selected.assign(mesh.number_of_faces(), false);
    std::vector<Face> starts;
    std::vector<bool> wall(mesh.number_of_edges(), false);
    for (const auto& [edge, count] : net) {
        wall[edge] = count != 0;
        const Halfedge h = mesh.halfedge(edge, count > 0 ? 0 : 1);
        if (count == 0 || mesh.is_border(h) || filling.selected[mesh.face(h)]) continue;
        filling.selected[mesh.face(h)] = true;
        starts.push_back(mesh.face(h));
    }
    CancelCheck check;
    flood(std::move(starts), filling.selected, [&](Face f, auto&& reach) {
        check();
        for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(f), mesh))
            if (const Halfedge o = mesh.opposite(h); !wall[mesh.edge(h)] && !mesh.is_border(o)) reach(mesh.face(o));
    });
    std::vector<Face> right;
    for (const auto& [edge, count] : net) {
        const Halfedge h = mesh.halfedge(edge, count > 0 ? 1 : 0);
        if (count != 0 && !mesh.is_border(h) && filling.selected[mesh.face(h)]) right.push_back(mesh.face(h));
    }
    std::sort(right.begin(), right.end());
    filling.conflicts = static_cast<std::size_t>(std::unique(right.begin(), right.end()) - right.begin());
    return filling;
}

std::optional<std::vector<bool>> fill_by_winding(const Mesh& mesh, const std::vector<Halfedge>& edges, double expected_area) {
    const std::map<Edge, int> net = net_edges(mesh, edges);
    const auto weight = [&](Halfedge h) {  // winding number of the left face minus that of the right one
        const auto found = net.find(mesh.edge(h));
        if (found == net.end()) return 0;
        return mesh.halfedge(mesh.edge(h), 0) == h ? found->second : -found->second;
    };
    // Components without any of the edges are not selected.
    constexpr int unknown = std::numeric_limits<int>::min();
    std::vector<int> number(mesh.number_of_faces(), unknown);
    std::vector<bool> selected(mesh.number_of_faces(), false);
    for (const auto& [edge, count] : net) {
        const Halfedge start = mesh.is_border(mesh.halfedge(edge, 0)) ? mesh.halfedge(edge, 1) : mesh.halfedge(edge, 0);
        if (count == 0 || number[mesh.face(start)] != unknown) continue;
        std::vector<Face> component{mesh.face(start)};
        number[component.front()] = 0;
        for (std::size_t i = 0; i < component.size(); ++i) {
            for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(component[i]), mesh)) {
                if (mesh.is_border(mesh.opposite(h))) continue;
                const Face other = mesh.face(mesh.opposite(h));
                const int expected = number[component[i]] - weight(h);
                if (number[other] == unknown) {
                    number[other] = expected;
                    component.push_back(other);
                } else if (number[other] != expected) {
                    return std::nullopt;
                }
            }
        }
        std::map<int, double> area_of;
        for (const Face f : component) area_of[number[f]] += face_area(mesh, f);
        double area = 0, best = expected_area;  // the error of the empty set
        int threshold = std::numeric_limits<int>::max();
        for (auto i = area_of.rbegin(); i != area_of.rend(); ++i) {
            area += i->second;
            if (std::abs(area - expected_area) < best) {
                best = std::abs(area - expected_area);
                threshold = i->first;
            }
        }
        for (const Face f : component) selected[f] = selected[f] || number[f] >= threshold;
    }
    return selected;
}

RegionMeasures measure_region(const Mesh& mesh, const std::vector<Index>& faces) {
    check_cancelled();
    RegionMeasures measures;
    measures.area = area_of(mesh, faces);
    for (const Outline& outline : extract_outlines(mesh, faces))
        for (std::size_t i = 0; i < outline.size(); ++i)
            measures.perimeter += std::sqrt(
                CGAL::squared_distance(mesh.point(Vertex(outline[i])), mesh.point(Vertex(outline[(i + 1) % outline.size()]))));
    return measures;
}

}  // namespace ostraka
