#include "ostraka/select/recipe.h"

#include "annotation/example_meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/core/error.h"
#include "ostraka/measure/examine.h"
#include "ostraka/select/selections.h"
#include "ostraka/synthetic/make_mesh.h"
#include "select/real_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numbers>

using namespace ostraka;
using namespace ostraka::example;

namespace {

AnnotationSet follow(const std::string& text, const Mesh& mesh, const std::vector<std::int32_t>& labels = {}) {
    return apply_recipe(parse_json(text, "r.json"), mesh, labels, "r.json");
}

std::string recipe(const std::string& steps, const std::string& head = "") {
    return R"({"format": "ostraka-recipe", "version": 1, )" + head + R"("annotations": [)" + steps + "]}";
}

std::string step(const std::string& type, const std::string& select, const std::string& rest = "", int id = 0) {
    return R"({"id": )" + std::to_string(id) + R"(, "tag": "t", "type": ")" + type + R"(", "select": )" + select + rest + "}";
}

std::vector<Index> faces_of(const std::string& select, const Mesh& mesh, const std::string& head = "") {
    return follow(recipe(step("region", select), head), mesh).annotations.at(0).faces;
}

double area_of(const std::string& select, const Mesh& mesh) { return measure_region(mesh, faces_of(select, mesh)).area; }

void expect_error(const std::string& text, const Mesh& mesh, const std::string& pointer, const std::string& expected) {
    try {
        follow(text, mesh);
        FAIL() << text;
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("r.json"), std::string::npos) << message;
        EXPECT_NE(message.find(pointer), std::string::npos) << message << "\n  for " << text;
        EXPECT_NE(message.find(expected), std::string::npos) << message << "\n  for " << text;
    }
}

}  // namespace

TEST(Recipe, VolumesSelectByCentroidAndByVertex) {
    const Mesh mesh = grid(4);
    EXPECT_DOUBLE_EQ(area_of(R"({"box": {"min": [0, 0, 0], "max": [2, 3, 0]}})", mesh), 6);
    EXPECT_DOUBLE_EQ(area_of(R"({"halfspace": {"point": [3, 0, 0], "normal": [1, 0, 0]}})", mesh), 4);
    const Mesh fine = grid(100);
    EXPECT_NEAR(area_of(R"({"sphere": {"centre": [50, 50, 0], "radius": 30}})", fine), std::numbers::pi * 900,
                0.01 * std::numbers::pi * 900);
    const auto points =
        follow(recipe(step("point", R"({"sphere": {"centre": [1, 1, 0], "radius": 1}})")), mesh).annotations[0].points;
    EXPECT_EQ(points, (std::vector<Index>{1, 5, 6, 7, 11}));
}

TEST(Recipe, NormalsOfAnyLengthAndFinitePoints) {
    const Mesh ball = spheres(3);
    const std::vector<Index> plain = faces_of(R"({"halfspace": {"point": [0.1, 0, 0], "normal": [1, 1, -1]}})", ball);
    ASSERT_GT(plain.size(), 0U);
    for (const std::string n : {"1e308", "1e-320"})
        EXPECT_EQ(faces_of(R"({"halfspace": {"point": [0.1, 0, 0], "normal": [)" + n + "," + n + ", -" + n + "]}}", ball), plain);
    // Squared distances would overflow: no face is nearest then.
    for (const std::string select :
         {R"({"component": {"seed": [1e155, 0, 0]}})", R"({"sphere": {"centre": [0, 1.1e60, 0], "radius": 1}})",
          R"({"halfspace": {"point": [0, 0, 1e200], "normal": [0, 0, 1]}})",
          R"({"threshold": {"distance": [[1e200, 0, 0]], "below": 1}})",
          R"({"frame": "box", "box": {"min": [0, 0, 0], "max": [1, 1e308, 1]}})"})
        expect_error(recipe(step("region", select)), ball, "/annotations/0/select", "beyond what can be computed with");
}

