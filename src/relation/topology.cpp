#include "ostraka/relation/topology.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/curves.h"

#include <bit>
#include <numeric>
#include <unordered_map>

namespace ostraka {

namespace {

using Bits = std::vector<std::uint64_t>;

/// A square table of bits.
class BitTable {
public:
    BitTable(std::size_t rows, std::size_t columns) : words_((columns + 63) / 64), bits_(rows * words_, 0) {}
    [[nodiscard]] std::uint64_t* row(std::size_t r) { return bits_.data() + r * words_; }
    [[nodiscard]] const std::uint64_t* row(std::size_t r) const { return bits_.data() + r * words_; }
    [[nodiscard]] bool test(std::size_t r, std::size_t c) const { return (row(r)[c / 64] >> (c % 64) & 1U) != 0; }
    void set(std::size_t r, std::size_t c) { row(r)[c / 64] |= std::uint64_t{1} << (c % 64); }
    void clear(std::size_t r, std::size_t c) { row(r)[c / 64] &= ~(std::uint64_t{1} << (c % 64)); }
    void fill(std::size_t r) { std::fill_n(row(r), words_, ~std::uint64_t{0}); }
    void zero(std::size_t r) { std::fill_n(row(r), words_, 0); }
    void keep(std::size_t r, const Bits& mask) {
        for (std::size_t w = 0; w < words_; ++w) row(r)[w] &= mask[w];
    }
    void add(std::size_t r, const std::uint64_t* mask) {
        for (std::size_t w = 0; w < words_; ++w) row(r)[w] |= mask[w];
    }
    [[nodiscard]] std::size_t words() const { return words_; }
    template <class Visit>
    void each(std::size_t r, Visit&& visit) const {
        for (std::size_t w = 0; w < words_; ++w)
            for (std::uint64_t left = row(r)[w]; left != 0; left &= left - 1)
                visit(w * 64 + static_cast<std::size_t>(std::countr_zero(left)));
    }

private:
    std::size_t words_;
    std::vector<std::uint64_t> bits_;
};

void mark(Bits& bits, std::size_t i) { bits[i / 64] |= std::uint64_t{1} << (i % 64); }

/// Faces grouped by the set of regions that hold them. Class 0 is the empty set; each other class is its parent's set and one
/// region more.
struct FaceClasses {
    std::vector<std::uint32_t> of_face;
    std::vector<std::uint32_t> parent{0}, region{0};

    FaceClasses(const Mesh& mesh, const AnnotationSet& set) : of_face(mesh.number_of_faces(), 0) {
        std::vector<std::uint32_t> split_by{0}, split_to{0};  // region place + 1, new class
        for (std::uint32_t r = 0; r < set.annotations.size(); ++r)
            for (const Index face : set.annotations[r].faces) {
                std::uint32_t& of = of_face[face];
                if (split_by[of] != r + 1) {
                    split_by[of] = r + 1;
                    split_to[of] = static_cast<std::uint32_t>(parent.size());
                    parent.push_back(of);
                    region.push_back(r);
                    split_by.push_back(0);
                    split_to.push_back(0);
                }
                of = split_to[of];
            }
    }
    /// What free outlines that are one up to rounding leave between them: less than a millionth of each region there. Its faces
    /// go to the regions' neighbours over their longest edge, which say nothing else.
    void drop_slivers(const Mesh& mesh, const AnnotationSet& set) {
        std::vector<double> area(parent.size(), 0), of_region(set.annotations.size(), 0);
        for (const Face f : mesh.faces()) {
            const double part = face_area(mesh, f);
            area[of_face[f]] += part;
            for (std::uint32_t c = of_face[f]; c != 0; c = parent[c]) of_region[region[c]] += part;
        }
        std::vector<bool> sliver(parent.size(), false);
        const double whole = std::accumulate(area.begin(), area.end(), 0.0);
        for (std::uint32_t c = 0; c < parent.size(); ++c) {
            double least = whole;
            for (const std::uint32_t r : regions(c)) least = std::min(least, of_region[r]);
            sliver[c] = area[c] < 1e-6 * least;
        }
        for (int round = 0; round < 3; ++round)  // slivers lie in rows
            for (const Face f : mesh.faces()) {
                if (!sliver[of_face[f]]) continue;
                double longest = -1;
                for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(f))) {
                    const Face g = mesh.face(mesh.opposite(h));
                    if (g == Mesh::null_face() || sliver[of_face[g]]) continue;
                    const double length = CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h)));
                    if (length > longest) longest = length, of_face[f] = of_face[g];
                }
            }
    }
    /// Ascending.
    [[nodiscard]] std::vector<std::uint32_t> regions(std::uint32_t c) const {
        std::vector<std::uint32_t> list;
        for (; c != 0; c = parent[c]) list.push_back(region[c]);
        std::reverse(list.begin(), list.end());
        return list;
    }
};

using VertexPair = std::pair<Index, Index>;

