#include "io/formats.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/mesh/disjoint_sets.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <numeric>

namespace ostraka::io {

namespace {

/// A number from the coordinates of a point, the same for 0 and -0.
std::uint64_t hash_of(const std::array<double, 3>& point) {
    std::uint64_t hash = 0;
    for (const double x : point) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(x + 0.0)) * 0x9E3779B97F4A7C15U;  // -0 + 0 is 0
        hash ^= hash >> 32U;
    }
    return hash;
}

/// For each vertex, the first vertex with the same coordinates. Points are put into buckets by a hash of their coordinates, and
/// sorted within each bucket.
std::vector<Index> first_by_sorting(const std::vector<std::array<double, 3>>& points) {
    const std::size_t count = points.size();
    const auto bits = static_cast<unsigned>(std::bit_width(std::max<std::size_t>(count, 2)));
    std::vector<std::uint32_t> bucket_of(count);
    parallel_for(count, [&](std::size_t v) {
        bucket_of[v] = static_cast<std::uint32_t>(hash_of(points[v]) * 0x9E3779B97F4A7C15U >> (64 - bits));
    });
    std::vector<Index> begin((std::size_t{1} << bits) + 1, 0), order(count), first(count);
    for (const std::uint32_t bucket : bucket_of) ++begin[bucket + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (std::size_t v = 0; v < count; ++v) order[begin[bucket_of[v]]++] = static_cast<Index>(v);  // begin becomes the ends
    parallel_for(begin.size() - 1, [&](std::size_t bucket) {
        const auto from = order.begin() + (bucket == 0 ? 0 : begin[bucket - 1]), to = order.begin() + begin[bucket];
        if (to - from > 1)
            std::sort(from, to, [&](Index a, Index b) { return points[a] != points[b] ? points[a] < points[b] : a < b; });
        for (auto i = from; i != to; ++i) first[*i] = i != from && points[*i] == points[*(i - 1)] ? first[*(i - 1)] : *i;
    });
    return first;
}

/// The same from a table of hashes with open addressing. Files whose coordinates collide there get the result by sorting.
std::vector<Index> first_at_place(const std::vector<std::array<double, 3>>& points) {
    struct Slot {
        std::uint32_t tag;
        Index vertex = no_index;
    };
    constexpr std::size_t batch = 16;  // slots of so many points are fetched from memory together
    const std::size_t count = points.size();
    const auto bits = static_cast<unsigned>(std::bit_width(std::max<std::size_t>(count, 2)) + 1);
    const std::size_t mask = (std::size_t{1} << bits) - 1;
    std::vector<Slot> slots(mask + 1);
    std::vector<Index> first(count);
    std::size_t probes_left = 16 * count + 1000;
    std::array<std::uint64_t, batch> hashes{};
    for (std::size_t begin = 0; begin < count; begin += batch) {
        const std::size_t end = std::min(begin + batch, count);
        for (std::size_t v = begin; v < end; ++v) {
            hashes[v - begin] = hash_of(points[v]) * 0x9E3779B97F4A7C15U;
            __builtin_prefetch(&slots[hashes[v - begin] >> (64 - bits)]);
        }
        for (std::size_t v = begin; v < end; ++v) {
            std::size_t place = hashes[v - begin] >> (64 - bits);
            const auto tag = static_cast<std::uint32_t>(hashes[v - begin]);
            const auto is_other = [&](const Slot& slot) {
                return slot.vertex != no_index && (slot.tag != tag || points[slot.vertex] != points[v]);
            };
            while (is_other(slots[place])) {
                if (--probes_left == 0) return first_by_sorting(points);
                place = (place + 1) & mask;
            }
            if (slots[place].vertex == no_index) slots[place] = {tag, static_cast<Index>(v)};
            first[v] = slots[place].vertex;
        }
    }
    return first;
}

/// A border edge of the polygons, traversed from `from` to `to`.
struct BorderEdge {
    Index from, to;              ///< vertices
    Index from_place, to_place;  ///< the first vertices at the same places
};

/// The edges that only one polygon traverses, in whichever direction, and of which at least one end point is doubled. Sides of
/// polygons are put into one bucket per smaller end point, and sorted within each bucket.
std::vector<BorderEdge> border_edges(const PolygonSoup& soup, const std::vector<Index>& place) {
    std::vector<std::uint8_t> doubled(place.size(), 0);
    for (std::size_t v = 0; v < place.size(); ++v)
        if (place[v] != v) doubled[v] = doubled[place[v]] = 1;
    std::vector<std::array<Index, 2>> edges;
    for (std::size_t i = 0; i < soup.polygon_count(); ++i) {
        const Index first = soup.polygon_begin[i], last = soup.polygon_begin[i + 1];
        std::uint8_t any_doubled = 0;
        for (Index k = first; k < last; ++k) any_doubled |= doubled[soup.corners[k]];
        for (Index k = first; k < last && any_doubled != 0; ++k) {
            const Index a = soup.corners[k], b = soup.corners[k + 1 < last ? k + 1 : first];
            if ((doubled[a] | doubled[b]) != 0 && place[a] != place[b]) edges.push_back({a, b});
        }
    }
    struct Side {
        Index high;
        bool forward;  ///< from the smaller to the larger end point
    };
    std::vector<Index> end(place.size() + 1, 0);
    for (const auto& [a, b] : edges) ++end[std::min(a, b) + 1];
    std::partial_sum(end.begin(), end.end(), end.begin());
    std::vector<Side> sides(end.back());
    for (const auto& [a, b] : edges) sides[end[std::min(a, b)]++] = {std::max(a, b), a < b};
    std::vector<BorderEdge> borders;
    for (std::size_t low = 0; low < place.size(); ++low) {
        const std::size_t from = low == 0 ? 0 : end[low - 1], to = end[low];
        std::sort(sides.begin() + static_cast<std::ptrdiff_t>(from), sides.begin() + static_cast<std::ptrdiff_t>(to),
                  [](const Side& a, const Side& b) { return a.high < b.high; });
        for (std::size_t i = from, next = from; i < to; i = next) {
            while (next < to && sides[next].high == sides[i].high) ++next;
            if (next - i > 1) continue;
            const auto v = static_cast<Index>(low);
            const Index start = sides[i].forward ? v : sides[i].high, target = sides[i].forward ? sides[i].high : v;
            borders.push_back({start, target, place[start], place[target]});
        }
    }
    return borders;
}

/// Unites the vertices of border edges that have the same end points, where there are exactly two, in opposite directions.
void unite_coincident(std::vector<BorderEdge>& borders, DisjointSets& sets) {
    const auto ends = [](const BorderEdge& edge) { return std::minmax(edge.from_place, edge.to_place); };
    std::sort(borders.begin(), borders.end(), [&](const BorderEdge& a, const BorderEdge& b) {
        return ends(a) != ends(b) ? ends(a) < ends(b) : std::tie(a.from, a.to) < std::tie(b.from, b.to);
    });
    for (std::size_t i = 0, next = 0; i < borders.size(); i = next) {
        while (next < borders.size() && ends(borders[next]) == ends(borders[i])) ++next;
        if (next - i != 2 || borders[i].from_place == borders[i + 1].from_place) continue;
        sets.unite(borders[i].from, borders[i + 1].to);
        sets.unite(borders[i].to, borders[i + 1].from);
    }
}

/// Keeps the entries of the kept vertices.
template <class Value>
void keep_entries(std::vector<Value>& values, const std::vector<Index>& kept) {
    if (values.empty()) return;
    std::size_t i = 0;
    while (i < kept.size() && kept[i] == i) ++i;
    for (; i < kept.size(); ++i) values[i] = values[kept[i]];
    values.resize(kept.size());
}

}  // namespace

