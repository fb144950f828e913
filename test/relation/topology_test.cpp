// The order against brute force, and cases worked out by hand.
#include "ostraka/relation/topology.h"

#include "meshes.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/relation/rules.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

using namespace ostraka;
using namespace ostraka::test;

namespace {

Annotation region(int id, std::vector<Index> faces) {
    Annotation a;
    a.id = id, a.tag = "r" + std::to_string(id), a.faces = std::move(faces);
    std::sort(a.faces.begin(), a.faces.end());
    a.faces.erase(std::unique(a.faces.begin(), a.faces.end()), a.faces.end());
    return a;
}
Annotation line(int id, std::vector<std::vector<Index>> polylines) {
    Annotation a;
    a.id = id, a.tag = "l", a.type = AnnotationType::line, a.polylines = std::move(polylines);
    return a;
}
Annotation points(int id, std::vector<Index> list) {
    Annotation a;
    a.id = id, a.tag = "p", a.type = AnnotationType::point, a.points = std::move(list);
    return a;
}

/// The six rules literally.
bool contained(const Mesh& mesh, const Annotation& inner, const Annotation& outer) {
    const auto vertices = [&](const Annotation& a) {
        std::set<Index> result(a.points.begin(), a.points.end());
        for (const auto& polyline : a.polylines) result.insert(polyline.begin(), polyline.end());
        for (const Index f : a.faces)
            for (const Vertex v : corners(mesh, Face(f))) result.insert(v.idx());
        return result;
    };
    const auto edges = [](const Annotation& a) {
        std::set<std::pair<Index, Index>> result;
        for (const auto& polyline : a.polylines)
            for (std::size_t i = 1; i < polyline.size(); ++i) result.insert(std::minmax(polyline[i - 1], polyline[i]));
        return result;
    };
    const auto within = [](const auto& a, const auto& b) { return std::includes(b.begin(), b.end(), a.begin(), a.end()); };
    if (inner.type == AnnotationType::region) return outer.type == AnnotationType::region && within(inner.faces, outer.faces);
    if (inner.type == AnnotationType::line) {
        if (outer.type == AnnotationType::point) return false;
        if (outer.type == AnnotationType::line) return within(edges(inner), edges(outer));
    }
    return within(vertices(inner), vertices(outer));
}

/// A patch of faces around one face, by breadth-first search.
std::vector<Index> patch_around(const Mesh& mesh, Index seed, std::size_t count) {
    std::vector<Index> list{seed};
    std::vector<bool> seen(mesh.number_of_faces(), false);
    seen[seed] = true;
    for (std::size_t i = 0; i < list.size() && list.size() < count; ++i)
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(list[i])))) {
            const Face next = mesh.face(mesh.opposite(h));
            if (next == Mesh::null_face() || seen[next]) continue;
            seen[next] = true;
            list.push_back(next.idx());
        }
    return list;
}

std::vector<Index> walk(const Mesh& mesh, Index start, std::size_t steps, std::mt19937& random) {
    std::vector<Index> polyline{start};
    while (polyline.size() <= steps) {
        std::vector<Index> ring;
        for (const Vertex v : mesh.vertices_around_target(mesh.halfedge(Vertex(polyline.back())))) ring.push_back(v.idx());
        polyline.push_back(ring[random() % ring.size()]);
    }
    return polyline;
}

