// Self-intersecting lassos, and recipes that edit existing annotations.
#include "annotation/example_meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "select/follow.h"
#include "select/real_mesh.h"

using namespace ostraka;
using namespace ostraka::example;
using namespace ostraka::test;

namespace {

RecipeStart start_with(const std::string& steps, const Mesh& mesh) {
    RecipeStart start;
    start.annotations = follow(steps, mesh);
    return start;
}

const char* const tile_steps = R"(
    {"id": 1, "tag": "left", "type": "region", "select": {"box": {"min": [0, 0, 0], "max": [2, 4, 0]}},
     "attributes": [{"id": 0, "name": "width", "type": "measure", "measure": {"tool": "bounding", "direction": [1, 0, 0]}},
                    {"id": 1, "name": "area", "type": "descriptor"}]},
    {"id": 2, "tag": "way", "type": "line", "select": {"path": {"points": [0, 2, 12, 10, 0], "closed": true}}},
    {"id": 3, "tag": "spots", "type": "point", "select": {"vertices": [7, 3, 9]}})";

}  // namespace

TEST(Lasso, ASelfIntersectingLassoIsRefusedWithItsLocation) {
    const Mesh mesh = grid(10);
    // A bow tie about the middle (5, 5), which is vertex 60.
    expect_error(
        R"({"lasso": {"points": [[2, 2, 0], [8, 8, 0], [8, 2, 0], [2, 8, 0]], "seed": [7.6, 5.2, 0], "metric": "segment"}})",
        mesh, "/lasso", "cross at vertex 60 (5 5 0)");
    expect_error(
        R"({"lasso": {"points": [[2, 2, 0], [8, 8, 0], [8, 2, 0], [2, 8, 0]], "seed": [7.6, 5.2, 0], "metric": "segment"}})",
        mesh, "/lasso", "the legs from point 0 (vertex 24) and from point 2 (vertex 30)");
    // The same picks in their order around the square do not.
    EXPECT_DOUBLE_EQ(
        area_of(R"({"lasso": {"points": [[2, 2, 0], [8, 2, 0], [8, 8, 0], [2, 8, 0]], "seed": [5.2, 5.1, 0]}})", mesh), 36);
    // Segments that coincide near a pick do not cross: a spike from (8, 5) to (9, 5) and back.
    EXPECT_DOUBLE_EQ(
        area_of(R"({"lasso": {"points": [[2, 2, 0], [8, 2, 0], [8, 5, 0], [9, 5, 0], [8, 8, 0], [2, 8, 0]], "seed": [5.2, 5.1, 0],
                              "metric": "segment"}})",
                mesh) >= 36,
        true);
    const Mesh sphere = spheres(4);
    expect_error(
        R"({"lasso": {"points": [[1, -0.3, 0.3], [1, 0.3, -0.3], [1, 0.3, 0.3], [1, -0.3, -0.3]], "seed": [1, 0.2, 0.01]}})",
        sphere, "/lasso", "crosses itself");
}

TEST(Lasso, ASeedOnTheOutlineIsRefused) {
    const Mesh mesh = grid(10);
    const std::string square = R"({"lasso": {"points": [[2, 2, 0], [8, 2, 0], [8, 8, 0], [2, 8, 0]], "seed": )";
    expect_error(square + "[8, 4.5, 0]}}", mesh, "/lasso", "the seed lies on the outline, between vertices");
    expect_error(square + "[8, 4.5, 3]}}", mesh, "/lasso", "on the outline");
    EXPECT_DOUBLE_EQ(area_of(square + "[7.999, 4.5, 0]}}", mesh), 36);
    EXPECT_DOUBLE_EQ(area_of(square + "[8.001, 4.5, 0]}}", mesh), 64);
    const Mesh far = [] {
        TriangleSoup soup = to_soup(grid(10, 1e-6));
        for (auto& p : soup.points) p[0] += 1;
        return build_mesh(soup);
    }();
    EXPECT_EQ(faces_of(R"({"lasso": {"points": [24, 30, 96, 90], "seed": 100}})", far),
              faces_of(R"({"lasso": {"points": [24, 30, 96, 90], "seed": 100}})", mesh));
}