void join_seams(PolygonSoup& soup) {
    const std::size_t count = soup.points.size();
    const std::vector<Index> place = first_at_place(soup.points);
    bool doubled = false;
    for (std::size_t v = 0; v < count; ++v) doubled = doubled || place[v] != v;
    if (!doubled) return;
    std::vector<BorderEdge> borders = border_edges(soup, place);
    DisjointSets sets(count);
    unite_coincident(borders, sets);
    std::vector<Index> kept, vertex(count);
    kept.reserve(count);
    for (std::size_t v = 0; v < count; ++v)
        if (sets.find(v) == v) {
            vertex[v] = static_cast<Index>(kept.size());
            kept.push_back(static_cast<Index>(v));
        }
    if (kept.size() == count) return;
    for (std::size_t v = 0; v < count; ++v) vertex[v] = vertex[sets.find(v)];
    auto& colours = soup.extras.vertex_colours;
    std::size_t other_colours = 0;
    for (std::size_t v = 0; v < colours.size(); ++v) other_colours += colours[v] != colours[kept[vertex[v]]];
    for (Index& corner : soup.corners) corner = vertex[corner];
    keep_entries(soup.points, kept);
    keep_entries(colours, kept);
    keep_entries(soup.extras.vertex_labels, kept);
    for (NamedValues& column : soup.extras.vertex_values) keep_entries(column.values, kept);
    soup.notes.push_back(fmt::format("{} vertices that the file doubles along seams of the texture or of shading were joined",
                                     count - kept.size()));
    if (other_colours > 0)
        soup.notes.push_back(fmt::format("{} of them had another colour than the vertex they were joined to", other_colours));
    if (soup.vertex_of_file_vertex.empty()) {
        soup.vertex_of_file_vertex = std::move(vertex);
    } else {
        for (Index& v : soup.vertex_of_file_vertex)
            if (v != no_index) v = vertex[v];
    }
}