/// Which points and lines hold a vertex, and which lines hold an edge.
struct CurveIndex {
    std::unordered_map<Index, std::vector<std::size_t>> at_vertex;
    std::map<VertexPair, std::vector<std::size_t>> at_edge;
    std::vector<std::vector<VertexPair>> edges;  ///< of each annotation, sorted, once each

    explicit CurveIndex(const AnnotationSet& set) : edges(set.annotations.size()) {
        const auto hold = [](std::vector<std::size_t>& list, std::size_t a) {
            if (list.empty() || list.back() != a) list.push_back(a);
        };
        for (std::size_t a = 0; a < set.annotations.size(); ++a) {
            const Annotation& annotation = set.annotations[a];
            for (const Index v : annotation.points) hold(at_vertex[v], a);
            for (const auto& polyline : annotation.polylines)
                for (std::size_t i = 0; i < polyline.size(); ++i) {
                    hold(at_vertex[polyline[i]], a);
                    if (i > 0) edges[a].push_back(std::minmax(polyline[i - 1], polyline[i]));
                }
            std::sort(edges[a].begin(), edges[a].end());
            edges[a].erase(std::unique(edges[a].begin(), edges[a].end()), edges[a].end());
            for (const auto& edge : edges[a]) at_edge[edge].push_back(a);
        }
    }
};

/// contains.row(a): all whose selection holds that of a, itself included; overlaps: regions with a common face.
struct Containments {
    BitTable contains, overlaps;
    std::vector<bool> empty;
};

Containments contain(const Mesh& mesh, const AnnotationSet& set, const FaceClasses& classes) {
    const std::size_t n = set.annotations.size();
    Containments result{BitTable(n, n), BitTable(n, n), std::vector<bool>(n, false)};
    BitTable& contains = result.contains;
    const std::size_t words = contains.words();
    for (std::size_t a = 0; a < n; ++a) contains.fill(a);

    // Regions in regions: the intersection of the sets of all their faces.
    std::vector<bool> used(classes.parent.size(), false);
    for (const std::uint32_t c : classes.of_face) used[c] = true;
    for (std::uint32_t c = 1; c < used.size(); ++c) {
        if (!used[c]) continue;
        const auto regions = classes.regions(c);
        Bits bits(words, 0);
        for (const std::size_t r : regions) mark(bits, r);
        for (const std::size_t r : regions) {
            contains.keep(r, bits);
            result.overlaps.add(r, bits.data());
        }
    }

    // Points and lines in anything: the intersection over their vertices, and over their edges for lines in lines.
    const CurveIndex curves(set);
    Bits not_lines(words, 0);
    for (std::size_t a = 0; a < n; ++a)
        if (set.annotations[a].type != AnnotationType::line) mark(not_lines, a);
    const auto regions_at = [&](Index v) {
        Bits bits(words, 0);
        const Halfedge first = mesh.halfedge(Vertex(v));
        if (first == Mesh::null_halfedge()) return bits;
        for (const Halfedge h : mesh.halfedges_around_target(first)) {
            const Face face = mesh.face(h);
            if (face == Mesh::null_face()) continue;
            for (std::uint32_t c = classes.of_face[face]; c != 0; c = classes.parent[c]) mark(bits, classes.region[c]);
        }
        return bits;
    };
    for (std::size_t a = 0; a < n; ++a) {
        const Annotation& annotation = set.annotations[a];
        const std::vector<Index> vertices =
            annotation.type == AnnotationType::region ? std::vector<Index>() : touched_vertices(mesh, annotation);
        result.empty[a] = annotation.type == AnnotationType::region ? annotation.faces.empty() : vertices.empty();
        if (result.empty[a]) contains.zero(a);
        if (annotation.type == AnnotationType::region) continue;
        for (const Index v : vertices) {
            Bits bits = regions_at(v);
            for (const std::size_t holder : curves.at_vertex.at(v))
                if (annotation.type == AnnotationType::point || set.annotations[holder].type == AnnotationType::line)
                    mark(bits, holder);
            contains.keep(a, bits);
        }
        for (const auto& edge : curves.edges[a]) {
            Bits bits = not_lines;
            for (const std::size_t holder : curves.at_edge.at(edge)) mark(bits, holder);
            contains.keep(a, bits);
        }
    }
    return result;
}

