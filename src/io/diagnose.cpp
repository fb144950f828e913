#include "ostraka/io/diagnose.h"

#include "io/repair_steps.h"
#include "io/soup_edges.h"
#include "io/soup_geometry.h"
#include "ostraka/core/progress.h"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <limits>

namespace ostraka {

using detail::SoupEdges;

namespace {

/// Computes the component of each triangle (connected by shared vertices, numbered by lowest vertex) and the counts per
/// component.
std::vector<Index> find_components(const TriangleSoup& soup, MeshDiagnosis& diagnosis) {
    DisjointSets sets(soup.points.size());
    std::vector<std::uint8_t> used(soup.points.size(), 0), named(soup.points.size(), 0);
    for (const auto& t : soup.triangles) {
        for (const Index v : t) named[v] = 1;
        if (detail::repeats_corner(t)) continue;
        sets.unite(t[0], t[1]);
        sets.unite(t[0], t[2]);
        for (const Index v : t) used[v] = 1;
    }
    std::vector<Index> component(soup.points.size(), no_index);
    for (Index v = 0; v < soup.points.size(); ++v) {
        if (named[v] == 0) ++diagnosis.isolated_vertices;
        if (used[v] == 0) continue;
        const Index root = sets.find(v);
        if (root == v) {
            component[v] = static_cast<Index>(diagnosis.components.size());
            diagnosis.components.emplace_back().first_vertex = v;
        }
        component[v] = component[root];
        ++diagnosis.components[component[v]].vertices;
    }
    std::vector<Index> component_of_triangle(soup.triangles.size(), no_index);
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        if (detail::repeats_corner(soup.triangles[t])) {
            ++diagnosis.repeated_corners;
            continue;
        }
        component_of_triangle[t] = component[soup.triangles[t][0]];
        ++diagnosis.components[component_of_triangle[t]].triangles;
    }
    return component_of_triangle;
}

/// Counts triangles with the same three vertices, at the edge of their two lowest vertices.
std::size_t count_duplicates(const TriangleSoup& soup, const Index* halfedges, Index valence, std::vector<Index>& apexes) {
    apexes.clear();
    for (Index i = 0; i < valence; ++i) {
        const Index h = halfedges[i], top = detail::apex(soup, h);
        if (top > std::max(detail::origin(soup, h), detail::target(soup, h))) apexes.push_back(top);
    }
    std::sort(apexes.begin(), apexes.end());
    return apexes.size() - static_cast<std::size_t>(std::unique(apexes.begin(), apexes.end()) - apexes.begin());
}

/// Union-find with parity: two triangles at a manifold edge must traverse it in opposite directions; `flip` says whether a
/// triangle must be reversed relative to its root.
class FlipParity {
public:
    explicit FlipParity(std::size_t count) : parent_(count), flip_(count, 0) {
        for (Index i = 0; i < count; ++i) parent_[i] = i;
    }
    /// False if the two are already joined with the other parity.
    bool join(Index a, Index b, std::uint8_t flipped) {
        const auto [root_a, flip_a] = find(a);
        const auto [root_b, flip_b] = find(b);
        if (root_a == root_b) return (flip_a ^ flip_b) == flipped;
        const Index low = std::min(root_a, root_b), high = std::max(root_a, root_b);
        parent_[high] = low;
        flip_[high] = static_cast<std::uint8_t>(flip_a ^ flip_b ^ flipped);
        return true;
    }

private:
    std::pair<Index, std::uint8_t> find(Index i) {
        Index root = i;
        std::uint8_t flip = 0;
        while (parent_[root] != root) {
            flip ^= flip_[root];
            root = parent_[root];
        }
        for (std::uint8_t remaining_flip = flip; i != root && parent_[i] != root;) {  // path compression
            const Index above = parent_[i];
            const std::uint8_t parent_flip = flip_[i];
            parent_[i] = root;
            flip_[i] = remaining_flip;
            remaining_flip ^= parent_flip;
            i = above;
        }
        return {root, flip};
    }
    std::vector<Index> parent_;
    std::vector<std::uint8_t> flip_;
};

void examine_edges(const TriangleSoup& soup, const SoupEdges& edges, const std::vector<Index>& component,
                   MeshDiagnosis& diagnosis) {
    FlipParity parity(soup.triangles.size());
    std::vector<Index> apexes;
    double sum = 0, shortest = std::numeric_limits<double>::infinity(), longest = 0;
    for (std::size_t e = 0; e < edges.count(); ++e) {
        const Index* h = edges.first(e);
        const Index valence = edges.valence(e), a = detail::origin(soup, h[0]), b = detail::target(soup, h[0]);
        auto& part = diagnosis.components[component[h[0] / 3]];
        ++part.edges;
        const double length = std::sqrt(CGAL::squared_distance(detail::point(soup, a), detail::point(soup, b)));
        sum += length;
        shortest = std::min(shortest, length);
        longest = std::max(longest, length);
        if (valence == 1) ++part.border_edges;
        if (valence > 2) ++part.nonmanifold_edges;
        if (valence > 1) diagnosis.duplicate_triangles += count_duplicates(soup, h, valence, apexes);
        if (valence != 2) continue;
        const bool same_direction = detail::origin(soup, h[1]) == a;
        if (same_direction) ++part.misoriented_edges;
        if (!parity.join(h[0] / 3, h[1] / 3, same_direction ? 1 : 0)) part.orientable = false;
    }
    diagnosis.edges = edges.count();
    if (edges.count() == 0) return;
    diagnosis.shortest_edge = shortest;
    diagnosis.longest_edge = longest;
    diagnosis.mean_edge = sum / static_cast<double>(edges.count());
}

/// Traces border loops. Border edges are connected at the fans of triangles that they belong to: two per fan if all edges are
/// manifold.
void examine_border(const TriangleSoup& soup, const SoupEdges& edges, DisjointSets& fans, MeshDiagnosis& diagnosis) {
    struct BorderEdge {
        Index halfedge, first_fan, second_fan;
        bool used = false;
    };
    std::vector<BorderEdge> border;
    std::vector<std::pair<Index, Index>> at_fan;  // fan, border edge
    for (std::size_t e = 0; e < edges.count(); ++e) {
        if (edges.valence(e) != 1) continue;
        const Index h = *edges.first(e);
        border.push_back({h, fans.find(h), fans.find(detail::next_halfedge(h))});
    }
    for (Index i = 0; i < border.size(); ++i) {
        at_fan.emplace_back(border[i].first_fan, i);
        at_fan.emplace_back(border[i].second_fan, i);
    }
    std::sort(at_fan.begin(), at_fan.end());
    std::vector<Index> walked(at_fan.size() + 1, 0);  // number of entries already processed, by the first entry of a fan
    struct Step {
        Index vertex;
        BorderLoop leaving;  ///< the edge that leaves the vertex
    };
    std::vector<std::uint8_t> on_walk(border.empty() ? 0 : soup.points.size(), 0);
    using detail::origin, detail::target, detail::point;
    for (Index start = 0; start < border.size(); ++start) {
        if (border[start].used) continue;
        // A walk that returns to a vertex (two holes touch there) has completed a loop around one of the holes, which is split
        // off.
        std::vector<Step> walk;
        Index edge = start, fan = border[start].second_fan, at = target(soup, border[start].halfedge);
        walk.push_back({origin(soup, border[start].halfedge), {}});
        on_walk[walk.front().vertex] = 1;
        while (edge != no_index) {
            border[edge].used = true;
            const Index h = border[edge].halfedge;
            walk.back().leaving = {1,
                                   std::sqrt(CGAL::squared_distance(point(soup, origin(soup, h)), point(soup, target(soup, h))))};
            if (on_walk[at] != 0) {
                BorderLoop loop;
                while (true) {
                    const Step& step = walk.back();
                    loop.edges += step.leaving.edges;
                    loop.length += step.leaving.length;
                    if (step.vertex == at) break;
                    on_walk[step.vertex] = 0;
                    walk.pop_back();
                }
                diagnosis.border_loops.push_back(loop);
            } else {
                walk.push_back({at, {}});
                on_walk[at] = 1;
            }
            edge = no_index;
            // Used edges are skipped permanently: each list is traversed once, however many edges meet at a fan.
            const auto entries = std::lower_bound(at_fan.begin(), at_fan.end(), std::pair<Index, Index>{fan, 0});
            auto& passed = walked[static_cast<std::size_t>(entries - at_fan.begin())];
            auto i = entries + passed;
            while (i != at_fan.end() && i->first == fan && border[i->second].used) ++i;
            passed = static_cast<Index>(i - entries);
            if (i != at_fan.end() && i->first == fan) edge = i->second;
            if (edge == no_index) break;
            const bool forward = border[edge].first_fan == fan;
            fan = forward ? border[edge].second_fan : border[edge].first_fan;
            const Index next = border[edge].halfedge;
            at = forward ? target(soup, next) : origin(soup, next);
        }
        BorderLoop remainder;  // the remainder of a walk that ends at a non-manifold edge
        for (const Step& step : walk) {
            on_walk[step.vertex] = 0;
            if (&step == &walk.back()) break;
            remainder.edges += step.leaving.edges;
            remainder.length += step.leaving.length;
        }
        if (remainder.edges > 0) diagnosis.border_loops.push_back(remainder);
    }
    std::stable_sort(diagnosis.border_loops.begin(), diagnosis.border_loops.end(),
                     [](const BorderLoop& a, const BorderLoop& b) { return a.length > b.length; });
}

void examine_vertices(const TriangleSoup& soup, DisjointSets& fans, const std::vector<Index>& component,
                      MeshDiagnosis& diagnosis) {
    std::vector<std::uint8_t> fan_count(soup.points.size(), 0);
    for (Index c = 0; c < 3 * soup.triangles.size(); ++c) {
        if (component[c / 3] == no_index || fans.find(c) != c) continue;
        auto& count = fan_count[detail::origin(soup, c)];
        if (count < 2 && ++count == 2) ++diagnosis.components[component[c / 3]].nonmanifold_vertices;
    }
}

void measure(const TriangleSoup& soup, const std::vector<Index>& component, const std::vector<std::uint8_t>& without_area,
             MeshDiagnosis& diagnosis) {
    diagnosis.box = detail::box_of_triangles(soup);
    diagnosis.diagonal = detail::diagonal(diagnosis.box);
    const auto& box = diagnosis.box;
    const Point centre(box.xmin() / 2 + box.xmax() / 2, box.ymin() / 2 + box.ymax() / 2, box.zmin() / 2 + box.zmax() / 2);
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
        if (component[t] == no_index) continue;
        const auto& corners = soup.triangles[t];
        auto& part = diagnosis.components[component[t]];
        const double area = detail::area(soup, corners);
        part.area += area;
        part.volume += detail::sixfold_volume(soup, corners, centre) / 6;
        if (without_area[t] != 0) {
            ++diagnosis.degenerate_triangles;
            continue;
        }
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(
                longest, CGAL::squared_distance(detail::point(soup, corners[k]), detail::point(soup, corners[(k + 1) % 3])));
        if (2 * area < 1e-9 * diagnosis.diagonal * std::sqrt(longest)) ++diagnosis.thin_triangles;
    }
    for (const auto& part : diagnosis.components) {
        diagnosis.area += part.area;
        diagnosis.volume += part.volume;
        diagnosis.border_edges += part.border_edges;
        diagnosis.nonmanifold_edges += part.nonmanifold_edges;
        diagnosis.misoriented_edges += part.misoriented_edges;
        diagnosis.nonmanifold_vertices += part.nonmanifold_vertices;
        if (!part.orientable) ++diagnosis.nonorientable_components;
    }
}

