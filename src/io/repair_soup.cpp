// The soup under repair: bookkeeping, merging of points, invalid triangles, components.
#include "io/repair_steps.h"
#include "io/soup_geometry.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/point_tree.h"
#include "ostraka/mesh/flood.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace ostraka::detail {

RepairSoup::RepairSoup(const TriangleSoup& original)
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

Index RepairSoup::add_vertex(const std::array<double, 3>& position, Index source, Index like, bool is_touched) {
    soup.points.push_back(position);
    vertex_source.push_back(source);
    vertex_like.push_back(like);
    touched.push_back(is_touched ? 1 : 0);
    return static_cast<Index>(soup.points.size() - 1);
}

void RepairSoup::add_triangle(const std::array<Index, 3>& corners, Index source, Index like,
                              const std::array<Index, 3>& corners_like, bool is_flipped) {
    soup.triangles.push_back(corners);
    face_source.push_back(source);
    face_like.push_back(like);
    corner_like.push_back(corners_like);
    flipped.push_back(is_flipped ? 1 : 0);
}

void RepairSoup::flip(Index t) {
    std::swap(soup.triangles[t][1], soup.triangles[t][2]);
    std::swap(corner_like[t][1], corner_like[t][2]);
    flipped[t] ^= 1;
}

namespace {

/// Removes the elements of lists whose flag is zero.
template <class... Lists>
void keep_flagged(const std::vector<std::uint8_t>& keep, Lists&... lists) {
    const auto compact = [&](auto& values) {
        std::size_t next = 0;
        for (std::size_t i = 0; i < values.size(); ++i)
            if (keep[i] != 0) values[next++] = values[i];
        values.resize(next);
    };
    (compact(lists), ...);
}

}  // namespace

void RepairSoup::keep_triangles(const std::vector<std::uint8_t>& keep) {
    keep_flagged(keep, soup.triangles, face_source, face_like, corner_like, flipped);
}

