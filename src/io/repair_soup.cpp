// The soup under repair: bookkeeping, merging of points, triangles that cannot stay, components.
#include "ostraka/geom/point_tree.h"
#include "repair_steps.h"
#include "soup_geometry.h"

#include <numeric>

namespace ostraka::detail {

Worksoup::Worksoup(const TriangleSoup& original)
    : soup(original),
      vertex_source(original.points.size()),
      face_source(original.triangles.size()),
      corner_like(original.triangles.size()),
      flipped(original.triangles.size(), 0),
      touched(original.points.size(), 0) {
    std::iota(vertex_source.begin(), vertex_source.end(), Index{0});
    std::iota(face_source.begin(), face_source.end(), Index{0});
    for (Index t = 0; t < corner_like.size(); ++t) corner_like[t] = {3 * t, 3 * t + 1, 3 * t + 2};
    vertex_like = merged_into = vertex_source;
    face_like = duplicate_of = face_source;
}

Index Worksoup::add_vertex(const std::array<double, 3>& place, Index source, Index like, bool is_touched) {
    soup.points.push_back(place);
    vertex_source.push_back(source);
    vertex_like.push_back(like);
    touched.push_back(is_touched ? 1 : 0);
    return static_cast<Index>(soup.points.size() - 1);
}

void Worksoup::add_triangle(const std::array<Index, 3>& corners, Index source, Index like,
                            const std::array<Index, 3>& corners_like, bool is_flipped) {
    soup.triangles.push_back(corners);
    face_source.push_back(source);
    face_like.push_back(like);
    corner_like.push_back(corners_like);
    flipped.push_back(is_flipped ? 1 : 0);
}

void Worksoup::flip(Index t) {
    std::swap(soup.triangles[t][1], soup.triangles[t][2]);
    std::swap(corner_like[t][1], corner_like[t][2]);
    flipped[t] ^= 1;
}

namespace {

/// Drops the elements of lists whose flag is zero.
template <class... Lists>
void keep_flagged(const std::vector<std::uint8_t>& keep, Lists&... lists) {
    const auto compact = [&](auto& list) {
        std::size_t next = 0;
        for (std::size_t i = 0; i < list.size(); ++i)
            if (keep[i] != 0) list[next++] = list[i];
        list.resize(next);
    };
    (compact(lists), ...);
}

}  // namespace

void Worksoup::keep_triangles(const std::vector<std::uint8_t>& keep) {
    keep_flagged(keep, soup.triangles, face_source, face_like, corner_like, flipped);
}

std::size_t Worksoup::drop_isolated(bool keep_original) {
    std::vector<std::uint8_t> keep(soup.points.size(), 0);
    for (const auto& t : soup.triangles)
        for (const Index v : t) keep[v] = 1;
    if (keep_original) {  // once: not the copies of vertices that were taken apart and rejoined
        std::vector<std::uint8_t> present(merged_into.size(), 0);
        for (std::size_t v = 0; v < keep.size(); ++v)
            if (keep[v] != 0 && vertex_source[v] != no_index) present[vertex_source[v]] = 1;
        for (std::size_t v = 0; v < keep.size(); ++v) {
            const Index source = vertex_source[v];
            if (source != no_index && merged_into[source] == source && present[source] == 0) keep[v] = present[source] = 1;
        }
    }
    std::vector<Index> renumbered(soup.points.size(), no_index);
    Index next = 0;
    for (std::size_t v = 0; v < keep.size(); ++v)
        if (keep[v] != 0) renumbered[v] = next++;
    keep_flagged(keep, soup.points, vertex_source, vertex_like, touched);
    for (auto& t : soup.triangles)
        for (Index& v : t) v = renumbered[v];
    return keep.size() - next;
}

std::vector<Index> pair_manifold(const TriangleSoup& soup) {
    const SoupEdges edges = group_edges(soup);
    std::vector<Index> opposite(3 * soup.triangles.size(), no_index);
    for (std::size_t e = 0; e < edges.count(); ++e) {
        const Index* h = edges.first(e);
        if (edges.valence(e) > 2 || (edges.valence(e) == 2 && origin(soup, h[0]) == origin(soup, h[1])))
            throw std::logic_error("repair: the soup should be manifold here");
        if (edges.valence(e) == 2) opposite[h[0]] = h[1], opposite[h[1]] = h[0];
    }
    return opposite;
}

namespace {

/// Vertices of components that are not closed: those may have to be joined to others.
std::vector<std::uint8_t> vertices_of_open_components(const TriangleSoup& soup) {
    DisjointSets sets = joined_vertices(soup);
    std::vector<std::uint8_t> open(soup.points.size(), 0);
    const SoupEdges edges = group_edges(soup);
    for (std::size_t e = 0; e < edges.count(); ++e)
        if (edges.valence(e) != 2) open[sets.find(origin(soup, *edges.first(e)))] = 1;
    for (Index v = 0; v < open.size(); ++v) open[v] = open[sets.find(v)];
    return open;
}

/// For each point the point it is merged into: the first one met (in index order) within the distance that was itself kept.
std::vector<Index> merge_near(const std::vector<std::array<double, 3>>& points, const std::vector<std::uint8_t>& candidate,
                              double distance) {
    std::vector<Index> into(points.size()), chosen, near;
    std::iota(into.begin(), into.end(), Index{0});
    std::vector<Point> places;
    for (Index v = 0; v < points.size(); ++v)
        if (candidate[v] != 0) {
            chosen.push_back(v);
            places.emplace_back(points[v][0], points[v][1], points[v][2]);
        }
    const PointTree tree(places);
    for (Index i = 0; i < chosen.size(); ++i) {
        if (into[chosen[i]] != chosen[i]) continue;
        tree.within(places[i], distance, near);
        for (const Index other : near)
            if (other > i && into[chosen[other]] == chosen[other]) into[chosen[other]] = chosen[i];
    }
    return into;
}

}  // namespace

Counts merge_points(Worksoup& work, double distance) {
    auto& soup = work.soup;
    const std::vector<std::uint8_t> open = vertices_of_open_components(soup);
    const std::vector<Index> place = same_place(soup.points);
    DisjointSets sets(soup.points.size());
    // Points at one place: only those of open components, so that closed solids that touch stay apart ...
    std::vector<Index> first_open(soup.points.size(), no_index);
    for (Index v = 0; v < soup.points.size(); ++v) {
        if (open[v] == 0) continue;
        Index& first = first_open[place[v]];
        if (first == no_index) first = v;
        else sets.unite(first, v);
    }
    // ... and the ends of edges without length, wherever they are.
    for (const auto& t : soup.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            if (t[k] != t[(k + 1) % 3] && place[t[k]] == place[t[(k + 1) % 3]]) sets.unite(t[k], t[(k + 1) % 3]);
    if (distance > 0) {
        // Border vertices only: merging inside a surface would eat its detail.
        std::vector<std::uint8_t> border(soup.points.size(), 0);
        TriangleSoup joined{soup.points, soup.triangles};
        for (auto& t : joined.triangles)
            for (Index& v : t) v = sets.find(v);
        const SoupEdges edges = group_edges(joined);
        for (std::size_t e = 0; e < edges.count(); ++e)
            if (edges.valence(e) == 1) border[origin(joined, *edges.first(e))] = border[target(joined, *edges.first(e))] = 1;
        const auto into = merge_near(soup.points, border, distance);
        for (Index v = 0; v < into.size(); ++v)
            if (into[v] != v) sets.unite(v, into[v]);
    }
    std::size_t merged = 0;
    for (Index v = 0; v < soup.points.size(); ++v) {
        work.merged_into[v] = sets.find(v);
        merged += work.merged_into[v] != v;
    }
    for (auto& t : soup.triangles)
        for (Index& v : t) v = work.merged_into[v];
    return {{"merged vertices", merged}};
}

Counts drop_bad_triangles(Worksoup& work) {
    auto& soup = work.soup;
    std::vector<std::uint8_t> keep(soup.triangles.size(), 1);
    std::size_t repeated = 0, duplicates = 0, walls = 0;
    for (std::size_t t = 0; t < keep.size(); ++t)
        if (repeats_corner(soup.triangles[t])) keep[t] = 0, ++repeated;

    // Same three vertices: equal sense is a duplicate; opposite sense is the wall between two solids, unless most of the
    // soup is doubled in that way, which is a sheet written once for each side.
    const SoupEdges edges = group_edges(soup);
    struct Entry {
        Index apex;
        bool reversed;
        Index triangle;
        auto operator<=>(const Entry&) const = default;
    };
    std::vector<Entry> group;
    std::vector<std::pair<Index, Index>> opposite_pairs;  // kept, other
    for (std::size_t e = 0; e < edges.count(); ++e) {
        if (edges.valence(e) < 2) continue;
        group.clear();
        for (Index i = 0; i < edges.valence(e); ++i) {
            const Index h = edges.first(e)[i], a = origin(soup, h), b = target(soup, h), c = apex(soup, h);
            if (c > a && c > b) group.push_back({c, a > b, h / 3});
        }
        std::sort(group.begin(), group.end());
        for (std::size_t i = 0; i < group.size();) {
            std::size_t j = i;
            std::array<Index, 2> kept{no_index, no_index};
            for (; j < group.size() && group[j].apex == group[i].apex; ++j) {
                Index& first = kept[group[j].reversed ? 1 : 0];
                if (first == no_index) {
                    first = group[j].triangle;
                    continue;
                }
                keep[group[j].triangle] = 0;
                work.duplicate_of[work.face_source[group[j].triangle]] = work.face_source[first];
                ++duplicates;
            }
            if (kept[0] != no_index && kept[1] != no_index)
                opposite_pairs.emplace_back(std::min(kept[0], kept[1]), std::max(kept[0], kept[1]));
            i = j;
        }
    }
    if (4 * opposite_pairs.size() > soup.triangles.size() - repeated - duplicates) {
        for (const auto& [first, second] : opposite_pairs) {
            keep[second] = 0;
            work.duplicate_of[work.face_source[second]] = work.face_source[first];
        }
        duplicates += opposite_pairs.size();
    } else {
        walls = opposite_pairs.size();
    }
    work.keep_triangles(keep);
    return {{"triangles that repeat a corner", repeated}, {"duplicate triangles", duplicates}, {"double walls kept", walls}};
}

Counts drop_components(Worksoup& work, bool only_largest, double smallest_share) {
    auto& soup = work.soup;
    DisjointSets sets = joined_vertices(soup);
    std::vector<double> share(soup.points.size(), 0);
    std::vector<std::uint8_t> has_triangle(soup.points.size(), 0);
    double total = 0;
    for (const auto& t : soup.triangles) {
        const double a = area(soup, t);
        share[sets.find(t[0])] += a;
        has_triangle[sets.find(t[0])] = 1;
        total += a;
    }
    Index largest = no_index;
    std::size_t count = 0, dropped = 0;
    for (Index v = 0; v < share.size(); ++v)
        if (has_triangle[v] != 0 && (largest == no_index || share[v] > share[largest])) largest = v;
    const auto stays = [&](Index root) {
        return only_largest ? root == largest : root == largest || share[root] >= smallest_share * total;
    };
    for (Index v = 0; v < share.size(); ++v)
        if (has_triangle[v] != 0) ++count, dropped += !stays(v);
    std::vector<std::uint8_t> keep(soup.triangles.size(), 1);
    for (std::size_t t = 0; t < keep.size(); ++t) keep[t] = stays(sets.find(soup.triangles[t][0])) ? 1 : 0;
    work.keep_triangles(keep);
    return {{"components", count}, {"dropped", dropped}};
}

}  // namespace ostraka::detail
