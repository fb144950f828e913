#include "ostraka/annotation/annotation_file.h"

#include "annotation/example_meshes.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/core/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

using namespace ostraka;
using namespace ostraka::example;

namespace {

AnnotationSet parse(const std::string& text, const Mesh& mesh, const ReadAnnotationsOptions& options = {}) {
    return annotations_from_json(parse_json(text, "a.ant.json"), mesh, "a.ant.json", options);
}

std::string error_of(const std::string& text, const Mesh& mesh) {
    try {
        parse(text, mesh);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        return error.what();
    }
    return "no error";
}

void expect_error(const std::string& text, const Mesh& mesh, const std::string& pointer, const std::string& expected) {
    const std::string message = error_of(text, mesh);
    EXPECT_NE(message.find("a.ant.json"), std::string::npos) << message;
    EXPECT_NE(message.find(pointer), std::string::npos) << message << "\n  for " << text;
    EXPECT_NE(message.find(expected), std::string::npos) << message << "\n  for " << text;
}

std::string with(const std::string& annotation) { return R"({"annotations": [)" + annotation + "]}"; }

std::string written(const AnnotationSet& set, const Mesh& mesh) {
    return to_text(annotations_to_json({mesh, set}, "folder/mesh.ply", Provenance{}));
}

/// The cells [a, b) x [c, d) of a grid of n x n cells.
std::vector<Index> cells(Index n, Index a, Index b, Index c, Index d) {
    std::vector<Index> faces;
    for (Index j = c; j < d; ++j)
        for (Index i = a; i < b; ++i) faces.insert(faces.end(), {2 * (i + j * n), 2 * (i + j * n) + 1});
    return faces;
}

AnnotationSet everything(const Mesh& mesh) {
    AnnotationSet set;
    set.object_class = "flowered teapot";
    set.unit = "mm";
    set.up = std::array<double, 3>{0, 0, 1};
    Annotation region;
    region.id = 3;
    region.tag = "fl\xC3\xB6wer \"x\"";
    region.colour = {200, 30, 60};
    region.faces = cells(8, 1, 3, 1, 4);
    region.attributes.push_back({0, "glaze", Note{"cobalt", ""}});
    Attribute height{1, "height", Measure()};
    height.measure()->tool = "bounding";
    height.measure()->points = {12, 28};
    height.measure()->direction = std::array<double, 3>{0, 0.1, 1};
    height.measure()->value = 31.25;
    height.measure()->unit = "mm";
    height.measure()->stale = true;
    height.measure()->locations = {face_point(3, {0.25, 0.25, 0.5}), face_point(4, {1, 0, 0})};
    region.attributes.push_back(height);
    Attribute area{7, "area", Descriptor()};
    area.descriptor()->values = {0.1};
    area.descriptor()->unit = "mm2";
    region.attributes.push_back(area);
    Attribute list{8, "radii", Descriptor()};
    list.descriptor()->values = {1, 2.5};
    list.descriptor()->is_list = true;
    region.attributes.push_back(list);
    Annotation line;
    line.id = 1;
    line.type = AnnotationType::line;
    line.tag = "rim";
    line.polylines = {{0, 1, 10, 0}, {20, 21, 31}};
    line.note = "was cut";
    Annotation point;
    point.id = 2;
    point.type = AnnotationType::point;
    point.tag = "tip";
    point.points = {40, 3};
    set.annotations = {region, line, point};
    ensure_root(set, mesh);
    return set;
}

}  // namespace

TEST(AnnotationFile, WriteReadWriteGivesTheSameBytes) {
    const Mesh mesh = grid(8);
    const AnnotationSet set = everything(mesh);
    const std::string first = written(set, mesh);
    const AnnotationSet back = parse(first, mesh);
    EXPECT_EQ(written(back, mesh), first);
    EXPECT_TRUE(back.notes.empty()) << back.notes.front();
    ASSERT_EQ(back.annotations.size(), set.annotations.size());
    for (std::size_t i = 0; i < back.annotations.size(); ++i) {
        EXPECT_EQ(back.annotations[i].faces, set.annotations[i].faces);
        EXPECT_EQ(back.annotations[i].points, set.annotations[i].points);
        EXPECT_EQ(back.annotations[i].polylines, set.annotations[i].polylines);
        EXPECT_EQ(back.annotations[i].tag, set.annotations[i].tag);
        EXPECT_EQ(back.annotations[i].attributes.size(), set.annotations[i].attributes.size());
    }
    EXPECT_EQ(back.annotations[1].attributes[1].measure()->locations[0].weights,
              set.annotations[1].attributes[1].measure()->locations[0].weights);
    EXPECT_EQ(first.find("folder"), std::string::npos) << "no folder in a result file";
}