/// Roles of the closed components: bodies and cavities, in the right orientation or not.
void find_roles(const TriangleSoup& soup, MeshDiagnosis& diagnosis) {
    if (diagnosis.components.size() == 1) {
        // One component needs no comparison with others.
        const auto& part = diagnosis.components.front();
        SolidBodies& solid = diagnosis.solid;
        const bool closed = part.closed() && part.misoriented_edges == 0 && part.orientable;
        // The sign of a volume below its rounding error is meaningless.
        const bool inward = closed && part.volume < -1e-13 * part.area * diagnosis.diagonal;
        solid.closed = closed ? 1 : 0, solid.inside_out = inward ? 1 : 0;
        solid.signed_volume = closed ? part.volume : 0, solid.volume = std::abs(solid.signed_volume);
        solid.roles = {inward ? SolidBodies::Role::inside_out : closed ? SolidBodies::Role::body : SolidBodies::Role::open};
    } else diagnosis.solid = solid_bodies(soup);
    for (Index c = 0; c < diagnosis.components.size(); ++c) {
        auto& part = diagnosis.components[c];
        part.inside_out = diagnosis.solid.roles[c] == SolidBodies::Role::inside_out;
        part.cavity = diagnosis.solid.roles[c] == SolidBodies::Role::cavity;
        part.turned_cavity = diagnosis.solid.roles[c] == SolidBodies::Role::turned_cavity;
        diagnosis.inside_out_components += part.inside_out ? 1 : 0;
        diagnosis.cavities += part.cavity ? 1 : 0;
        diagnosis.turned_cavities += part.turned_cavity ? 1 : 0;
    }
}