TEST(Recipe, TheBoxFrameFitsAnyPositionAndScale) {
    const std::string select = R"({"frame": "box", "box": {"min": [0, 0, 0], "max": [0.5, 1, 1]}})";
    const std::vector<Index> expected = faces_of(select, grid(4));
    EXPECT_EQ(expected.size(), 16U);
    for (const double scale : {1e-9, 1e9}) EXPECT_EQ(faces_of(select, grid(4, scale)), expected);
    EXPECT_EQ(faces_of(R"({"box": {"min": [0, 0, 0], "max": [0.5, 1, 1]}})", grid(4), R"("frame": "box", )"), expected);
    EXPECT_EQ(faces_of(R"({"frame": "mesh", "box": {"min": [0, 0, 0], "max": [2, 4, 1]}})", grid(4), R"("frame": "box", )"),
              expected);
    const Mesh far = spheres(3, {{1e6, -1e6, 1e6}});
    EXPECT_EQ(faces_of(R"({"frame": "box", "sphere": {"centre": [0.5, 0.5, 1], "radius": 0.2}})", far),
              faces_of(R"({"frame": "box", "sphere": {"centre": [0.5, 0.5, 1], "radius": 0.2}})", spheres(3)));
}

TEST(Recipe, SetAlgebraObeysItsLaws) {
    const Mesh mesh = spheres(3);
    const std::string a = R"({"halfspace": {"point": [0, 0, 0.1], "normal": [0, 0, 1]}})",
                      b = R"({"sphere": {"centre": [1, 0, 0], "radius": 0.9}})";
    const auto op = [](const std::string& name, const std::string& x, const std::string& y) {
        return "{\"" + name + "\": [" + x + ", " + y + "]}";
    };
    const auto invert = [](const std::string& x) { return R"({"invert": )" + x + "}"; };
    EXPECT_EQ(faces_of(invert(op("union", a, b)), mesh), faces_of(op("intersection", invert(a), invert(b)), mesh));
    EXPECT_EQ(faces_of(op("difference", a, b), mesh), faces_of(op("intersection", a, invert(b)), mesh));
    EXPECT_EQ(faces_of(op("union", a, invert(a)), mesh).size(), mesh.number_of_faces());
    EXPECT_EQ(faces_of(invert(invert(a)), mesh), faces_of(a, mesh));
    const AnnotationSet set =
        follow(recipe(step("region", a, "", 4) + "," + step("region", op("difference", b, R"({"annotation": 4})"), "", 5)), mesh);
    EXPECT_EQ(set.annotations[1].faces, faces_of(op("difference", b, a), mesh));
}

TEST(Recipe, ALassoEnclosesItsSeed) {
    const Mesh mesh = grid(10);
    const std::string square = R"({"lasso": {"points": [[2, 2, 0], [8, 2, 0], [8, 8, 0], [2, 8, 0]], "seed": )";
    const double inside = area_of(square + "[5, 5, 0]}}", mesh), outside = area_of(square + "[0.2, 0.1, 0]}}", mesh);
    EXPECT_DOUBLE_EQ(inside, 36);
    EXPECT_DOUBLE_EQ(inside + outside, 100);
    EXPECT_DOUBLE_EQ(area_of(square + R"([5, 5, 0], "metric": "segment"}})", mesh), 36);
    // On a sphere, a path around the equator leaves the northern half.
    const Mesh sphere = spheres(4);
    const auto north =
        faces_of(R"({"lasso": {"points": [[1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]], "seed": [0, 0, 1]}})", sphere);
    EXPECT_EQ(north.size(), sphere.number_of_faces() / 2);
}