TEST(Lasso, OnAScan) {
    OSTRAKA_SCAN(mesh, "lion-head.off");
    const double half = surface_area(mesh) / 2;
    const std::string lasso =
        R"({"lasso": {"points": [{"camera": "c", "pixel": [500, 350]}, {"camera": "c", "pixel": [700, 350]}, {"camera": "c", "pixel": [700, 500]},
            {"camera": "c", "pixel": [500, 500]}], "seed": {"camera": "c", "pixel": [600, 425]}}})";
    const std::string drawn = R"({"polygon": {"camera": "c", "points": [[500, 350], [700, 350], [700, 500], [500, 500]]}})";
    for (const char* view : {"0,0", "0,90", "90,0"}) {
        const std::string head = R"("cameras": {"c": {"view": ")" + std::string(view) + R"("}}, )";
        const double through_picks = measure_region(mesh, faces_of(lasso, mesh, head)).area,
                     by_drawing = measure_region(mesh, faces_of(drawn, mesh, head)).area;
        EXPECT_LT(through_picks, half) << view;
        EXPECT_GT(through_picks, by_drawing / 2) << view;
    }
}

TEST(Edit, EveryActionOnEveryType) {
    const Mesh mesh = grid(4);
    const AnnotationSet set = follow(R"(
        {"action": "add to", "id": 1, "select": {"box": {"min": [2, 0, 0], "max": [3, 4, 0]}}},
        {"action": "remove from", "id": 1, "select": {"box": {"min": [0, 0, 0], "max": [1, 4, 0]}}},
        {"action": "remove from", "id": 2, "select": {"path": {"points": [2, 12]}}},
        {"action": "add to", "id": 2, "select": {"vertices": [20, 21]}},
        {"action": "add to", "id": 3, "select": {"vertices": [9, 24]}},
        {"action": "remove from", "id": 3, "type": "point", "select": {"vertices": [3]}},
        {"action": "retag", "id": 3, "tag": "dots", "colour": [1, 2, 3]},
        {"id": 4, "tag": "rest", "type": "region", "select": {"invert": {"annotation": 1}}})",
                                     mesh, "", start_with(tile_steps, mesh));
    ASSERT_EQ(set.annotations.size(), 4U);
    EXPECT_EQ(set.find(1)->faces, faces_of(R"({"box": {"min": [1, 0, 0], "max": [3, 4, 0]}})", mesh));
    EXPECT_DOUBLE_EQ(*set.find(1)->attributes[0].measure()->value, 2) << "the width is taken anew at the new outermost vertices";
    EXPECT_DOUBLE_EQ(set.find(1)->attributes[1].descriptor()->values.at(0), 8);
    EXPECT_EQ(set.find(2)->polylines, (std::vector<std::vector<Index>>{{12, 11, 10, 5, 0, 1, 2}, {20, 21}}));
    EXPECT_EQ(set.find(3)->points, (std::vector<Index>{7, 9, 24}));
    EXPECT_EQ(set.find(3)->tag, "dots");
    EXPECT_EQ(set.find(3)->colour, (std::array<int, 3>{1, 2, 3}));
    EXPECT_EQ(set.find(4)->faces.size(), 16U);

    const AnnotationSet again = follow(R"(
        {"action": "replace", "id": 1, "select": {"faces": [0]}, "tag": "corner",
         "attributes": [{"id": 1, "name": "material", "type": "semantic", "note": "clay"}]},
        {"action": "replace", "id": 3, "select": {"nearest": [4, 4, 0]}},
        {"action": "delete", "id": 2})",
                                       mesh, "", start_with(tile_steps, mesh));
    ASSERT_EQ(again.annotations.size(), 2U);
    EXPECT_EQ(again.find(1)->faces, std::vector<Index>{0});
    EXPECT_EQ(again.find(1)->attributes.at(1).note()->text, "clay") << "an attribute of the same id takes the old one's place";
    EXPECT_EQ(again.find(3)->points, std::vector<Index>{24});
}