UnitGuess guess_unit(double diagonal) {
    if (!(diagonal > 0)) return {"unknown", "the object has no size"};
    if (diagonal < 0.01) return {"unknown", "diagonal under 0.01: scaled, or metres of something tiny"};
    if (diagonal < 4) return {"m", "diagonal from 0.01 to 4: metres, or scaled to about one"};
    if (diagonal < 10) return {"unknown", "diagonal from 4 to 10: too small for millimetres, large for metres"};
    if (diagonal < 5000) return {"mm", "diagonal from 10 to 5000: the millimetres of an object that can be handled"};
    if (diagonal < 5e6) return {"um", "diagonal from 5000 to 5 million: micrometres, or millimetres of a building"};
    return {"unknown", "diagonal above 5 million"};
}

}  // namespace

long long MeshDiagnosis::euler() const {
    long long sum = 0;
    for (const auto& part : components) sum += part.euler();
    return sum;
}

std::vector<std::string> MeshDiagnosis::defects() const {
    std::vector<std::string> descriptions;
    const auto add = [&](std::size_t count, const char* singular, const char* plural) {
        if (count > 0) descriptions.push_back(fmt::format("{} {}", count, count == 1 ? singular : plural));
    };
    if (triangles == repeated_corners) descriptions.emplace_back("no triangles");
    add(repeated_corners, "triangle that names a vertex twice", "triangles that name a vertex twice");
    add(degenerate_triangles, "triangle without area", "triangles without area");
    add(duplicate_triangles, "duplicate triangle", "duplicate triangles");
    add(border_edges, "border edge", "border edges");
    add(nonmanifold_edges, "non-manifold edge", "non-manifold edges");
    add(nonmanifold_vertices, "non-manifold vertex", "non-manifold vertices");
    add(misoriented_edges, "inconsistently oriented edge", "inconsistently oriented edges");
    add(nonorientable_components, "component that cannot be oriented", "components that cannot be oriented");
    add(inside_out_components, "component inside out", "components inside out");
    add(self_intersections, "pair of intersecting triangles", "pairs of intersecting triangles");
    if (self_intersections_checked && !self_intersections_complete)
        descriptions.emplace_back("the search for intersecting triangles was given up, there may be more");
    return descriptions;
}