TEST(Recipe, PathsComponentsAndPicks) {
    const Mesh mesh = grid(4);
    const auto lines = [&](const std::string& select) {
        return follow(recipe(step("line", select)), mesh).annotations[0].polylines;
    };
    EXPECT_EQ(lines(R"({"path": {"points": [0, [2, 0, 0], 4]}})"), (std::vector<std::vector<Index>>{{0, 1, 2, 3, 4}}));
    EXPECT_EQ(lines(R"({"path": {"points": [0, 1, 6], "closed": true}})"), (std::vector<std::vector<Index>>{{0, 1, 6, 0}}));
    EXPECT_EQ(lines(R"({"union": [{"vertices": [0, 1]}, {"vertices": [[4, 4, 0], [3, 4, 0]]}]})"),
              (std::vector<std::vector<Index>>{{0, 1}, {24, 23}}));
    const auto points = [&](const std::string& select) {
        return follow(recipe(step("point", select)), mesh).annotations[0].points;
    };
    EXPECT_EQ(points(R"({"nearest": [3.9, 0.2, 5]})"), std::vector<Index>{4});
    EXPECT_EQ(points(R"({"union": [{"vertices": [9, 3, 9]}, {"nearest": [0, 0, 0]}]})"), (std::vector<Index>{9, 3, 0}));
    EXPECT_EQ(points(R"({"difference": [{"vertices": [9, 3, 7]}, {"vertices": [3]}]})"), (std::vector<Index>{9, 7}));
    EXPECT_EQ(points(R"({"intersection": [{"vertices": [9, 3, 7]}, {"vertices": [7, 9]}]})"), (std::vector<Index>{9, 7}));
    const Mesh two = spheres(1, {{0, 0, 0}, {5, 0, 0}});
    const auto second = faces_of(R"({"component": {"seed": [6, 0, 0]}})", two);
    EXPECT_EQ(second.size(), two.number_of_faces() / 2);
    EXPECT_EQ(second.front(), two.number_of_faces() / 2);
    EXPECT_EQ(
        faces_of(R"({"component": {"seed": [0, 2, 0], "of": {"invert": {"box": {"min": [1, 0, 0], "max": [3, 4, 0]}}}}})", mesh),
        faces_of(R"({"box": {"min": [0, 0, 0], "max": [1, 4, 0]}})", mesh));
    expect_error(recipe(step("region", R"({"component": {"seed": 0, "of": {"faces": [5]}}})")), mesh, "/component/seed",
                 "does not belong");
    EXPECT_EQ(faces_of(R"({"faces": [3, 1]})", two), (std::vector<Index>{1, 3}));
    EXPECT_EQ(follow(recipe(step("region", R"({"labels": [2, 7]})")), grid(1), {7, 1}).annotations[0].faces,
              std::vector<Index>{0});
}

TEST(Recipe, MeasuresAndDescriptorsAreComputed) {
    const Mesh mesh = grid(4);
    const AnnotationSet set =
        follow(recipe(step("region", R"({"box": {"min": [0, 0, 0], "max": [2, 3, 0]}})", R"(, "attributes": [
        {"id": 0, "name": "colour", "type": "semantic", "note": "red"},
        {"id": 1, "name": "diagonal", "type": "measure", "measure": {"tool": "ruler", "points": [[0, 0, 0], [3, 4, 0]]}},
        {"id": 2, "name": "way", "type": "measure", "measure": {"tool": "tape", "points": [0, 4, 9]}},
        {"id": 3, "name": "height", "type": "measure", "measure": {"tool": "bounding", "direction": [0, 2, 0]}},
        {"id": 4, "name": "area", "type": "descriptor"}])"),
                      R"("unit": "mm", "class": "tile", )"),
               mesh);
    ASSERT_EQ(set.annotations.size(), 2U);
    EXPECT_TRUE(set.annotations[0].all) << "the class stands for the whole object";
    EXPECT_EQ(set.annotations[0].tag, "tile");
    const auto& attributes = set.annotations[1].attributes;
    EXPECT_EQ(attributes[0].note()->text, "red");
    EXPECT_DOUBLE_EQ(attributes[1].measure()->value.value(), 5);
    EXPECT_DOUBLE_EQ(attributes[2].measure()->value.value(), 5);
    EXPECT_DOUBLE_EQ(attributes[3].measure()->value.value(), 3);
    EXPECT_EQ(attributes[3].measure()->unit, "mm");
    EXPECT_DOUBLE_EQ(attributes[4].descriptor()->values.at(0), 6);
    EXPECT_EQ(attributes[4].descriptor()->unit, "mm^2");
    // Written, read and written again: the same bytes; followed again: the same bytes.
    const std::string text = to_text(annotations_to_json({mesh, set}, "m", {}));
    EXPECT_EQ(to_text(annotations_to_json({mesh, annotations_from_json(parse_json(text, "t"), mesh, "t")}, "m", {})), text);
}

