#include "ostraka/annotation/annotation_maps.h"

#include "annotation/example_meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"

#include <CGAL/boost/graph/Euler_operations.h>
#include <gtest/gtest.h>

#include <numeric>

using namespace ostraka;
using namespace ostraka::example;

namespace {

AnnotationSet overlapping() {
    AnnotationSet set;
    const auto add = [&](int id, AnnotationType type) -> Annotation& {
        Annotation& annotation = set.annotations.emplace_back();
        annotation.id = id;
        annotation.type = type;
        annotation.tag = "tag " + std::to_string(id);
        return annotation;
    };
    add(5, AnnotationType::region).faces = {0, 1, 2, 3};
    add(2, AnnotationType::region).faces = {2, 3, 4};
    add(9, AnnotationType::line).polylines = {{0, 1, 2, 3}};
    add(7, AnnotationType::point).points = {8, 4};
    return set;
}

void expect_same_selections(const AnnotationSet& a, const AnnotationSet& b) {
    ASSERT_EQ(a.annotations.size(), b.annotations.size());
    for (std::size_t i = 0; i < a.annotations.size(); ++i) {
        EXPECT_EQ(a.annotations[i].type, b.annotations[i].type);
        EXPECT_EQ(a.annotations[i].faces, b.annotations[i].faces);
        EXPECT_EQ(a.annotations[i].polylines, b.annotations[i].polylines);
        EXPECT_EQ(a.annotations[i].points, b.annotations[i].points);
    }
}

std::vector<Index> identity(const Mesh& mesh) {
    std::vector<Index> map(mesh.number_of_vertices());
    std::iota(map.begin(), map.end(), Index{0});
    return map;
}

}  // namespace

TEST(AnnotationMaps, AttachAndCollectIsTheIdentity) {
    Mesh mesh = grid(4);
    const AnnotationSet set = overlapping();
    const AnnotationTable table = attach_annotations(mesh, set);
    expect_same_selections(set, collect_annotations(mesh, table, set, identity(mesh)));
    // Equal sets are stored once: none, {5}, {2, 5}, {2}, {9}, {7}.
    EXPECT_EQ(table.size(), 6U);
    const auto map = mesh.property_map<Face, std::uint32_t>(face_annotations).first;
    EXPECT_EQ(table.ids(map[Face(2)]), (std::vector<int>{2, 5}));
    EXPECT_TRUE(table.contains(map[Face(2)], 2));
    EXPECT_FALSE(table.contains(map[Face(0)], 2));
}

TEST(AnnotationMaps, WithoutAVertexMapElementsAreReadFromTheMaps) {
    Mesh mesh = grid(4);
    const AnnotationSet set = overlapping();
    const AnnotationTable table = attach_annotations(mesh, set);
    const AnnotationSet back = collect_annotations(mesh, table, set);
    EXPECT_EQ(back.annotations[3].points, (std::vector<Index>{4, 8}));
    EXPECT_EQ(back.annotations[2].polylines, set.annotations[2].polylines);
}

TEST(AnnotationMaps, ACollapsePreservesAnnotations) {
    Mesh mesh = spheres(2);
    AnnotationSet set;
    set.annotations.resize(2);
    Annotation& line = set.annotations[0];
    line.type = AnnotationType::line;
    const Halfedge first = mesh.halfedge(Vertex(0));
    const Index a = mesh.source(first), b = mesh.target(first), c = mesh.target(mesh.next(first));
    line.polylines = {{a, b, c}};
    Annotation& region = set.annotations[1];
    region.id = 1;
    for (const Face face : mesh.faces_around_target(mesh.halfedge(Vertex(0)))) region.faces.push_back(face);
    std::sort(region.faces.begin(), region.faces.end());
    const AnnotationTable table = attach_annotations(mesh, set);
    auto old_index = mesh.add_property_map<Vertex, Index>("v:old").first;
    for (const Vertex v : mesh.vertices()) old_index[v] = v;
    std::vector<Index> now = identity(mesh);
    const Vertex remaining = CGAL::Euler::collapse_edge(mesh.edge(first), mesh);
    now[a] = now[b] = remaining;
    mesh.collect_garbage();
    std::vector<Index> place(now.size(), no_index);
    for (const Vertex v : mesh.vertices()) place[old_index[v]] = v;
    for (Index& index : now) index = place[index];
    const AnnotationSet after = collect_annotations(mesh, table, set, now);
    EXPECT_EQ(after.annotations[0].polylines, (std::vector<std::vector<Index>>{{now[a], now[c]}}));
    EXPECT_EQ(after.annotations[1].faces.size(), region.faces.size() - 2);
    EXPECT_NO_THROW(check_annotations({mesh, after}, "after"));
}