std::size_t RepairSoup::drop_isolated(bool keep_original) {
    std::vector<std::uint8_t> keep(soup.points.size(), 0);
    for (const auto& t : soup.triangles)
        for (const Index v : t) keep[v] = 1;
    if (keep_original) {  // only once: not the copies of split vertices that were joined again
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

std::vector<Index> opposite_halfedges(const TriangleSoup& soup) {
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

/// Vertices of components that are not closed, which may have to be joined to others.
std::vector<std::uint8_t> vertices_of_open_components(const TriangleSoup& soup) {
    DisjointSets sets = joined_vertices(soup);
    std::vector<std::uint8_t> open(soup.points.size(), 0);
    const SoupEdges edges = group_edges(soup);
    for (std::size_t e = 0; e < edges.count(); ++e)
        if (edges.valence(e) != 2) open[sets.find(origin(soup, *edges.first(e)))] = 1;
    for (Index v = 0; v < open.size(); ++v) open[v] = open[sets.find(v)];
    return open;
}

/// For each border vertex, the length of its shortest edge, ignoring edges of length 0; 0 for other vertices.
std::vector<double> shortest_at_border(const TriangleSoup& soup) {
    const SoupEdges edges = group_edges(soup);
    std::vector<double> shortest(soup.points.size(), 0);
    for (std::size_t e = 0; e < edges.count(); ++e)
        if (edges.valence(e) == 1)
            shortest[origin(soup, *edges.first(e))] = shortest[target(soup, *edges.first(e))] =
                std::numeric_limits<double>::infinity();
    for (std::size_t e = 0; e < edges.count(); ++e) {
        const Index a = origin(soup, *edges.first(e)), b = target(soup, *edges.first(e));
        const double length = std::sqrt(CGAL::squared_distance(point(soup, a), point(soup, b)));
        if (length == 0) continue;
        shortest[a] = std::min(shortest[a], length);
        shortest[b] = std::min(shortest[b], length);
    }
    return shortest;
}

/// Border vertices, the length of the shortest edge at each, and the distance of the nearest other border vertex closer than a
/// given fraction of that length (its mate, on the other side of a crack); infinite if there is none.
struct Border {
    std::vector<Index> vertices;
    std::vector<Point> places;
    std::vector<double> shortest, mate;
};

Border find_border(const TriangleSoup& soup, double gap) {
    const std::vector<double> shortest = shortest_at_border(soup);
    Border border;
    for (Index v = 0; v < shortest.size(); ++v)
        if (shortest[v] > 0 && std::isfinite(shortest[v])) {
            border.vertices.push_back(v);
            border.places.push_back(point(soup, v));
            border.shortest.push_back(shortest[v]);
        }
    border.mate.assign(border.vertices.size(), std::numeric_limits<double>::infinity());
    const PointTree tree(border.places);
    parallel_for(border.mate.size(), [&](std::size_t i) {
        for (const auto& neighbour : tree.neighbours(border.places[i], 2))
            if (neighbour.index != i) border.mate[i] = std::min(border.mate[i], std::sqrt(neighbour.squared));
        if (border.mate[i] > gap * border.shortest[i]) border.mate[i] = std::numeric_limits<double>::infinity();
    });
    return border;
}

/// Upper bound of the distances between points that belong to one point of a torn surface: four times the distance within which
/// nine in ten of the points with a mate have it (for six random points in a cube, the nearest is within 0.5 sides in nine of
/// ten cases, the farthest within 1.7); 0 if less than the fraction `share` of the border has a mate.
double crack_of(const Border& border, double share) {
    std::vector<double> mates;
    for (const double mate : border.mate)
        if (std::isfinite(mate)) mates.push_back(mate);
    if (mates.empty() || static_cast<double>(mates.size()) < share * static_cast<double>(border.mate.size())) return 0;
    const auto rank = mates.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(mates.size() - 1));
    std::nth_element(mates.begin(), rank, mates.end());
    return 4 * *rank;
}

/// Clusters of border points; initially each point is its own cluster. A cluster never contains two corners of one triangle.
class PointClusters {
public:
    /// `number`: for each vertex of the soup, its number among the points; no_index if it has none.
    PointClusters(const TriangleSoup& soup, const std::vector<Index>& number, std::size_t count) : sets_(count), beside_(count) {
        for (const auto& t : soup.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const Index a = number[t[k]], b = number[t[(k + 1) % 3]];
                if (a == no_index || b == no_index || a == b) continue;
                beside_[a].push_back(b);
                beside_[b].push_back(a);
            }
    }

    /// Unites the clusters of two points, unless a triangle has corners in both.
    void unite(Index a, Index b) {
        a = sets_.find(a), b = sets_.find(b);
        if (a == b || !may_unite(a, b)) return;
        auto &merged = beside_[std::min(a, b)], &absorbed = beside_[std::max(a, b)];
        if (merged.size() < absorbed.size()) merged.swap(absorbed);
        merged.insert(merged.end(), absorbed.begin(), absorbed.end());
        std::vector<Index>().swap(absorbed);
        sets_.unite(a, b);  // the lower root stays
    }

    /// Unites a with q and b with p, the ends of two edges, unless a triangle has corners in both clusters of either pair.
    void unite_ends(Index a, Index q, Index b, Index p) {
        if (!may_unite(a, q) || !may_unite(b, p)) return;
        unite(a, q);
        unite(b, p);
    }

    Index find(Index i) { return sets_.find(i); }

private:
    bool may_unite(Index a, Index b) {
        a = sets_.find(a), b = sets_.find(b);
        if (a == b) return true;
        if (beside_[a].size() > beside_[b].size()) std::swap(a, b);
        return std::none_of(beside_[a].begin(), beside_[a].end(), [&](Index i) { return sets_.find(i) == b; });
    }

    DisjointSets sets_;
    std::vector<std::vector<Index>> beside_;  ///< for each root: points that share a triangle with a point of its cluster
};

/// Merges coincident border points where edges are as short as cracks are wide, so that distance alone does not distinguish
/// coincident points from neighbours: first the ends of pairs of opposite border edges, then single points; the nearest pairs
/// first, and never two corners of one triangle. `crack`: maximum distance of coincident points in the mesh's unit; 0: nothing
/// is done. Returns for each border vertex whether it is at such a position.
std::vector<std::uint8_t> merge_knots(const TriangleSoup& soup, const Border& border, const PointTree& tree, double crack,
                                      DisjointSets& sets) {
    const std::size_t count = border.vertices.size();
    constexpr std::size_t max_neighbours = 64;  // maximum number of neighbours examined per point, which
                                                // avoids quadratic time for large sets of coincident points
    std::vector<std::uint8_t> knotted(count, 0);
    std::vector<Index> starts;
    for (Index i = 0; i < count; ++i)
        if (border.shortest[i] < 3 * crack) knotted[i] = 1, starts.push_back(i);
    if (starts.empty()) return knotted;
    struct Pair {
        double squared;
        Index a, q, b, p;
        auto operator<=>(const Pair&) const = default;  // NOLINT(modernize-use-nullptr): false positive
    };
    std::vector<Pair> points, sides;
    flood(std::move(starts), knotted, [&](Index i, auto&& reach) {  // propagates to all points within a crack width
        for (const auto& neighbour : tree.neighbours(border.places[i], max_neighbours)) {
            if (neighbour.squared > crack * crack || neighbour.index == i) continue;
            points.push_back({neighbour.squared, std::min(i, neighbour.index), std::max(i, neighbour.index), 0, 0});
            reach(neighbour.index);
        }
    });
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());

    std::vector<Index> number(soup.points.size(), no_index);
    for (Index i = 0; i < count; ++i) number[border.vertices[i]] = i;
    std::vector<std::vector<Index>> successors(count), predecessors(count);  // other ends of the border edges at knots
    const SoupEdges edges = group_edges(soup);
    for (std::size_t e = 0; e < edges.count(); ++e) {
        if (edges.valence(e) != 1) continue;
        const Index a = number[origin(soup, *edges.first(e))], b = number[target(soup, *edges.first(e))];
        if (a == no_index || b == no_index) continue;
        if (knotted[a] != 0) successors[a].push_back(b);
        if (knotted[b] != 0) predecessors[b].push_back(a);
    }
    const auto match = [&](Index a, Index q, double squared) {  // a -> b and p -> q
        if (successors[a].size() * predecessors[q].size() > max_neighbours * max_neighbours) return;
        for (const Index b : successors[a])
            for (const Index p : predecessors[q]) {
                const double end_distance = CGAL::squared_distance(border.places[b], border.places[p]);
                if (end_distance <= crack * crack && b != p) sides.push_back({squared + end_distance, a, q, b, p});
            }
    };
    for (const Pair& pair : points) {
        match(pair.a, pair.q, pair.squared);
        match(pair.q, pair.a, pair.squared);
    }
    std::sort(sides.begin(), sides.end());
    PointClusters clusters(soup, number, count);
    for (const Pair& pair : sides) clusters.unite_ends(pair.a, pair.q, pair.b, pair.p);
    for (const Pair& pair : points) clusters.unite(pair.a, pair.q);
    for (Index i = 0; i < count; ++i) sets.unite(border.vertices[clusters.find(i)], border.vertices[i]);
    return knotted;
}

/// Merges border vertices that are closer than `limits.distance` or lie across a crack. Vertices are processed by index; each
/// is united with the nearby vertices that are not merged yet. Where edges are as short as cracks are wide, `settle_knots` is
/// used instead. Returns the width of cracks.
double merge_near(const TriangleSoup& soup, const MergeDistances& limits, DisjointSets& sets) {
    // Border vertices only: merging interior vertices would destroy detail.
    TriangleSoup joined = soup;
    for (auto& t : joined.triangles)
        for (Index& v : t) v = sets.find(v);
    const Border border = find_border(joined, limits.gap);
    const double crack = crack_of(border, 0.5);
    const PointTree tree(border.places);
    const std::vector<std::uint8_t> knotted = merge_knots(joined, border, tree, crack, sets);
    const auto radius = [&](Index i) {
        return std::max(limits.distance, knotted[i] != 0 ? 0 : std::min(crack, border.shortest[i] / 2));
    };
    std::vector<Index> nearby;
    std::vector<std::uint8_t> merged(border.vertices.size(), 0);
    for (Index i = 0; i < merged.size(); ++i) {
        if (merged[i] != 0 || radius(i) == 0) continue;
        tree.within(border.places[i], radius(i), nearby);
        for (const Index other : nearby) {
            if (other <= i || merged[other] != 0) continue;
            const double separation = std::sqrt(CGAL::squared_distance(border.places[i], border.places[other]));
            if (separation > radius(other)) continue;
            merged[other] = 1;
            sets.unite(border.vertices[i], border.vertices[other]);
        }
    }
    return crack;
}

}  // namespace

