#include "io/formats.h"
#include "ostraka/mesh/disjoint_sets.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

namespace ostraka::io {

namespace {

/// For each vertex, the first vertex with the same coordinates.
std::vector<Index> first_at_place(const std::vector<std::array<double, 3>>& points) {
    std::vector<Index> order(points.size()), first(points.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::sort(order.begin(), order.end(),
              [&](Index a, Index b) { return points[a] != points[b] ? points[a] < points[b] : a < b; });
    for (std::size_t i = 0; i < order.size(); ++i)
        first[order[i]] = i > 0 && points[order[i]] == points[order[i - 1]] ? first[order[i - 1]] : order[i];
    return first;
}

/// A border edge of the polygons, traversed from `from` to `to`.
struct BorderEdge {
    Index from, to;              ///< vertices
    Index from_place, to_place;  ///< the first vertices at the same places
};

/// The edges that only one polygon traverses, in whichever direction.
std::vector<BorderEdge> border_edges(const PolygonSoup& soup, const std::vector<Index>& place) {
    struct Side {
        Index low, high;
        bool forward;
    };
    std::vector<Side> sides;
    sides.reserve(soup.corners.size());
    for (std::size_t i = 0; i < soup.polygon_count(); ++i) {
        const Index begin = soup.polygon_begin[i], end = soup.polygon_begin[i + 1];
        for (Index k = begin; k < end; ++k) {
            const Index a = soup.corners[k], b = soup.corners[k + 1 < end ? k + 1 : begin];
            if (place[a] != place[b]) sides.push_back({std::min(a, b), std::max(a, b), a < b});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.forward) < std::tie(b.low, b.high, b.forward);
    });
    std::vector<BorderEdge> borders;
    for (std::size_t i = 0, next = 0; i < sides.size(); i = next) {
        while (next < sides.size() && sides[next].low == sides[i].low && sides[next].high == sides[i].high) ++next;
        if (next - i > 1) continue;
        const Index from = sides[i].forward ? sides[i].low : sides[i].high, to = sides[i].forward ? sides[i].high : sides[i].low;
        borders.push_back({from, to, place[from], place[to]});
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
    for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
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