ContainmentOrder order_of(const Mesh& mesh, const AnnotationSet& set, Containments containments) {
    const std::size_t n = set.annotations.size();
    BitTable& contains = containments.contains;
    ContainmentOrder order;
    order.containers.resize(n), order.direct.resize(n), order.parent.resize(n);

    // Equal selections contain each other: a chain by rank makes the order strict.
    const auto outranks = [&](std::size_t a, std::size_t b) {
        const Annotation &x = set.annotations[a], &y = set.annotations[b];
        return x.all != y.all ? x.all : x.id != y.id ? x.id < y.id : a < b;
    };
    std::vector<bool> grouped(n, false);
    std::vector<std::pair<std::size_t, std::size_t>> dropped;
    for (std::size_t a = 0; a < n; ++a) {
        std::vector<std::size_t> group{a};
        contains.each(a, [&](std::size_t b) {
            if (b == a || !contains.test(b, a)) return;
            group.push_back(b);
            if (outranks(a, b)) dropped.emplace_back(a, b);
        });
        if (group.size() < 2 || grouped[a]) continue;
        std::sort(group.begin(), group.end());
        for (const std::size_t b : group) grouped[b] = true;
        order.equal.push_back(std::move(group));
    }
    for (const auto& [a, b] : dropped) contains.clear(a, b);
    std::vector<double> area(n, 0);
    for (std::size_t a = 0; a < n; ++a) {
        if (!containments.empty[a]) contains.clear(a, a);
        area[a] = area_of(mesh, set.annotations[a].faces);
    }

    BitTable farther(n, n);
    for (std::size_t a = 0; a < n; ++a) {
        contains.each(a, [&](std::size_t b) {
            order.containers[a].push_back(b);
            farther.add(a, contains.row(b));
        });
        for (const std::size_t b : order.containers[a])
            if (!farther.test(a, b)) order.direct[a].push_back(b);
        for (const std::size_t b : order.direct[a])
            if (!order.parent[a] || std::make_pair(area[b], set.annotations[b].id) <
                                        std::make_pair(area[*order.parent[a]], set.annotations[*order.parent[a]].id))
                order.parent[a] = b;
    }
    return order;
}

std::vector<AdjacentPair> adjacent_pairs(const Mesh& mesh, const FaceClasses& classes, const BitTable& overlaps) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> between;  // classes -> length of the edges
    for (const Edge e : mesh.edges()) {
        const Halfedge h = mesh.halfedge(e);
        const Face f = mesh.face(h), g = mesh.face(mesh.opposite(h));
        if (f == Mesh::null_face() || g == Mesh::null_face()) continue;
        const std::uint32_t a = classes.of_face[f], b = classes.of_face[g];
        if (a == b || a == 0 || b == 0) continue;
        between[std::minmax(a, b)] += std::sqrt(CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h))));
    }
    std::map<std::pair<std::size_t, std::size_t>, double> lengths;
    for (const auto& [pair, length] : between)
        for (const std::size_t a : classes.regions(pair.first))
            for (const std::size_t b : classes.regions(pair.second))
                if (a != b && !overlaps.test(a, b)) lengths[std::minmax(a, b)] += length;
    std::vector<AdjacentPair> list;
    for (const auto& [pair, length] : lengths) list.push_back({pair.first, pair.second, length});
    return list;
}

}  // namespace

Topology topology(const Mesh& given_mesh, const AnnotationSet& given) {
    check_annotations(given, given_mesh, "annotations");
    const AlongEdges along_edges(given_mesh, given);
    const Mesh& mesh = along_edges.mesh();
    const AnnotationSet& set = along_edges.annotations();
    FaceClasses classes(mesh, set);
    if (along_edges.cut()) classes.drop_slivers(mesh, set);
    Containments containments = contain(mesh, set, classes);
    Topology result;
    result.adjacent = adjacent_pairs(mesh, classes, containments.overlaps);
    result.order = order_of(mesh, set, std::move(containments));
    return result;
}

std::vector<Relationship> relationships_of(const Topology& topology, const AnnotationSet& set, int first_id) {
    std::vector<Relationship> list;
    const auto id_of = [&](std::size_t a) { return set.annotations[a].id; };
    const auto add = [&](GeometricRelation kind, std::vector<int> members) -> Relationship& {
        return list.emplace_back(extracted_relationship(kind, first_id + static_cast<int>(list.size()), std::move(members)));
    };
    for (std::size_t a = 0; a < topology.order.direct.size(); ++a)
        for (const std::size_t b : topology.order.direct[a]) add(GeometricRelation::containment, {id_of(b), id_of(a)});
    for (const auto& group : topology.order.equal) {
        std::vector<int> members;
        for (const std::size_t a : group) members.push_back(id_of(a));
        add(GeometricRelation::equal_selections, std::move(members));
    }
    for (const auto& pair : topology.adjacent)
        add(GeometricRelation::adjacency, {id_of(pair.a), id_of(pair.b)})
            .parameters.deviations.push_back({"shared length", pair.length, {}, set.unit});
    return list;
}

std::vector<TreeEntry> containment_tree(const ContainmentOrder& order) {
    const std::size_t n = order.parent.size();
    std::vector<std::vector<std::size_t>> children(n + 1);
    for (std::size_t a = 0; a < n; ++a) children[order.parent[a].value_or(n)].push_back(a);
    std::vector<TreeEntry> list, stack;
    const auto push = [&](std::size_t node, std::size_t depth) {
        for (auto child = children[node].rbegin(); child != children[node].rend(); ++child) stack.push_back({*child, depth});
    };
    push(n, 0);
    while (!stack.empty()) {
        const TreeEntry entry = stack.back();
        stack.pop_back();
        list.push_back(entry);
        push(entry.annotation, entry.depth + 1);
    }
    return list;
}

}  // namespace ostraka