Counts merge_points(RepairSoup& work, const MergeDistances& limits, double& crack) {
    auto& soup = work.soup;
    const std::vector<std::uint8_t> in_open_component = vertices_of_open_components(soup);
    const std::vector<Index> place = same_place(soup.points);
    DisjointSets sets(soup.points.size());
    // Coincident points: only those of open components, so that touching closed solids stay separate ...
    std::vector<Index> first_open(soup.points.size(), no_index);
    for (Index v = 0; v < soup.points.size(); ++v) {
        if (in_open_component[v] == 0) continue;
        Index& representative = first_open[place[v]];
        if (representative == no_index) representative = v;
        else sets.unite(representative, v);
    }
    // ... and the ends of all edges of length 0.
    for (const auto& t : soup.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            if (t[k] != t[(k + 1) % 3] && place[t[k]] == place[t[(k + 1) % 3]]) sets.unite(t[k], t[(k + 1) % 3]);
    crack = limits.distance > 0 || limits.gap > 0 ? merge_near(soup, limits, sets) : 0;
    std::size_t merged = 0;
    for (Index v = 0; v < soup.points.size(); ++v) {
        work.merged_into[v] = sets.find(v);
        merged += work.merged_into[v] != v;
    }
    for (auto& t : soup.triangles)
        for (Index& v : t) v = work.merged_into[v];
    return {{"merged vertices", merged}};
}

double crack_width(const TriangleSoup& soup) { return crack_of(find_border(soup, 0.5), 0.9); }

Counts sew_junctions(RepairSoup& work, double tolerance) {
    auto& soup = work.soup;
    std::size_t sewn = 0;
    constexpr int max_passes = 8;  // each pass splits a triangle at one of its sides
    for (int pass = 0; pass < max_passes; ++pass) {
        check_cancelled();
        const SoupEdges edges = group_edges(soup);
        std::vector<Index> sides, vertices;
        for (std::size_t e = 0; e < edges.count(); ++e) {
            if (edges.valence(e) != 1) continue;
            const Index h = *edges.first(e);
            sides.push_back(h);
            vertices.insert(vertices.end(), {origin(soup, h), target(soup, h)});
        }
        std::sort(sides.begin(), sides.end());
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        std::vector<Point> positions;
        for (const Index v : vertices) positions.push_back(point(soup, v));
        const PointTree tree(positions);
        std::vector<std::vector<std::pair<double, Index>>> junctions(sides.size());  // position along the side, vertex
        parallel_for(sides.size(), [&](std::size_t i) {
            const Index h = sides[i];
            const Point a = point(soup, origin(soup, h)), b = point(soup, target(soup, h));
            const double length = std::sqrt(CGAL::squared_distance(a, b)), margin = std::min(tolerance, length / 4);
            if (length == 0) return;
            const Vector along = (b - a) / length;
            std::vector<Index> nearby;
            tree.within(CGAL::midpoint(a, b), length / 2, nearby);
            for (const Index n : nearby) {
                const Index v = vertices[n];
                const double position = (positions[n] - a) * along;
                if (position <= margin || position >= length - margin || v == apex(soup, h)) continue;
                if ((positions[n] - (a + position * along)).squared_length() <= tolerance * tolerance)
                    junctions[i].emplace_back(position, v);
            }
            std::sort(junctions[i].begin(), junctions[i].end());
        });
        std::vector<std::uint8_t> split(soup.triangles.size(), 0);
        std::size_t inserted = 0;
        for (std::size_t i = 0; i < sides.size(); ++i) {
            const Index t = sides[i] / 3, k = sides[i] % 3;
            if (junctions[i].empty() || split[t] != 0) continue;
            split[t] = 1;
            inserted += junctions[i].size();
            const auto corners = soup.triangles[t];
            const auto like = work.corner_like[t];
            const Index b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
            // (a, b, c) becomes (a, m, c), (m, n, c), ..., (n, b, c).
            soup.triangles[t][(k + 1) % 3] = junctions[i].front().second;
            work.corner_like[t][(k + 1) % 3] = like[k];
            for (std::size_t m = 0; m < junctions[i].size(); ++m) {
                const bool last = m + 1 == junctions[i].size();
                work.add_triangle({junctions[i][m].second, last ? b : junctions[i][m + 1].second, c}, work.face_source[t],
                                  work.face_like[t], {like[k], last ? like[(k + 1) % 3] : like[k], like[(k + 2) % 3]},
                                  work.flipped[t] != 0);
            }
        }
        if (inserted == 0) break;
        sewn += inserted;
    }
    return {{"vertices inserted into sides beside them", sewn}};
}

namespace {

/// Two triangles (indices) with the same three vertices and opposite orientations.
using OppositePair = std::pair<Index, Index>;

/// Among triangles with the same three vertices, keeps the first of each orientation; returns the number of dropped ones. Pairs
/// that remain in both orientations are appended to `opposite`.
std::size_t drop_repeated(RepairSoup& work, const SoupEdges& edges, std::vector<std::uint8_t>& keep,
                          std::vector<OppositePair>& opposite) {
    const auto& soup = work.soup;
    struct Entry {
        Index apex;
        bool reversed;
        Index triangle;
        auto operator<=>(const Entry&) const = default;  // NOLINT(modernize-use-nullptr): false positive
    };
    std::vector<Entry> group;
    std::size_t dropped = 0;
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
            std::array<Index, 2> kept_triangles{no_index, no_index};
            for (; j < group.size() && group[j].apex == group[i].apex; ++j) {
                Index& first = kept_triangles[group[j].reversed ? 1 : 0];
                if (first == no_index) {
                    first = group[j].triangle;
                    continue;
                }
                keep[group[j].triangle] = 0;
                work.duplicate_of[work.face_source[group[j].triangle]] = work.face_source[first];
                ++dropped;
            }
            if (kept_triangles[0] != no_index && kept_triangles[1] != no_index)
                opposite.emplace_back(std::min(kept_triangles[0], kept_triangles[1]),
                                      std::max(kept_triangles[0], kept_triangles[1]));
            i = j;
        }
    }
    return dropped;
}