TEST(AnnotationFile, TheThesisFormatIsReadExactly) {
    // Appendix B.1, member for member.
    const Mesh mesh = grid(3);
    const AnnotationSet set = parse(R"({"annotations": [
      {"id": 18, "tag": "flower", "colour": [1, 2, 255], "type": "region", "boundaries": [[0, 1, 5, 4]],
       "attributes": [{"id": 0, "name": "glaze", "type": "semantic", "note": "free text"},
                      {"id": 1, "name": "width", "type": "measure", "measure": {"tool": "ruler", "points": [0, 5]}},
                      {"id": 2, "name": "span", "type": "measure", "measure": {"tool": "tape", "points": [0, 1, 5]}},
                      {"id": 3, "name": "height", "type": "measure",
                       "measure": {"tool": "bounding", "points": [0, 5], "direction": [0, 1.5, 0]}}]},
      {"id": 25, "tag": "Curve", "colour": [0, 0, 0], "type": "line", "polylines": [[0, 1, 2], [4, 5]], "attributes": []},
      {"id": 26, "tag": "Tip", "colour": [0, 0, 0], "type": "point", "points": [15], "attributes": []}]})",
                                    mesh);
    ASSERT_EQ(set.annotations.size(), 3U);
    EXPECT_EQ(set.annotations[0].faces, (std::vector<Index>{0, 1}));
    EXPECT_EQ(set.annotations[0].colour, (std::array<int, 3>{1, 2, 255}));
    EXPECT_EQ(set.annotations[0].attributes[3].measure()->direction, (std::array<double, 3>{0, 1.5, 0}));
    EXPECT_EQ(set.annotations[1].polylines, (std::vector<std::vector<Index>>{{0, 1, 2}, {4, 5}}));
    EXPECT_EQ(set.annotations[2].points, std::vector<Index>{15});
    ASSERT_EQ(set.notes.size(), 1U);  // it does not identify its mesh
    // The written file has the same members.
    const Json out = annotations_to_json({mesh, set}, "m.ply", {});
    const JsonValue& region = out["annotations"][0];
    for (const char* member : {"id", "tag", "colour", "attributes", "type", "boundaries"})
        EXPECT_NE(find_member(region, member), nullptr) << member;
    EXPECT_STREQ(region["attributes"][2]["measure"]["tool"].GetString(), "tape");
}

TEST(AnnotationFile, ThePrototypesFilesAreRead) {
    const Mesh mesh = grid(3);
    const AnnotationSet set = parse(R"({"annotations": [
      {"id": "4", "tag": "a", "color": [1, 2, 3], "type": "Area", "boundaries": [[0, 1, 5, 4, 0]], "attributes": [
        {"id": 0, "name": "h", "type": "Geometric", "value": 1.0, "points": [0, 5], "tool": "height", "direction": [0, 1, 0]},
        {"id": 1, "name": "r", "type": "Geometric", "value": 1.5, "points": [0, 5], "tool": "ruler"},
        {"id": 2, "name": "c", "type": "Geometric", "value": 2.5},
        {"id": 3, "name": "s", "type": "Semantic", "value": "text"}]},
      {"id": 5, "tag": "l", "color": [1, 2, 3], "type": "Line", "polylines": [[0, 1]], "attributes": []},
      {"id": 6, "tag": "p", "color": [1, 2, 3], "type": "Point", "points": [3], "attributes": []}]})",
                                    mesh);
    ASSERT_EQ(set.annotations.size(), 3U);
    EXPECT_EQ(set.annotations[0].id, 4);
    EXPECT_EQ(set.annotations[0].faces, (std::vector<Index>{0, 1}));
    EXPECT_EQ(set.annotations[0].colour, (std::array<int, 3>{1, 2, 3}));
    EXPECT_EQ(set.annotations[0].attributes[0].measure()->tool, "bounding");
    EXPECT_EQ(set.annotations[0].attributes[1].measure()->value, 1.5);
    EXPECT_NE(set.annotations[0].attributes[2].descriptor(), nullptr);
    EXPECT_EQ(set.annotations[0].attributes[3].note()->text, "text");
    EXPECT_GE(set.notes.size(), 3U);
    expect_error(with(R"({"id": "x", "tag": "", "color": [0, 0, 0], "type": "Area"})"), mesh, "/annotations/0/id",
                 "whole number");
    expect_error(with(R"({"id": 1, "tag": "", "color": [0, 0, 0], "type": "Volume"})"), mesh, "/annotations/0/type", "volume");
}

