#include "ostraka/annotation/label_file.h"

#include "annotation/example_meshes.h"
#include "ostraka/annotation/colouring.h"
#include "ostraka/annotation/remap.h"
#include "ostraka/core/error.h"
#include "ostraka/render/colour_scale.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>

using namespace ostraka;
using namespace ostraka::example;
using ostraka::test::Scratch;

namespace {

template <class Action>
std::string error_of(Action&& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

std::vector<Index> identity(std::size_t count) {
    std::vector<Index> map(count);
    std::iota(map.begin(), map.end(), Index{0});
    return map;
}

}  // namespace

TEST(Labels, ReadAndWritten) {
    const Scratch scratch;
    const std::vector<std::int32_t> labels{3, -1, 0, 2147483647};
    write_labels(scratch / "a.seg", labels);
    EXPECT_EQ(read_labels(scratch / "a.seg", 4), labels);
    EXPECT_EQ(read_labels(scratch.file("b.seg", "1\r\n 2 \n\n\n"), 2), (std::vector<std::int32_t>{1, 2}));
    // One label per polygon: each triangle has its polygon's label.
    EXPECT_EQ(read_labels(scratch.file("c.seg", "5\n6\n"), 3, {0, 0, 1}), (std::vector<std::int32_t>{5, 5, 6}));
    EXPECT_EQ(read_labels(scratch.file("d.seg", "5\n6\n7\n"), 3, {0, 0, 1}), (std::vector<std::int32_t>{5, 6, 7}));
    const auto fails = [&](const std::string& text, const std::string& expected) {
        const std::string message = error_of([&] { read_labels(scratch.file("x.seg", text), 3, {0, 0, 1}); });
        EXPECT_NE(message.find("x.seg"), std::string::npos) << message;
        EXPECT_NE(message.find(expected), std::string::npos) << message;
    };
    fails("1\n2\n3\n4\n", "4 labels for a mesh of 2 polygons (3 triangles)");
    fails("", "0 labels");
    fails("1\nhead\n", "line 2");
    fails("1\n\n2\n", "line 2");
    fails("1\n99999999999\n", "line 2");
    fails("1.5\n2\n", "line 1");
    EXPECT_THROW(read_labels(scratch / "missing.seg", 3), Error);
}

TEST(Labels, BecomeRegionsAndBack) {
    const Mesh mesh = grid(2);
    const std::vector<std::int32_t> labels{4, 4, 0, 0, no_label, 9, 9, 4};
    const AnnotationSet set = regions_from_labels(mesh, labels, {{4, "head"}});
    ASSERT_EQ(set.annotations.size(), 3U);
    EXPECT_EQ(set.annotations[0].tag, "part 0");
    EXPECT_EQ(set.annotations[1].tag, "head");
    EXPECT_EQ(set.annotations[1].faces, (std::vector<Index>{0, 1, 7}));
    EXPECT_EQ(labels_of({mesh, set}), labels);
    std::set<std::array<int, 3>> colours;
    for (std::size_t i = 0; i < 60; ++i) colours.insert(distinct_colour(i));
    EXPECT_EQ(colours.size(), 60U);
    EXPECT_THROW(regions_from_labels(mesh, {1}), Error);
    EXPECT_EQ(face_labels_from_vertices(grid(1), {1, 2, 2, 2}), (std::vector<std::int32_t>{2, 2}));
    EXPECT_EQ(face_labels_from_vertices(grid(1), {1, 2, 2, 3})[0], 1);
    EXPECT_THROW(face_labels_from_vertices(mesh, {1}), Error);
}

TEST(Colouring, NeighboursDifferAndTheWholeIsNeutral) {
    // A chessboard of 36 fields, each with its own label, more than there are hues.
    const Mesh mesh = grid(6);
    std::vector<std::int32_t> labels(mesh.number_of_faces());
    for (std::size_t f = 0; f < labels.size(); ++f) labels[f] = static_cast<std::int32_t>(f / 2);
    const AnnotationSet set = regions_from_labels(mesh, labels);
    std::map<std::array<int, 3>, std::size_t> index_of;
    for (std::size_t i = 0; i < category_count; ++i) index_of[distinct_colour(i)] = i;
    std::vector<std::size_t> colours;
    for (const Annotation& annotation : set.annotations) colours.push_back(index_of.at(annotation.colour));
    EXPECT_EQ(std::set<std::size_t>(colours.begin(), colours.end()).size(), 36U);
    for (std::size_t row = 0; row < 6; ++row)
        for (std::size_t column = 0; column < 5; ++column) {
            EXPECT_NE(colours[6 * row + column] % category_hues, colours[6 * row + column + 1] % category_hues);
            EXPECT_NE(colours[6 * column + row] % category_hues, colours[6 * column + 6 + row] % category_hues);
        }
    const AnnotationSet single_label = regions_from_labels(mesh, std::vector<std::int32_t>(labels.size(), 7));
    EXPECT_EQ(single_label.annotations[0].colour, neutral_colour);
    // An added annotation gets the first unused colour.
    for (std::size_t f = 0; f < labels.size(); ++f) labels[f] = f < 1 ? 0 : f < 30 ? 1 : 2;
    AnnotationSet two = regions_from_labels(mesh, labels);
    two.annotations.erase(two.annotations.begin() + 1);
    Annotation joining;
    joining.faces = {0, 1};
    EXPECT_EQ(unused_colour({mesh, two}, joining), distinct_colour(1));
    joining.faces.resize(70);
    EXPECT_EQ(unused_colour({mesh, two}, joining), neutral_colour);
}

TEST(Labels, NamesAreObjectsOrLists) {
    const Scratch scratch;
    EXPECT_EQ(read_label_names(scratch.file("n.json", R"({"3": "head", "-2": "x"})")),
              (std::map<std::int32_t, std::string>{{-2, "x"}, {3, "head"}}));
    EXPECT_EQ(read_label_names(scratch.file("n.json", R"(["head", "arm"])")).at(1), "arm");
    for (const char* text : {"3", R"({"a": "head"})", R"({"3": 4})", "[1]", "{"})
        EXPECT_THROW(read_label_names(scratch.file("n.json", text)), Error) << text;
}

TEST(Colouring, SmallestRegionOnTop) {
    const Mesh mesh = grid(2);
    AnnotationSet set;
    set.annotations.resize(3);
    set.annotations[0].faces = {0};
    set.annotations[0].colour = {1, 2, 3};
    set.annotations[1].faces = {0, 1};
    set.annotations[1].colour = {4, 5, 6};
    set.annotations[2].type = AnnotationType::point;
    set.annotations[2].points = {8};
    set.annotations[2].colour = {255, 0, 0};
    const MeshExtras extras = colour_by_annotation({mesh, set});
    EXPECT_EQ(extras.face_colours[0], (Colour{1, 2, 3, 255}));
    EXPECT_EQ(extras.face_colours[1], (Colour{4, 5, 6, 255}));
    EXPECT_EQ(extras.face_colours[2], (Colour{200, 200, 200, 255}));
    EXPECT_EQ(extras.vertex_colours[8], (Colour{255, 0, 0, 255}));
}

TEST(Remap, FollowsMapsAndReportsLosses) {
    const Mesh before = grid(4);
    AnnotationSet set;
    set.annotations.resize(3);
    set.annotations[0].faces = {0, 1, 2};
    set.annotations[1].type = AnnotationType::line;
    set.annotations[1].id = 1;
    set.annotations[1].polylines = {{0, 1, 2, 3}};
    set.annotations[2].type = AnnotationType::point;
    set.annotations[2].id = 2;
    set.annotations[2].points = {24, 6};
    // The same mesh with its vertices in reverse order and without its last cell.
    TriangleSoup soup = to_soup(before);
    std::reverse(soup.points.begin(), soup.points.end());
    for (auto& triangle : soup.triangles)
        for (Index& v : triangle) v = 24 - v;
    soup.triangles.resize(30);
    const Mesh after = build_mesh(soup);
    std::vector<Index> vertices(25), faces = identity(32);
    for (Index v = 0; v < 25; ++v) vertices[v] = 24 - v;
    vertices[24] = no_index;
    faces[30] = faces[31] = no_index;
    for (const bool with_faces : {true, false}) {
        const AnnotationSet moved = remap_annotations({before, set}, after, vertices, with_faces ? faces : std::vector<Index>());
        EXPECT_EQ(moved.annotations[0].faces, (std::vector<Index>{0, 1, 2}));
        EXPECT_EQ(moved.annotations[1].polylines, (std::vector<std::vector<Index>>{{24, 23, 22, 21}}));
        EXPECT_EQ(moved.annotations[2].points, std::vector<Index>{18});
    }
    faces[0] = faces[1] = faces[2] = no_index;
    const AnnotationSet lost = remap_annotations({before, set}, after, vertices, faces);
    EXPECT_EQ(lost.annotations[0].type, AnnotationType::line);
    EXPECT_FALSE(lost.annotations[0].note.empty());
    EXPECT_THROW(remap_annotations({before, set}, after, {0, 1}), Error);
    EXPECT_EQ(remap_labels({5, 6, 7}, {1, no_index, 1}, 3), (std::vector<std::int32_t>{-1, 5, -1}));
    EXPECT_THROW(remap_labels({5}, {3}, 3), Error);
    EXPECT_THROW(remap_labels({5, 6}, {0}, 3), Error);
}

TEST(Remap, MapFilesAreChecked) {
    const Scratch scratch;
    const auto file = [&](const std::string& members) {
        return scratch.file("m.json", R"({"format": "ostraka-map", "version": 1, )" + members + "}");
    };
    EXPECT_EQ(read_index_map(file(R"("kind": "vertex", "from": 3, "to": 2, "map": [1, -1, 0])"), "vertex", 3, 2),
              (std::vector<Index>{1, no_index, 0}));
    const auto fails = [&](const std::string& members, const std::string& expected) {
        const std::string message = error_of([&] { read_index_map(file(members), "vertex", 3, 2); });
        EXPECT_NE(message.find(expected), std::string::npos) << message;
    };
    fails(R"("kind": "face", "from": 3, "to": 2, "map": [1, -1, 0])", "kind 'face'");
    fails(R"("kind": "vertex", "from": 4, "to": 2, "map": [1, -1, 0])", "/from");
    fails(R"("kind": "vertex", "from": 3, "to": 9, "map": [1, -1, 0])", "/to");
    fails(R"("kind": "vertex", "from": 3, "to": 2, "map": [1, -1])", "2 entries");
    fails(R"("kind": "vertex", "from": 3, "to": 2, "map": [1, -1, 2])", "/map/2");
    fails(R"("kind": "vertex", "from": 3, "to": 2, "map": [1, -2, 0])", "at least -1");
    fails(R"("kind": "vertex", "from": 3, "to": 2)", "map");
}