/// Decides which pairs represent a single triangle of a surface (1: keep its first, 2: keep its second). If the number of other
/// triangles at an edge is odd, one more triangle closes the surface there; if it is even, the pair is the wall between two
/// solids (0). Adjacent pairs are decided together, by the majority of the edges around them. Of a pair, the triangle with the
/// orientation of its neighbours is kept.
std::vector<std::uint8_t> single_sides(const TriangleSoup& soup, const SoupEdges& edges, const std::vector<std::uint8_t>& keep,
                                       const std::vector<OppositePair>& pairs) {
    std::vector<Index> pair_of(soup.triangles.size(), no_index);
    for (Index p = 0; p < pairs.size(); ++p) pair_of[pairs[p].first] = pair_of[pairs[p].second] = p;
    DisjointSets patches(pairs.size());
    std::vector<int> odd_excess(pairs.size(), 0), first_agrees(pairs.size(), 0);
    std::vector<Index> pair_halfedges;
    for (std::size_t e = 0; e < edges.count(); ++e) {
        pair_halfedges.clear();
        std::size_t other_count = 0;
        Index other = no_index;
        for (Index i = 0; i < edges.valence(e); ++i) {
            const Index h = edges.first(e)[i];
            if (keep[h / 3] == 0) continue;
            if (const Index p = pair_of[h / 3]; p == no_index) ++other_count, other = h;
            else if (h / 3 == pairs[p].first) pair_halfedges.push_back(h);
        }
        if (pair_halfedges.size() == 2 && other_count % 2 == 0)
            patches.unite(pair_of[pair_halfedges[0] / 3], pair_of[pair_halfedges[1] / 3]);
        if (pair_halfedges.size() != 1 || other_count == 0) continue;
        const Index p = pair_of[pair_halfedges[0] / 3];
        odd_excess[p] += other_count % 2 == 1 ? 1 : -1;
        if (other_count == 1) first_agrees[p] += origin(soup, pair_halfedges[0]) == target(soup, other) ? 1 : -1;
    }
    for (Index p = 0; p < pairs.size(); ++p)
        if (const Index root = patches.find(p); root != p) odd_excess[root] += odd_excess[p];
    std::vector<std::uint8_t> side(pairs.size(), 0);
    for (Index p = 0; p < pairs.size(); ++p)
        if (odd_excess[patches.find(p)] > 0) side[p] = first_agrees[p] >= 0 ? 1 : 2;
    return side;
}

}  // namespace