TEST(AnnotationFile, WholeClosedComponentsAreKeptBySeeds) {
    const Mesh mesh = spheres(1, {{0, 0, 0}, {5, 0, 0}, {10, 0, 0}});
    const Index per_sphere = static_cast<Index>(mesh.number_of_faces() / 3);
    AnnotationSet set;
    Annotation region;
    region.faces.resize(per_sphere);
    std::iota(region.faces.begin(), region.faces.end(), per_sphere);  // the second sphere
    region.faces.push_back(2 * per_sphere + 3);                       // and a triangle of the third
    set.annotations.push_back(region);
    const std::string text = written(set, mesh);
    EXPECT_NE(text.find("seeds"), std::string::npos) << text;
    EXPECT_EQ(text.find("\"faces\": ["), std::string::npos) << text;
    EXPECT_EQ(parse(text, mesh).annotations[0].faces, region.faces);
    const std::string seed = std::to_string(per_sphere);
    expect_error(with(R"({"id": 0, "tag": "", "type": "region", "seeds": [)" + seed + ", " + seed + "]}"), mesh,
                 "/annotations/0/seeds/1", "already");
    const auto [a, b, c] = corners(mesh, Face(3));
    const std::string triangle = std::to_string(Index(a)) + ", " + std::to_string(Index(b)) + ", " + std::to_string(Index(c));
    expect_error(with(R"({"id": 0, "tag": "", "type": "region", "boundaries": [[)" + triangle + R"(]], "seeds": [5]})"), mesh,
                 "/annotations/0/seeds/0", "outline");
}

TEST(AnnotationFile, RegionsOfAnyTopologySurvive) {
    const Mesh mesh = grid(8);
    // Two patches that touch at a vertex, one of them with a hole, on the border of an open mesh.
    std::vector<Index> faces = cells(8, 0, 4, 0, 4);
    const std::vector<Index> hole = cells(8, 1, 3, 1, 3), patch = cells(8, 4, 6, 4, 6);
    std::erase_if(faces, [&](Index face) { return std::find(hole.begin(), hole.end(), face) != hole.end(); });
    faces.insert(faces.end(), patch.begin(), patch.end());
    std::sort(faces.begin(), faces.end());
    AnnotationSet set;
    set.annotations.emplace_back().faces = faces;
    const std::string text = written(set, mesh);
    EXPECT_EQ(parse(text, mesh).annotations[0].faces, faces);
    EXPECT_EQ(parse_json(text, "t")["annotations"][0]["boundaries"].Size(), 3U);
    EXPECT_EQ(find_member(parse_json(text, "t")["annotations"][0], "faces"), nullptr);
}

TEST(AnnotationFile, AnEmptySetAndAnEmptyRegion) {
    const Mesh mesh = grid(1);
    EXPECT_TRUE(parse(R"({"annotations": []})", mesh).annotations.empty());
    AnnotationSet set;
    set.annotations.emplace_back();
    EXPECT_TRUE(parse(written(set, mesh), mesh).annotations[0].faces.empty());
}

TEST(AnnotationFile, FacesMayReplaceBoundaries) {
    const Mesh mesh = grid(3);
    EXPECT_EQ(parse(with(R"({"id": 0, "tag": "", "type": "region", "faces": [7, 2, 7]})"), mesh).annotations[0].faces,
              (std::vector<Index>{2, 7}));
    EXPECT_EQ(parse(with(R"({"id": 0, "tag": "", "type": "region", "all": true})"), mesh).annotations[0].faces.size(),
              mesh.number_of_faces());
    expect_error(with(R"({"id": 0, "tag": "", "type": "region", "faces": [0], "boundaries": [[0, 1, 5, 4]]})"), mesh,
                 "/annotations/0/boundaries", "not those");
}

TEST(AnnotationFile, AnotherMeshIsRefusedUnlessForced) {
    const Mesh mesh = grid(8), finer = grid(9), scaled = grid(8, 2.0);
    const std::string text = written(everything(mesh), mesh);
    EXPECT_NE(error_of(text, finer).find("81 vertices instead of 100"), std::string::npos) << error_of(text, finer);
    EXPECT_NE(error_of(text, finer).find("128 faces instead of 162"), std::string::npos);
    EXPECT_NE(error_of(text, scaled).find("checksum"), std::string::npos) << error_of(text, scaled);
    EXPECT_NE(error_of(text, scaled).find("--force-mesh"), std::string::npos);
    const AnnotationSet forced = parse(text, scaled, {.force_mesh = true});
    EXPECT_EQ(forced.annotations.size(), 4U);
    ASSERT_EQ(forced.notes.size(), 1U);
    EXPECT_THROW(parse(text, grid(2), {.force_mesh = true}), Error) << "indices are checked all the same";
}