MeshDiagnosis diagnose(const TriangleSoup& soup, const DiagnoseOptions& options) {
    MeshDiagnosis diagnosis;
    auto started = std::chrono::steady_clock::now();
    const auto lap = [&](const char* part) {
        check_cancelled();
        const auto now = std::chrono::steady_clock::now();
        diagnosis.seconds.emplace_back(part, std::chrono::duration<double>(now - started).count());
        started = now;
    };
    detail::check_soup(soup);
    diagnosis.vertices = soup.points.size();
    diagnosis.triangles = soup.triangles.size();
    const std::vector<Index> component = find_components(soup, diagnosis);
    lap("components");
    {
        const SoupEdges edges = detail::group_edges(soup);
        lap("edges");
        examine_edges(soup, edges, component, diagnosis);
        DisjointSets fans = detail::fans_of_corners(soup, edges);
        examine_vertices(soup, fans, component, diagnosis);
        examine_border(soup, edges, fans, diagnosis);
    }
    lap("topology");
    const std::vector<Index> place = detail::same_place(soup.points);
    for (Index v = 0; v < place.size(); ++v) diagnosis.duplicate_vertices += place[v] != v;
    lap("duplicate vertices");
    const auto without_area = detail::triangles_without_area(soup);
    measure(soup, component, without_area, diagnosis);
    find_roles(soup, diagnosis);
    diagnosis.unit = guess_unit(diagnosis.diagonal);
    lap("measures");
    diagnosis.oriented_box = oriented_box(soup.points);
    lap("oriented box");
    if (!options.skip_self_intersections) {
        const SelfIntersections intersections = detail::self_intersections(soup, place, without_area, 1'000'000);
        diagnosis.self_intersections_checked = true;
        diagnosis.self_intersections_complete = intersections.complete;
        diagnosis.self_intersections = intersections.pairs.size();
        diagnosis.self_intersection_examples.assign(
            intersections.pairs.begin(),
            intersections.pairs.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(10, intersections.pairs.size())));
        lap("self-intersections");
    }
    return diagnosis;
}

double crack_width(const TriangleSoup& soup) { return detail::crack_width(soup); }

void DiagnoseOptions::declare_options(OptionList& list) {
    list("skip-self-intersections", skip_self_intersections, "skip the search for self-intersections", Anything{});
}

}  // namespace ostraka