Counts drop_invalid_triangles(RepairSoup& work) {
    const auto& soup = work.soup;
    std::vector<std::uint8_t> keep(soup.triangles.size(), 1);
    std::size_t repeated = 0, walls = 0;
    for (std::size_t t = 0; t < keep.size(); ++t)
        if (repeats_corner(soup.triangles[t])) keep[t] = 0, ++repeated;
    const SoupEdges edges = group_edges(soup);
    std::vector<OppositePair> opposite;
    std::size_t duplicates = drop_repeated(work, edges, keep, opposite);
    // If most of the soup is doubled, it is a sheet with a triangle for each side.
    const bool sheet = 4 * opposite.size() > soup.triangles.size() - repeated - duplicates;
    const std::vector<std::uint8_t> side =
        sheet ? std::vector<std::uint8_t>(opposite.size(), 1) : single_sides(soup, edges, keep, opposite);
    for (std::size_t p = 0; p < opposite.size(); ++p) {
        if (side[p] == 0) {
            ++walls;
            continue;
        }
        const auto [kept, dropped] = side[p] == 1 ? opposite[p] : OppositePair(opposite[p].second, opposite[p].first);
        keep[dropped] = 0;
        work.duplicate_of[work.face_source[dropped]] = work.face_source[kept];
        ++duplicates;
    }
    work.keep_triangles(keep);
    return {{"triangles that repeat a corner", repeated}, {"duplicate triangles", duplicates}, {"double walls kept", walls}};
}

Counts drop_components(RepairSoup& work, bool only_largest, double smallest_share) {
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