TEST(Recipe, ErrorsNameTheStep) {
    const Mesh mesh = grid(4);
    const std::string at = "/annotations/0/select";
    expect_error(R"({"format": "ostraka-annotations", "annotations": []})", mesh, "/format", "ostraka-annotations");
    expect_error(R"({"version": 1, "annotations": []})", mesh, "root", "format");
    expect_error(recipe("", R"("colour": 1, )"), mesh, "/colour", "unknown member 'colour'");
    expect_error(recipe(step("region", R"({"cube": 1})")), mesh, at, "unknown member 'cube'");
    expect_error(recipe(step("region", "{}")), mesh, at, "at least 1");
    expect_error(recipe(step("region", R"({"frame": "box", "faces": [1], "all": true})")), mesh, at, "at most 2");
    expect_error(recipe(step("region", R"({"faces": [1], "all": true})")), mesh, at, "two kinds");
    expect_error(recipe(step("region", R"({"faces": [99]})")), mesh, at + "/faces/0", "99");
    expect_error(recipe(step("region", R"({"box": {"min": [1, 0, 0], "max": [0, 1, 1]}})")), mesh, at + "/box",
                 "min exceeds max");
    expect_error(recipe(step("region", R"({"box": {"min": [0, 0, 5], "max": [1, 1, 6]}})")), mesh, at, "no face");
    expect_error(recipe(step("point", R"({"sphere": {"centre": [0, 0, 5], "radius": 1}})")), mesh, at, "no vertex");
    expect_error(recipe(step("region", R"({"sphere": {"centre": [0, 0, 5], "radius": -1}})")), mesh, at + "/sphere/radius",
                 "needs a number");
    expect_error(recipe(step("region", R"({"halfspace": {"point": [0, 0, 0], "normal": [0, 0, 0]}})")), mesh,
                 at + "/halfspace/normal", "no length");
    expect_error(recipe(step("region", R"({"vertices": [1]})")), mesh, at + "/vertices", "does not select faces");
    expect_error(recipe(step("line", R"({"nearest": [0, 0, 0]})")), mesh, at + "/nearest", "poly-lines");
    expect_error(recipe(step("point", R"({"path": {"points": [0, 1]}})")), mesh, at + "/path", "points");
    expect_error(recipe(step("line", R"({"vertices": [0, 4]})")), mesh, "/annotations/0/polylines/0/1", "no edge");
    expect_error(recipe(step("line", R"({"path": {"points": [0, 99]}})")), mesh, at + "/path/points/1", "99");
    expect_error(recipe(step("line", R"({"path": {"points": [3, 3]}})")), mesh, at + "/path", "1 different");
    expect_error(recipe(step("region", R"({"labels": [1]})")), mesh, at + "/labels", "no face labels");
    expect_error(recipe(step("region", R"({"annotation": 7})")), mesh, at + "/annotation", "no earlier");
    expect_error(recipe(step("region", R"({"union": [{"faces": [0]}, {"intersection": [{"faces": [77]}]}]})")), mesh,
                 at + "/union/1/intersection/0/faces/0", "77");
    expect_error(recipe(step("region", R"({"difference": [{"faces": [0]}]})")), mesh, at + "/difference", "");
    expect_error(recipe(step("region", R"({"faces": [0]})") + "," + step("region", R"({"faces": [0]})")), mesh,
                 "/annotations/1/id", "taken");
    expect_error(recipe(step("region", R"({"faces": [0]})") + "," + step("line", R"({"annotation": 0})", "", 1)), mesh,
                 "/annotations/1/select/annotation", "is a region");
    expect_error(recipe(step("region", R"({"lasso": {"points": [0, 1], "seed": 0}})")), mesh, at + "/lasso", "cannot be closed");
    expect_error(recipe(step("region", R"({"lasso": {"points": [0, 1, 6], "seed": 99}})")), mesh, at + "/lasso/seed", "99");
    expect_error(
        recipe(step("region", R"({"faces": [0]})", R"(, "attributes": [{"id": 0, "name": "roundness", "type": "descriptor"}])")),
        mesh, "/annotations/0/attributes", "roundness");
    expect_error(recipe(step("region", R"({"faces": [0]})",
                             R"(, "attributes": [{"id": 0, "name": "w", "type": "measure", "measure": {"tool": "tape"}}])")),
                 mesh, "/annotations/0/attributes/0/measure", "neither");
    const Mesh two = spheres(1, {{0, 0, 0}, {5, 0, 0}});
    expect_error(recipe(step("line", R"({"path": {"points": [[1, 0, 0], [6, 0, 0]]}})")), two, at + "/path", "separate parts");
    expect_error(recipe(step("region", R"({"lasso": {"points": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "seed": [6, 0, 0]}})")), two,
                 at + "/lasso", "another part");
    expect_error(recipe(step("region", R"({"faces": [0]})", R"(, "attributes": [{"id": 0, "name": "w", "type": "measure",
                 "measure": {"tool": "tape", "points": [[1, 0, 0], [6, 0, 0]]}}])")),
                 two, "r.json", "no path");
}