TexturedVertices textured_vertices(const TriangleSoup& soup, const std::vector<TexturePoint>& corner_texture) {
    const std::size_t vertex_count = soup.points.size();
    // Corners of each vertex, in the order of the triangles.
    std::vector<std::size_t> begin(vertex_count + 1, 0);
    for (const auto& triangle : soup.triangles)
        for (const Index v : triangle) ++begin[v + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<Index> corner_of(begin.back());
    std::vector<std::size_t> end(begin.begin(), begin.end() - 1);
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) corner_of[end[soup.triangles[t][k]]++] = static_cast<Index>(3 * t + k);
    TexturedVertices result;
    result.pair_of_corner.resize(3 * soup.triangles.size());
    std::vector<Index> firsts;  // the first corner of each pair of a vertex
    for (std::size_t v = 0; v < vertex_count; ++v) {
        const auto first = corner_of.begin() + static_cast<std::ptrdiff_t>(begin[v]),
                   last = corner_of.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]);
        if (first == last) {
            result.vertex.push_back(static_cast<Index>(v));
            result.texture.push_back({0, 0});
            continue;
        }
        std::sort(first, last, [&](Index a, Index b) {
            return corner_texture[a] != corner_texture[b] ? corner_texture[a] < corner_texture[b] : a < b;
        });
        firsts.clear();
        for (auto corner = first; corner != last; ++corner)
            if (corner == first || corner_texture[*corner] != corner_texture[*(corner - 1)]) firsts.push_back(*corner);
        std::vector<Index> ordered = firsts;
        std::sort(ordered.begin(), ordered.end());
        for (const Index corner : ordered) {
            result.pair_of_corner[corner] = static_cast<Index>(result.vertex.size());
            result.vertex.push_back(static_cast<Index>(v));
            result.texture.push_back(corner_texture[corner]);
        }
        for (auto corner = first, start = first; corner != last; ++corner) {
            if (corner_texture[*corner] != corner_texture[*start]) start = corner;
            result.pair_of_corner[*corner] = result.pair_of_corner[*start];
        }
    }
    return result;
}

}  // namespace ostraka::io