TEST(AnnotationMaps, ASplitEdgeIsFollowed) {
    Mesh mesh = grid(2);
    AnnotationSet set;
    set.annotations.emplace_back().type = AnnotationType::line;
    set.annotations[0].polylines = {{0, 1, 2}};
    const AnnotationTable table = attach_annotations(mesh, set);
    const std::vector<Index> map = identity(mesh);
    auto numbers = mesh.property_map<Edge, std::uint32_t>(edge_annotations).first;
    const Halfedge h = find_halfedge(mesh, Vertex(0), Vertex(1));
    const std::uint32_t number = numbers[mesh.edge(h)];
    const Halfedge added = CGAL::Euler::split_edge(h, mesh);
    mesh.point(mesh.target(added)) = Point(0.5, 0, 0);
    numbers[mesh.edge(added)] = numbers[mesh.edge(h)] = number;
    CGAL::Euler::split_face(added, mesh.next(mesh.next(added)), mesh);
    const std::vector<std::vector<Index>> expected{{0, 9, 1, 2}};
    EXPECT_EQ(collect_annotations(mesh, table, set, map).annotations[0].polylines, expected);
    EXPECT_EQ(collect_annotations(mesh, table, set).annotations[0].polylines, expected);
}

TEST(AnnotationMaps, ARegionWithoutFacesBecomesALineOrAPointWithANote) {
    Mesh mesh = grid(4);
    AnnotationSet set;
    set.annotations.emplace_back().faces = {0};
    set.annotations[0].tag = "flower";
    const AnnotationTable table = attach_annotations(mesh, set);
    auto numbers = mesh.property_map<Face, std::uint32_t>(face_annotations).first;
    numbers[Face(0)] = 0;
    std::vector<Index> map = identity(mesh);
    map[6] = 1;  // the triangle 0, 1, 6 flattened to the edge 0, 1
    AnnotationSet after = collect_annotations(mesh, table, set, map);
    EXPECT_EQ(after.annotations[0].type, AnnotationType::line);
    EXPECT_EQ(after.annotations[0].polylines, (std::vector<std::vector<Index>>{{0, 1}}));
    EXPECT_EQ(after.annotations[0].tag, "flower");
    EXPECT_NE(after.annotations[0].note.find("became a line"), std::string::npos);
    map[0] = map[1] = map[6] = 12;
    after = collect_annotations(mesh, table, set, map);
    EXPECT_EQ(after.annotations[0].type, AnnotationType::point);
    EXPECT_EQ(after.annotations[0].points, std::vector<Index>{12});
    map[0] = map[1] = map[6] = no_index;
    after = collect_annotations(mesh, table, set, map);
    EXPECT_TRUE(after.annotations[0].points.empty());
    EXPECT_NE(after.annotations[0].note.find("gone"), std::string::npos);
    EXPECT_NO_THROW(check_annotations({mesh, after}, "after"));
}

TEST(AnnotationMaps, PinsFollowAndValuesAreStale) {
    Annotation annotation;
    Attribute& attribute = annotation.attributes.emplace_back();
    attribute.value = Measure();
    attribute.measure()->tool = "ruler";
    attribute.measure()->points = {0, 2};
    attribute.measure()->value = 5.0;
    attribute.measure()->unit = "mm";
    move_pins(annotation, {3, 4, 1}, 5);
    EXPECT_EQ(attribute.measure()->points, (std::vector<Index>{3, 1}));
    EXPECT_TRUE(attribute.measure()->stale);
    move_pins(annotation, {3, no_index, 1, 2}, 5);
    EXPECT_NE(attribute.descriptor(), nullptr);
    EXPECT_EQ(attribute.descriptor()->values, std::vector<double>{5.0});
    EXPECT_EQ(attribute.descriptor()->unit, "mm");
}

TEST(AnnotationMaps, MisuseIsAnError) {
    Mesh mesh = grid(2);
    EXPECT_THROW(collect_annotations(mesh, AnnotationTable(), overlapping()), Error);
    AnnotationSet empty;
    const AnnotationTable table = attach_annotations(mesh, empty);
    EXPECT_TRUE(collect_annotations(mesh, table, empty).annotations.empty());
    CGAL::Euler::remove_face(mesh.halfedge(Face(0)), mesh);
    EXPECT_THROW(collect_annotations(mesh, table, empty), Error);
    EXPECT_THROW(attach_annotations(mesh, empty), Error);
    mesh.collect_garbage();
    detach_annotations(mesh);
    EXPECT_FALSE((mesh.property_map<Face, std::uint32_t>(face_annotations).second));
}