TEST(Recipe, EmptyAndTinyMeshes) {
    Mesh empty;
    EXPECT_TRUE(follow(recipe(""), empty).annotations.empty());
    EXPECT_THROW(follow(recipe(step("point", R"({"nearest": [0, 0, 0]})")), empty), Error);
    EXPECT_THROW(follow(recipe(step("region", R"({"component": {"seed": [0, 0, 0]}})")), empty), Error);
    TriangleSoup soup;
    soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    soup.triangles = {{0, 1, 2}};
    const Mesh triangle = build_mesh(soup);
    EXPECT_EQ(faces_of(R"({"all": true})", triangle), std::vector<Index>{0});
    expect_error(recipe(step("region", R"({"lasso": {"points": [0, 1, 2], "seed": 0}})")), triangle, "/lasso", "close off");
}

TEST(Selections, NearestFaceAndVertexSkipElementsWithoutSurface) {
    TriangleSoup soup;
    soup.points = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
    soup.triangles = {{1, 2, 3}, {2, 4, 3}};
    const Mesh mesh = build_mesh(soup);
    EXPECT_EQ(nearest_vertex(mesh, Point(9, 9, 9)), 4U);
    EXPECT_EQ(nearest_face(mesh, Point(0.1, 0.1, 3)), 0U);
    EXPECT_EQ(nearest_face(mesh, Point(5, 0, 0)), 1U);
    EXPECT_THROW((void)component_of(mesh, 9), Error);
}

TEST(Recipe, TheShippedRecipesSatisfyTheSchema) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(Path(OSTRAKA_SOURCE_DIR) / "data")) {
        const std::string name = entry.path().filename().string();
        if (!name.ends_with(".recipe.json")) continue;
        ++count;
        EXPECT_NO_THROW(validate(read_json(entry.path()), "recipe", name));
    }
    EXPECT_GE(count, 2U);
}

TEST(Recipe, TheVaseDrawnOnItsPicturesHasItsTrueParts) {
    MakeOptions options;
    options.vertices = 12000;
    const SyntheticObject& vase = synthetic_object("vase");
    const SyntheticMesh object = make_mesh(vase, options);
    const AnnotationSet set = apply_recipe(Path(OSTRAKA_SOURCE_DIR) / "data/vase-drawn.recipe.json", object.mesh);
    for (std::size_t part = 0; part < vase.parts.size(); ++part) {
        const auto annotation = std::find_if(set.annotations.begin(), set.annotations.end(),
                                             [&](const Annotation& a) { return a.tag == vase.parts[part]; });
        ASSERT_NE(annotation, set.annotations.end()) << vase.parts[part];
        const std::vector<bool> chosen = face_flags(object.mesh, annotation->faces);
        double shared = 0, all = 0;
        for (const Face f : object.mesh.faces()) {
            const bool truth = object.face_labels[f] == static_cast<int>(part);
            if (chosen[f] && truth) shared += face_area(object.mesh, f);
            if (chosen[f] || truth) all += face_area(object.mesh, f);
        }
        EXPECT_GT(shared / all, 0.9) << vase.parts[part];
    }
}

TEST(Recipe, TheLionHeadIsAnnotatedOnItsPictures) {
    OSTRAKA_SCAN(mesh, "lion-head.off");
    const Path file = Path(OSTRAKA_SOURCE_DIR) / "data/lion-head.recipe.json";
    const AnnotationSet set = apply_recipe(file, mesh);
    EXPECT_EQ(to_text(annotations_to_json({mesh, set}, "m", {})),
              to_text(annotations_to_json({mesh, apply_recipe(file, mesh)}, "m", {})));
    for (const Finding& finding : examine({mesh, set})) EXPECT_FALSE(finding.defect) << finding.where << ": " << finding.text;
    const auto area = [&](int id) { return measure_region(mesh, set.find(id)->faces).area; };
    EXPECT_NEAR(area(1) + area(2), area(0), 1e-9 * area(0)) << "neck and head are the whole";
    for (const int id : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12})
        EXPECT_EQ(summarise(mesh, *set.find(id)).patches, 1U) << set.find(id)->tag;
    EXPECT_NEAR(area(6) / area(7), 1, 0.2) << "the eyes";
    EXPECT_NEAR(area(3) / area(4), 1, 0.3) << "the ears";
    EXPECT_NEAR(*set.find(6)->attributes.at(0).measure()->value / *set.find(7)->attributes.at(0).measure()->value, 1, 0.2);
}