/// Random selections with copies, parts and overlaps among them.
AnnotationSet random_set(const Mesh& mesh, std::uint32_t seed, std::size_t count) {
    std::mt19937 random(seed);
    AnnotationSet set;
    for (std::size_t i = 0; i < count; ++i) {
        const int id = static_cast<int>((i * 7919) % 1009);
        const auto old = set.annotations.empty() ? nullptr : &set.annotations[random() % set.annotations.size()];
        const auto kind = random() % 8;
        Annotation a;
        if (old != nullptr && kind == 0) {
            a = *old;  // equal
        } else if (old != nullptr && kind <= 2 && old->faces.size() > 1) {
            a = region(id, std::vector<Index>(old->faces.begin(),
                                              old->faces.begin() + static_cast<long>(1 + random() % old->faces.size())));
        } else if (old != nullptr && kind == 3 && old->type != AnnotationType::point) {
            const auto inside = touched_vertices(mesh, *old);  // points of another
            std::vector<Index> list;
            for (std::size_t k = 0; k < 1 + random() % 3; ++k) list.push_back(inside[random() % inside.size()]);
            a = points(id, list);
        } else if (old != nullptr && kind == 4 && old->type == AnnotationType::line) {
            const auto& polyline = old->polylines.front();  // a stretch of another, backwards
            std::vector<Index> part(polyline.begin(), polyline.begin() + static_cast<long>(2 + random() % (polyline.size() - 1)));
            std::reverse(part.begin(), part.end());
            a = line(id, {part});
        } else if (kind <= 5) {
            a = region(id, patch_around(mesh, random() % mesh.number_of_faces(), 1 + random() % (mesh.number_of_faces() / 2)));
        } else if (kind == 6) {
            a = line(id, {walk(mesh, random() % mesh.number_of_vertices(), 1 + random() % 6, random)});
        } else {
            a = points(id, {Index(random() % mesh.number_of_vertices())});
        }
        a.id = id;
        set.annotations.push_back(a);
    }
    return set;
}

}  // namespace

TEST(Containment, EqualsBruteForceOnRandomSelections) {
    std::size_t strict = 0, equal = 0, overlapping = 0, adjacent = 0;
    for (std::uint32_t seed = 0; seed < 30; ++seed) {
        const Mesh mesh = build_mesh(seed % 3 == 0 ? patch(6, 5) : seed % 3 == 1 ? octahedron_sphere(2) : torus(10, 7));
        const AnnotationSet set = random_set(mesh, seed, 70);
        const std::size_t n = set.annotations.size();
        const AnnotationTopology computed = topology({mesh, set});
        std::vector<std::set<std::size_t>> above(n);
        for (std::size_t a = 0; a < n; ++a)
            for (std::size_t b = 0; b < n; ++b) {
                if (a == b || !contained(mesh, set.annotations[a], set.annotations[b])) continue;
                const bool both = contained(mesh, set.annotations[b], set.annotations[a]);
                equal += both;
                if (!both || set.annotations[b].id < set.annotations[a].id) above[a].insert(b);
            }
        std::vector<double> area(n, 0);
        for (std::size_t a = 0; a < n; ++a)
            for (const Index f : set.annotations[a].faces) area[a] += face_area(mesh, Face(f));
        for (std::size_t a = 0; a < n; ++a) {
            strict += above[a].size();
            EXPECT_EQ(std::set<std::size_t>(computed.order.containers[a].begin(), computed.order.containers[a].end()), above[a]);
            std::set<std::size_t> direct;
            for (const std::size_t b : above[a]) {
                bool between = false;
                for (const std::size_t c : above[a]) between = between || above[c].count(b) > 0;
                if (!between) direct.insert(b);
            }
            EXPECT_EQ(std::set<std::size_t>(computed.order.direct[a].begin(), computed.order.direct[a].end()), direct);
            overlapping += direct.size() > 1;
            std::optional<std::size_t> parent;
            for (const std::size_t b : direct)
                if (!parent || area[b] < area[*parent] ||
                    (area[b] == area[*parent] && set.annotations[b].id < set.annotations[*parent].id))
                    parent = b;
            EXPECT_EQ(computed.order.parent[a], parent);
        }
        // Adjacency by its definition.
        std::map<std::pair<std::size_t, std::size_t>, double> lengths;
        for (std::size_t a = 0; a < n; ++a)
            for (std::size_t b = a + 1; b < n; ++b) {
                const auto x = face_flags(mesh, set.annotations[a].faces), y = face_flags(mesh, set.annotations[b].faces);
                bool common = false;
                for (std::size_t f = 0; f < x.size(); ++f) common = common || (x[f] && y[f]);
                if (common) continue;
                for (const Edge e : mesh.edges()) {
                    const Face f = mesh.face(mesh.halfedge(e)), g = mesh.face(mesh.opposite(mesh.halfedge(e)));
                    if (f == Mesh::null_face() || g == Mesh::null_face()) continue;
                    if ((x[f] && y[g]) || (x[g] && y[f]))
                        lengths[{a, b}] +=
                            std::sqrt(CGAL::squared_distance(mesh.point(mesh.vertex(e, 0)), mesh.point(mesh.vertex(e, 1))));
                }
            }
        ASSERT_EQ(computed.adjacent.size(), lengths.size());
        adjacent += lengths.size();
        for (const auto& pair : computed.adjacent)
            EXPECT_NEAR(pair.length, (lengths.at({pair.a, pair.b})), 1e-12 * (1 + pair.length));
    }
    // All relevant cases occurred.
    EXPECT_GT(strict, 1000U);
    EXPECT_GT(equal, 100U);
    EXPECT_GT(overlapping, 50U);
    EXPECT_GT(adjacent, 20U);
}