TEST(AnnotationFile, ErrorsOfTheFileAndItsSelections) {
    const Mesh mesh = grid(3);
    expect_error("[]", mesh, "root", "object");
    expect_error(R"({"format": "ostraka-graph", "annotations": []})", mesh, "/format", "ostraka-graph");
    expect_error(R"({"version": 3, "annotations": []})", mesh, "/version", "newer");
    expect_error(R"({"format": "ostraka-annotations", "up": [0, 0, 0], "annotations": []})", mesh, "/up", "no length");
    expect_error(with(R"({"id": 1.5, "tag": "", "type": "point", "points": []})"), mesh, "/annotations/0/id",
                 "needs a whole number");
    expect_error(with(R"({"id": 1, "type": "point", "points": []})"), mesh, "/annotations/0", "tag");
    expect_error(with(R"({"id": 1, "tag": "", "type": "volume"})"), mesh, "/annotations/0/type", "region");
    expect_error(with(R"({"id": 1, "tag": "", "type": "point"})"), mesh, "/annotations/0", "points");
    expect_error(with(R"({"id": 1, "tag": "", "type": "line"})"), mesh, "/annotations/0", "polylines");
    expect_error(with(R"({"id": 1, "tag": "", "type": "region"})"), mesh, "/annotations/0", "boundaries");
    expect_error(with(R"({"id": 1, "tag": "", "type": "point", "points": [], "boundaries": []})"), mesh,
                 "/annotations/0/boundaries", "belong");
    expect_error(with(R"({"id": 1, "tag": "", "colour": [0, 0, 256], "type": "point", "points": []})"), mesh,
                 "/annotations/0/colour/2", "255");
    expect_error(with(R"({"id": 1, "tag": "", "type": "point", "points": [3, 16]})"), mesh, "/annotations/0/points/1",
                 "16 vertices");
    expect_error(with(R"({"id": 1, "tag": "", "type": "point", "points": [-1]})"), mesh, "/annotations/0/points/0", "at least 0");
    expect_error(with(R"({"id": 1, "tag": "", "type": "line", "polylines": [[0, 1], [0, 1, 2, 15]]})"), mesh,
                 "/annotations/0/polylines/1/3", "no edge from vertex 2 to vertex 15");
    expect_error(with(R"({"id": 1, "tag": "", "type": "line", "polylines": [[0, 0]]})"), mesh, "/annotations/0/polylines/0/1",
                 "follows itself");
    expect_error(with(R"({"id": 1, "tag": "", "type": "line", "polylines": [[3]]})"), mesh, "/annotations/0/polylines/0",
                 "1 vertex");
    expect_error(with(R"({"id": 1, "tag": "", "type": "region", "boundaries": [[0, 1, 5, 4], [0, 9, 2]]})"), mesh,
                 "/annotations/0/boundaries/1/1", "no edge");
    expect_error(with(R"({"id": 1, "tag": "", "type": "region", "boundaries": [[0, 1]]})"), mesh, "/annotations/0/boundaries/0",
                 "three");
    expect_error(with(R"({"id": 1, "tag": "", "type": "region", "boundaries": [[0, 1, 99]]})"), mesh,
                 "/annotations/0/boundaries/0/2", "99");
    expect_error(with(R"({"id": 1, "tag": "", "type": "region", "faces": [18]})"), mesh, "/annotations/0/faces/0", "18 faces");
    expect_error(with(R"({"id": 1, "tag": "", "type": "region", "seeds": [18]})"), mesh, "/annotations/0/seeds/0", "18 faces");
    expect_error(
        with(R"({"id": 1, "tag": "", "type": "point", "points": []}, {"id": 1, "tag": "", "type": "point", "points": []})"), mesh,
        "/annotations/1/id", "taken");
    // The centre cell with its outline counter-clockwise, and the ring around it with its outer outline clockwise.
    expect_error(with(R"({"id": 1, "tag": "", "type": "region", "boundaries":
                 [[5, 6, 10, 9], [0, 4, 5, 1]]})"),
                 mesh, "/annotations/0/boundaries", "left");
}