TEST(Edit, OtherAnnotationsAreUnchanged) {
    // A descriptor written by an operation on collections cannot be recomputed here: other parts can still be selected.
    const Mesh mesh = grid(4);
    RecipeStart start = start_with(tile_steps, mesh);
    Attribute height;
    height.id = 9;
    height.name = "height";
    height.value = Descriptor();
    height.descriptor()->values = {7};
    height.descriptor()->stale = true;
    start.annotations.annotations[0].attributes.push_back(height);
    const AnnotationSet set =
        follow(R"({"id": 4, "tag": "spot", "type": "point", "select": {"vertices": [0]}})", mesh, "", std::move(start));
    ASSERT_EQ(set.annotations.size(), 4U);
    ASSERT_EQ(set.find(1)->attributes.size(), 3U);
    EXPECT_EQ(set.find(1)->attributes[2].descriptor()->values, std::vector<double>{7});
    EXPECT_TRUE(set.find(1)->attributes[2].descriptor()->stale);
}

TEST(Edit, AddingAndRemovingUndoEachOther) {
    OSTRAKA_SCAN(mesh, "mannequin-devil.off");
    const std::string left = R"({"frame": "box", "box": {"min": [0, 0, 0], "max": [0.4, 1, 1]}})",
                      right = R"({"invert": )" + left + "}";
    const std::string initial = R"({"id": 1, "tag": "a", "type": "region", "select": )" + left + "}";
    const auto edited = [&](const std::string& action, const std::string& selection, RecipeStart start) {
        return follow(R"({"action": ")" + action + R"(", "id": 1, "select": )" + selection + "}", mesh, "", std::move(start));
    };
    AnnotationSet all = edited("add to", right, start_with(initial, mesh));
    EXPECT_EQ(all.find(1)->faces.size(), mesh.number_of_faces());
    RecipeStart from;
    from.annotations = std::move(all);
    EXPECT_EQ(edited("remove from", right, std::move(from)).find(1)->faces, follow(initial, mesh).find(1)->faces);
}

TEST(Edit, ErrorsNameTheStep) {
    const Mesh mesh = grid(4);
    const auto refuse = [&](const std::string& step, const std::string& pointer, const std::string& expected) {
        expect_refused(step, mesh, pointer, expected, start_with(tile_steps, mesh));
    };
    refuse(R"({"action": "delete", "id": 9})", "/annotations/0/id", "no annotation has the id 9");
    refuse(R"({"action": "add to", "id": 1})", "/annotations/0", "without \"select\"");
    refuse(R"({"action": "delete", "id": 1, "select": {"all": true}})", "/annotations/0/select", "selects nothing");
    refuse(R"({"action": "delete", "id": 1, "tag": "x"})", "/annotations/0/tag", "keeps nothing");
    refuse(R"({"action": "retag", "id": 1})", "/annotations/0", "changes nothing");
    refuse(R"({"action": "remove from", "id": 1, "select": {"all": true}})", "/annotations/0/select", "leaves nothing");
    refuse(R"({"action": "remove from", "id": 2, "select": {"annotation": 2}})", "/annotations/0/select", "leaves nothing");
    refuse(R"({"action": "add to", "id": 1, "type": "line", "select": {"vertices": [0, 1]}})", "/annotations/0/type",
           "is a region");
    refuse(R"({"id": 1, "tag": "x", "type": "region", "select": {"all": true}})", "/annotations/0/id", "is taken");
    refuse(R"({"id": 8, "type": "region", "select": {"all": true}})", "/annotations/0", "without \"tag\"");
    refuse(R"({"action": "delete", "id": 1}, {"action": "add to", "id": 1, "select": {"all": true}})", "/annotations/1/id",
           "no annotation");
}