TEST(Containment, EqualSelectionsAndTheRoot) {
    const Mesh mesh = build_mesh(octahedron_sphere(1));
    std::vector<Index> all(mesh.number_of_faces());
    for (Index f = 0; f < all.size(); ++f) all[f] = f;
    AnnotationSet set;
    set.annotations = {region(1, all), region(9, all), region(4, {3}), region(2, {3}), region(5, {})};
    set.annotations[1].all = true;  // the object itself, although its id is the higher one
    const AnnotationTopology computed = topology({mesh, set});
    EXPECT_EQ(computed.order.parent, (std::vector<std::optional<std::size_t>>{1, {}, 3, 0, {}}));
    EXPECT_EQ(computed.order.equal, (std::vector<std::vector<std::size_t>>{{0, 1}, {2, 3}}));
    EXPECT_TRUE(computed.order.containers[4].empty()) << "nothing is said of an empty selection";
    std::vector<std::pair<std::size_t, std::size_t>> tree;
    for (const auto& [place, depth] : containment_tree(computed.order)) tree.emplace_back(place, depth);
    EXPECT_EQ(tree, (std::vector<std::pair<std::size_t, std::size_t>>{{1, 0}, {0, 1}, {3, 2}, {2, 3}, {4, 0}}));
    const auto relationships = relationships_of(computed, set, 10);
    ASSERT_EQ(relationships.size(), 5U);
    EXPECT_EQ(relationships[0].annotations, (std::vector<int>{9, 1})) << "container first";
    EXPECT_EQ(relationships[4].type, "equal selections");
    EXPECT_EQ(relationships[4].id, 14);
}

TEST(Adjacency, NestedIsNotAdjacentAndACornerIsNotEnough) {
    const Mesh mesh = build_mesh(grid(4, 4, false, false, [](double u, double v) {
        return std::array<double, 3>{4 * u, 4 * v, 0};
    }));
    const auto cell = [](Index i, Index j) { return std::vector<Index>{2 * (i + 4 * j), 2 * (i + 4 * j) + 1}; };
    const auto cells = [&](std::initializer_list<std::pair<Index, Index>> list) {
        std::vector<Index> faces;
        for (const auto& [i, j] : list)
            for (const Index f : cell(i, j)) faces.push_back(f);
        return faces;
    };
    AnnotationSet set;
    set.unit = "mm";
    set.annotations = {region(0, cells({{0, 0}, {1, 0}, {0, 1}})), region(1, cells({{0, 0}})), region(2, cells({{2, 0}})),
                       region(3, cells({{1, 1}, {2, 1}}))};
    const AnnotationTopology computed = topology({mesh, set});
    std::vector<std::tuple<std::size_t, std::size_t, double>> pairs;
    for (const auto& pair : computed.adjacent) pairs.emplace_back(pair.a, pair.b, pair.length);
    EXPECT_EQ(pairs, (std::vector<std::tuple<std::size_t, std::size_t, double>>{{0, 2, 1.0}, {0, 3, 2.0}, {2, 3, 1.0}}));
}