TEST(AnnotationFile, ErrorsOfAttributes) {
    const Mesh mesh = grid(3);
    const auto attribute = [&](const std::string& text) {
        return with(R"({"id": 1, "tag": "", "type": "point", "points": [0], "attributes": [)" + text + "]}");
    };
    expect_error(attribute(R"({"id": 0, "name": "n", "type": "semantic"})"), mesh, "/annotations/0/attributes/0", "note");
    expect_error(attribute(R"({"id": 0, "name": "n", "type": "measure"})"), mesh, "/annotations/0/attributes/0", "measure");
    expect_error(attribute(R"({"id": 0, "name": "n", "type": "odd"})"), mesh, "/annotations/0/attributes/0/type", "semantic");
    expect_error(attribute(R"({"id": 0, "name": "n", "type": "descriptor", "value": 1, "file": "x.npy"})"), mesh,
                 "/annotations/0/attributes/0", "keep one");
    expect_error(attribute(R"({"id": 0, "name": "n", "type": "semantic", "note": ""},
                              {"id": 0, "name": "n", "type": "semantic", "note": ""})"),
                 mesh, "/annotations/0/attributes/1/id", "taken");
    const auto measure = [&](const std::string& text) {
        return attribute(R"({"id": 0, "name": "n", "type": "measure", "measure": {)" + text + "}}");
    };
    const std::string ruler = R"("tool": "ruler", "points": [0, 1], "locations": )";
    expect_error(measure(R"("tool": "laser", "points": [0, 1])"), mesh, "/measure/tool", "ruler");
    expect_error(measure(R"("tool": "ruler", "points": [0])"), mesh, "/measure/points", "two points");
    expect_error(measure(R"("tool": "ruler", "points": [0, 77])"), mesh, "/measure/points/1", "77");
    expect_error(measure(R"("tool": "bounding", "points": [0, 1])"), mesh, "/measure", "direction");
    expect_error(measure(R"("tool": "bounding", "points": [0, 1], "direction": [0, 0, 0])"), mesh, "/measure/direction",
                 "no length");
    expect_error(measure(R"("tool": "bounding", "points": [0, 1], "direction": [0, 0])"), mesh, "/measure/direction",
                 "at least 3 entries");
    expect_error(measure(ruler + R"([{"face": 0, "barycentric": [1, 0, 0]}])"), mesh, "/measure/locations",
                 "1 locations for 2 points");
    expect_error(measure(ruler + R"([{"face": 99, "barycentric": [1, 0, 0]}, {"face": 0, "barycentric": [1, 0, 0]}])"), mesh,
                 "/measure/locations/0/face", "99");
    expect_error(measure(ruler + R"([{"face": 0, "barycentric": [1, 1, 0]}, {"face": 0, "barycentric": [1, 0, 0]}])"), mesh,
                 "/measure/locations/0/barycentric", "sum");
}

TEST(AnnotationFile, UnknownMembersAreNoted) {
    const AnnotationSet set =
        parse(R"({"mesh": {}, "colour": 1, "annotations": [{"id": 0, "tag": "", "type": "point", "points": [0], "level": 3}]})",
              grid(1));
    ASSERT_EQ(set.notes.size(), 2U);
    EXPECT_NE(set.notes[0].find("/colour"), std::string::npos);
    EXPECT_NE(set.notes[1].find("/annotations/0/level"), std::string::npos);
}

TEST(AnnotationFile, WritingChecksTheSet) {
    const Mesh mesh = grid(3);
    AnnotationSet set;
    set.annotations.emplace_back().faces = {3, 99};
    EXPECT_THROW(annotations_to_json({mesh, set}, "m", {}), Error);
    const Path file = Path(testing::TempDir()) / "never.ant.json";
    std::filesystem::remove(file);
    EXPECT_THROW(write_annotations(file, {mesh, set}, "m", {}), Error);
    EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(Annotations, TheRootIsTheWholeObject) {
    const Mesh mesh = grid(2);
    AnnotationSet set;
    set.object_class = "vase";
    set.annotations.emplace_back().id = 4;
    Annotation& root = ensure_root(set, mesh);
    EXPECT_TRUE(root.all);
    EXPECT_EQ(root.tag, "vase");
    EXPECT_EQ(root.id, 5);
    EXPECT_EQ(root.faces.size(), mesh.number_of_faces());
    root.tag = "kept";
    EXPECT_EQ(ensure_root(set, mesh).tag, "kept");
    EXPECT_EQ(set.annotations.size(), 2U);
}
