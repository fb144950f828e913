#include "ostraka/relation/topology.h"

#include "relation/bit_table.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/core/memory.h"
#include "ostraka/core/progress.h"
#include "ostraka/execution/parallel.h"

#include <numeric>
#include <unordered_map>

namespace ostraka {

namespace {

using detail::BitTable;
using Bits = std::vector<std::uint64_t>;

void mark(Bits& bits, std::size_t i) { bits[i / 64] |= std::uint64_t{1} << (i % 64); }

/// Faces grouped by the set of regions that contain them. Group 0 is the empty set; each other group has its parent's set and
/// one more region.
struct FaceClasses {
    std::vector<std::uint32_t> of_face;
    std::vector<std::uint32_t> parent{0}, region{0};

    explicit FaceClasses(AnnotatedMeshView object) : of_face(object.mesh.number_of_faces(), 0) {
        std::vector<std::uint32_t> split_by{0}, split_to{0};  // index of the last region that split a group + 1; the new group
        for (std::uint32_t r = 0; r < object.annotations.annotations.size(); ++r)
            for (const Index face : object.annotations.annotations[r].faces) {
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
    /// Removes slivers between free outlines that coincide up to rounding: groups with less than a millionth of the area of
    /// each region in them. The faces are assigned to the group of their neighbour across the longest edge.
    void drop_slivers(AnnotatedMeshView object) {
        std::vector<double> area(parent.size(), 0), of_region(object.annotations.annotations.size(), 0);
        for (const Face f : object.mesh.faces()) {
            const double part = face_area(object.mesh, f);
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
        for (int round = 0; round < 3; ++round)  // slivers can lie in rows
            for (const Face f : object.mesh.faces()) {
                if (!sliver[of_face[f]]) continue;
                double longest = -1;
                for (const Halfedge h : object.mesh.halfedges_around_face(object.mesh.halfedge(f))) {
                    const Face g = object.mesh.face(object.mesh.opposite(h));
                    if (g == Mesh::null_face() || sliver[of_face[g]]) continue;
                    const double length = CGAL::squared_distance(object.mesh.point(object.mesh.source(h)),
                                                                 object.mesh.point(object.mesh.target(h)));
                    if (length > longest) longest = length, of_face[f] = of_face[g];
                }
            }
    }
    /// The regions of a group, ascending.
    [[nodiscard]] std::vector<std::uint32_t> regions(std::uint32_t c) const {
        std::vector<std::uint32_t> list;
        for (; c != 0; c = parent[c]) list.push_back(region[c]);
        std::reverse(list.begin(), list.end());
        return list;
    }
};

using VertexPair = std::pair<Index, Index>;

/// The points and lines that contain a vertex, and the lines that contain an edge.
struct CurveIndex {
    std::unordered_map<Index, std::vector<std::size_t>> at_vertex;
    std::map<VertexPair, std::vector<std::size_t>> at_edge;
    std::vector<std::vector<VertexPair>> edges;  ///< for each annotation, sorted, without duplicates

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

/// contains.row(a): all annotations whose selection contains that of a, including a; overlaps: pairs of regions with a common
/// face.
struct Containments {
    BitTable contains, overlaps;
    std::vector<bool> empty;
};

Containments contain(AnnotatedMeshView object, const FaceClasses& classes) {
    const std::size_t n = object.annotations.annotations.size();
    Containments result{BitTable(n, n), BitTable(n, n), std::vector<bool>(n, false)};
    BitTable& contains = result.contains;
    const std::size_t words = contains.words();
    for (std::size_t a = 0; a < n; ++a) contains.fill(a);

    // Regions in regions: the intersection of the region sets of all their faces. Each thread has its own columns.
    std::vector<bool> used(classes.parent.size(), false);
    for (const std::uint32_t c : classes.of_face) used[c] = true;
    constexpr std::size_t words_of_thread = 16;
    parallel_for((words + words_of_thread - 1) / words_of_thread, 1, [&](std::size_t slice) {
        const std::size_t begin = slice * words_of_thread, end = std::min(words, begin + words_of_thread);
        CancelCheck cancelled;
        for (std::uint32_t c = 1; c < used.size(); ++c) {
            cancelled();
            if (!used[c]) continue;
            const auto regions = classes.regions(c);
            Bits bits(words, 0);
            for (const std::size_t r : regions) mark(bits, r);
            for (const std::size_t r : regions) {
                contains.keep(r, bits, begin, end);
                result.overlaps.add(r, bits.data(), begin, end);
            }
        }
    });

    // Points and lines in others: the intersection over their vertices; for lines in lines over their edges.
    const CurveIndex curves(object.annotations);
    Bits not_lines(words, 0);
    for (std::size_t a = 0; a < n; ++a)
        if (object.annotations.annotations[a].type != AnnotationType::line) mark(not_lines, a);
    const auto regions_at = [&](Index v) {
        Bits bits(words, 0);
        const Halfedge first = object.mesh.halfedge(Vertex(v));
        if (first == Mesh::null_halfedge()) return bits;
        for (const Halfedge h : object.mesh.halfedges_around_target(first)) {
            const Face face = object.mesh.face(h);
            if (face == Mesh::null_face()) continue;
            for (std::uint32_t c = classes.of_face[face]; c != 0; c = classes.parent[c]) mark(bits, classes.region[c]);
        }
        return bits;
    };
    for (std::size_t a = 0; a < n; ++a) {
        const Annotation& annotation = object.annotations.annotations[a];
        const std::vector<Index> vertices =
            annotation.type == AnnotationType::region ? std::vector<Index>() : touched_vertices(object.mesh, annotation);
        result.empty[a] = annotation.type == AnnotationType::region ? annotation.faces.empty() : vertices.empty();
        if (result.empty[a]) contains.zero(a);
        if (annotation.type == AnnotationType::region) continue;
        for (const Index v : vertices) {
            Bits bits = regions_at(v);
            for (const std::size_t holder : curves.at_vertex.at(v))
                if (annotation.type == AnnotationType::point ||
                    object.annotations.annotations[holder].type == AnnotationType::line)
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

ContainmentOrder order_of(AnnotatedMeshView object, Containments containments) {
    const std::size_t n = object.annotations.annotations.size();
    BitTable& contains = containments.contains;
    ContainmentOrder order;
    order.containers.resize(n), order.direct.resize(n), order.parent.resize(n);

    // Equal selections contain each other; ordering them by rank makes the order strict.
    const auto outranks = [&](std::size_t a, std::size_t b) {
        const Annotation &x = object.annotations.annotations[a], &y = object.annotations.annotations[b];
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
        area[a] = area_of(object.mesh, object.annotations.annotations[a].faces);
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
            if (!order.parent[a] ||
                std::make_pair(area[b], object.annotations.annotations[b].id) <
                    std::make_pair(area[*order.parent[a]], object.annotations.annotations[*order.parent[a]].id))
                order.parent[a] = b;
    }
    return order;
}

/// Total length and number of edges between two face groups, or between two regions.
struct Shared {
    std::uint32_t a, b;
    double length;
    std::size_t edges;
    [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> key() const { return {a, b}; }
};

/// Merges entries of the same pair and sorts them; lengths are added in the order of the list.
void add_up(std::vector<Shared>& list) {
    std::stable_sort(list.begin(), list.end(), [](const Shared& x, const Shared& y) { return x.key() < y.key(); });
    std::size_t next = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (next > 0 && list[next - 1].key() == list[i].key()) {
            list[next - 1].length += list[i].length;
            list[next - 1].edges += list[i].edges;
        } else {
            list[next++] = list[i];
        }
    }
    list.resize(next);
}

std::vector<Shared> shared_by_classes(const Mesh& mesh, const FaceClasses& classes) {
    std::vector<Shared> between;
    for (const Edge e : mesh.edges()) {
        const Halfedge h = mesh.halfedge(e);
        const Face f = mesh.face(h), g = mesh.face(mesh.opposite(h));
        if (f == Mesh::null_face() || g == Mesh::null_face()) continue;
        const std::uint32_t a = classes.of_face[f], b = classes.of_face[g];
        if (a == b || a == 0 || b == 0) continue;
        const auto [low, high] = std::minmax(a, b);
        between.push_back(
            {low, high, std::sqrt(CGAL::squared_distance(mesh.point(mesh.source(h)), mesh.point(mesh.target(h)))), 1});
    }
    add_up(between);
    return between;
}

std::vector<AdjacentPair> adjacent_pairs(const Mesh& mesh, const FaceClasses& classes, const BitTable& overlaps) {
    std::vector<Shared> lengths;
    std::size_t settled = 0;
    for (const Shared& between : shared_by_classes(mesh, classes)) {
        const auto first = classes.regions(between.a), second = classes.regions(between.b);
        // Regions on both sides overlap; only regions on exactly one side are neighbours.
        std::vector<std::uint32_t> of_first, of_second;
        std::set_difference(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(of_first));
        std::set_difference(second.begin(), second.end(), first.begin(), first.end(), std::back_inserter(of_second));
        for (const std::uint32_t a : of_first)
            for (const std::uint32_t b : of_second)
                if (!overlaps.test(a, b)) lengths.push_back({std::min(a, b), std::max(a, b), between.length, between.edges});
        if (lengths.size() > 2 * settled + (std::size_t{1} << 22)) {
            add_up(lengths);
            settled = lengths.size();
            require_memory(4.0 * sizeof(Shared) * static_cast<double>(settled), "to compute which regions are adjacent",
                           "give fewer annotations at once");
        }
    }
    add_up(lengths);
    std::vector<AdjacentPair> list;
    list.reserve(lengths.size());
    for (const Shared& one : lengths) list.push_back({one.a, one.b, one.length, one.edges});
    return list;
}

/// The tables of pairs are quadratic in the number of annotations.
void require_few(const AnnotationSet& set) {
    constexpr std::size_t most = 30000;
    if (set.annotations.size() > most)
        fail_input("annotations",
                   "there are more than " + std::to_string(most) + ", too many to compute which contain each other",
                   "give fewer at once");
}

}  // namespace

AnnotationTopology topology(AnnotatedMeshView given) {
    require_few(given.annotations);
    check_annotations(given, "annotations");
    const EdgeAlignedAnnotations along_edges(given);
    const AnnotatedMeshView object = along_edges.object();
    FaceClasses classes(object);
    if (along_edges.cut()) classes.drop_slivers(object);
    Containments containments = contain(object, classes);
    AnnotationTopology result;
    result.adjacent = adjacent_pairs(object.mesh, classes, containments.overlaps);
    result.order = order_of(object, std::move(containments));
    return result;
}

std::vector<Relationship> relationships_of(const AnnotationTopology& topology, const AnnotationSet& set, int first_id,
                                           std::size_t max_per_kind) {
    std::vector<Relationship> list;
    const auto id_of = [&](std::size_t a) { return set.annotations[a].id; };
    const auto add = [&](GeometricRelation kind, std::vector<int> members) -> Relationship& {
        return list.emplace_back(extracted_relationship(kind, first_id + static_cast<int>(list.size()), std::move(members)));
    };
    for (std::size_t a = 0; a < topology.order.direct.size(); ++a)
        for (const std::size_t b : topology.order.direct[a])
            if (list.size() < max_per_kind) add(GeometricRelation::containment, {id_of(b), id_of(a)});
    for (const auto& group : topology.order.equal) {
        std::vector<int> members;
        for (const std::size_t a : group) members.push_back(id_of(a));
        add(GeometricRelation::equal_selections, std::move(members));
    }
    for (std::size_t i = 0; i < std::min(max_per_kind, topology.adjacent.size()); ++i) {
        const AdjacentPair& pair = topology.adjacent[i];
        add(GeometricRelation::adjacency, {id_of(pair.a), id_of(pair.b)})
            .parameters.deviations.push_back({"shared length", pair.length, {}, set.unit});
    }
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
    CancelCheck check;
    while (!stack.empty()) {
        check();
        const TreeEntry entry = stack.back();
        stack.pop_back();
        list.push_back(entry);
        push(entry.annotation, entry.depth + 1);
    }
    return list;
}

}  // namespace ostraka