TEST(BrokenRules, RelationshipsComeFromTheMeshUnlessAGraphIsGiven) {
    const Mesh mesh = build_mesh(grid(4, 4, false, false, [](double u, double v) {
        return std::array<double, 3>{4 * u, 4 * v, 0};
    }));
    AnnotationSet set;
    set.annotations = {region(0, {0, 1, 2, 3}), region(1, {0, 1}), region(2, {4, 5})};
    const auto rules = [](const std::string& type) {
        return class_rules_from_json(parse_json(R"({"format": "ostraka-rules", "version": 1, "rules": [{"id": "r", "relation":
            {"of": "r1", "is": ")" + type + R"(", "to": "r0"}}]})",
                                                "rules"),
                                     "rules");
    };
    EXPECT_TRUE(broken_rules({mesh, set}, rules("containment"), nullptr, nullptr, "rules").empty());
    EXPECT_EQ(broken_rules({mesh, set}, rules("beside"), nullptr, nullptr, "rules").size(), 1U);
    RelationGraph graph;
    EXPECT_EQ(broken_rules({mesh, set}, rules("containment"), nullptr, &graph, "rules").size(), 1U) << "the graph states none";
    Relationship& stated = graph.relationships.emplace_back();
    stated.type = "beside";
    stated.annotations = {1, 0};
    EXPECT_TRUE(broken_rules({mesh, set}, rules("beside"), nullptr, &graph, "rules").empty());
}

TEST(Topology, EmptyMeshesSetsAndSingleFaces) {
    EXPECT_TRUE(topology({Mesh(), AnnotationSet()}).adjacent.empty());
    TriangleSoup triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}}, {{0, 1, 2}}};
    AnnotationSet set;
    set.annotations = {region(0, {0}), points(1, {0}), points(2, {3}), line(3, {{0, 1}})};
    const AnnotationTopology computed = topology({build_mesh(triangle), set});
    EXPECT_EQ(computed.order.direct[1], (std::vector<std::size_t>{3}));
    EXPECT_EQ(computed.order.direct[3], (std::vector<std::size_t>{0}));
    EXPECT_TRUE(computed.order.direct[2].empty()) << "a vertex without faces lies in no region";
    set.annotations[0].faces = {7};
    EXPECT_ANY_THROW(topology({build_mesh(triangle), set}));
}

TEST(Topology, DoesNotDependOnThreads) {
    const Mesh mesh = build_mesh(torus(40, 30));
    const AnnotationSet set = random_set(mesh, 5, 150);
    set_threads(1);
    const AnnotationTopology single_threaded = topology({mesh, set});
    set_threads(4);
    const AnnotationTopology four = topology({mesh, set});
    set_threads(0);
    EXPECT_EQ(single_threaded.order.direct, four.order.direct);
    ASSERT_EQ(single_threaded.adjacent.size(), four.adjacent.size());
    for (std::size_t i = 0; i < single_threaded.adjacent.size(); ++i)
        EXPECT_EQ(single_threaded.adjacent[i].length, four.adjacent[i].length);
}

TEST(Topology, ManyOverlappingRegionsAreBounded) {
    const Mesh mesh = build_mesh(grid(41, 41, false, false, [](double u, double v) { return std::array<double, 3>{u, v, 0}; }));
    const auto faces = static_cast<Index>(mesh.number_of_faces());
    AnnotationSet set;
    std::vector<Index> even, odd;
    for (Index f = 0; f < faces; ++f) (f % 2 == 0 ? even : odd).push_back(f);
    for (int i = 0; i < 400; ++i) set.annotations.push_back(region(i, i % 2 == 0 ? even : odd));
    const AnnotationTopology computed = topology({mesh, set});
    EXPECT_EQ(computed.adjacent.size(), 200U * 200U);
    EXPECT_EQ(computed.adjacent.front().edges, computed.adjacent.back().edges);
    EXPECT_EQ(relationships_of(computed, set, 0, 100).size(), 100U + 2U + 100U);  // containment, equal selections, adjacency
    AnnotationSet many;
    for (int i = 0; i < 30001; ++i) many.annotations.push_back(region(i, {}));
    EXPECT_THROW(topology({mesh, many}), Error);
}
