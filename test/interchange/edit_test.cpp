// Edits: each step, its consequences, and refusals.
#include "ostraka/interchange/edit.h"
#include "mutate.h"
#include "ostraka/core/error.h"
#include "ostraka/interchange/difference.h"
#include "sets.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::example;

namespace {

/// A tile of 4 x 4 cells with a left column, a right column and a corner.
AnnotationSet tile_set(const Mesh& mesh) {
    AnnotationSet set;
    set.unit = "mm";
    for (const auto& [id, tag, column] : {std::tuple{1, "left", 0}, {2, "right", 3}}) {
        Annotation region;
        region.id = id;
        region.tag = tag;
        for (const Face f : mesh.faces())
            if (static_cast<int>(centroid(mesh, f).x()) == column) region.faces.push_back(f);
        Attribute area;
        area.id = 0;
        area.name = "area";
        area.value = Descriptor{{4}, false, "", "mm^2", false};
        region.attributes.push_back(area);
        region.attributes.push_back(semantic(1, "glaze", tag));
        set.annotations.push_back(region);
    }
    Attribute height;
    height.id = 5;
    height.name = "height";
    height.value = Measure{"ruler", {4, 24}, {}, {}, 4, "mm", false};
    set.annotations[1].attributes.push_back(height);
    Annotation corner;
    corner.id = 3;
    corner.tag = "corner";
    corner.type = AnnotationType::point;
    corner.points = {0};
    set.annotations.push_back(corner);
    return set;
}

std::vector<AnnotationEdit> edits(const std::string& list) {
    return edits_from_json(parse_json(R"({"format": "ostraka-annotation-edits", "edits": [)" + list + "]}", "edits"), "edits");
}

std::string message(const std::string& list) {
    const Mesh mesh = grid(4);
    AnnotationSet set = tile_set(mesh);
    try {
        edit_annotations(mesh, set, edits(list), "edits");
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        return error.what();
    }
    return {};
}

}  // namespace

TEST(Edit, FieldsAndAttributes) {
    const Mesh mesh = grid(4);
    AnnotationSet set = tile_set(mesh);
    const auto notes = edit_annotations(mesh, set, edits(R"(
      {"annotation": "left", "tag": "west", "colour": [1, 2, 3], "id": 10, "note": "seen", "removeAttributes": ["glaze"],
       "attributes": [{"id": 7, "name": "age", "type": "semantic", "note": "old"}]},
      {"annotation": 10, "attributes": [{"id": 7, "name": "age", "type": "semantic", "note": "very old"}]})"),
                                        "edits");
    const Annotation* west = set.find(10);
    ASSERT_NE(west, nullptr);
    EXPECT_EQ(west->tag, "west");
    EXPECT_EQ(west->colour, (std::array<int, 3>{1, 2, 3}));
    EXPECT_EQ(west->note, "seen");
    ASSERT_EQ(west->attributes.size(), 2U);
    EXPECT_EQ(west->attributes[1].note()->text, "very old");
    EXPECT_EQ(notes.size(), 1U) << "a new id is said";
}

TEST(Edit, MergeAndSplitAreInverse) {
    const Mesh mesh = grid(4);
    const AnnotationSet before = tile_set(mesh);
    AnnotationSet set = copy_of(before);
    edit_annotations(mesh, set, edits(R"({"annotation": "left", "merge": ["right"], "tag": "sides"})"), "edits");
    ASSERT_EQ(set.annotations.size(), 2U);
    const Annotation& sides = set.annotations[0];
    EXPECT_EQ(sides.faces.size(), 16U);
    EXPECT_EQ(sides.attributes[0].descriptor()->values, std::vector<double>{8}) << "the area was measured again";
    EXPECT_EQ(sides.attributes.size(), 3U) << "the height came along";
    edit_annotations(mesh, set, edits(R"({"annotation": "sides", "split": true})"), "edits");
    ASSERT_EQ(set.annotations.size(), 3U);
    EXPECT_EQ(set.annotations[0].id, 1);
    EXPECT_EQ(set.annotations[0].faces, before.annotations[0].faces);
    EXPECT_EQ(set.annotations[1].faces, before.annotations[1].faces);
    EXPECT_EQ(set.annotations[0].attributes[0].descriptor()->values, std::vector<double>{4});
    EXPECT_EQ(set.annotations[0].attributes.size(), 2U) << "the measure went where its pins are";
    EXPECT_EQ(set.annotations[1].attributes.size(), 3U);
}

TEST(Edit, TextsFindTheirAttributeByName) {
    const Mesh mesh = grid(4);
    AnnotationSet set = tile_set(mesh);
    edit_annotations(mesh, set, edits(R"({"annotation": "left", "merge": ["right"], "texts": {"glaze": "none", "age": "old"}})"),
                     "edits");
    const Annotation& left = set.annotations[0];
    ASSERT_EQ(left.attributes.size(), 4U) << "area, glaze, the height that came along, age";
    EXPECT_EQ(left.attributes[1].note()->text, "none");
    EXPECT_EQ(left.attributes[3].name, "age");
    EXPECT_EQ(left.attributes[3].note()->text, "old");
}

TEST(Edit, DuplicateAndRemove) {
    const Mesh mesh = grid(4);
    AnnotationSet set = tile_set(mesh);
    edit_annotations(mesh, set, edits(R"({"annotation": 2, "duplicate": true}, {"annotation": 1, "remove": true})"), "edits");
    ASSERT_EQ(set.annotations.size(), 3U);
    EXPECT_EQ(set.annotations[0].id, 2);
    EXPECT_EQ(set.annotations[1].id, 4);
    EXPECT_EQ(set.annotations[1].faces, set.annotations[0].faces);
    EXPECT_TRUE(differences(set, copy_of(set)).empty());
    // Other changes apply to the copy.
    const AnnotationSet before = copy_of(set);
    const auto notes = edit_annotations(
        mesh, set, edits(R"({"annotation": 2, "duplicate": true, "id": 9, "tag": "twin", "colour": [1, 2, 3]})"), "edits");
    EXPECT_TRUE(notes.empty()) << "no annotation lost its id";
    ASSERT_EQ(set.annotations.size(), 4U);
    EXPECT_EQ(set.annotations[0].tag, before.annotations[0].tag);
    EXPECT_EQ(set.annotations[0].colour, before.annotations[0].colour);
    EXPECT_EQ(set.annotations[1].id, 9);
    EXPECT_EQ(set.annotations[1].tag, "twin");
    EXPECT_EQ(set.annotations[1].faces, set.annotations[0].faces);
}

TEST(Edit, Refusals) {
    EXPECT_NE(message(R"({"annotation": 9})").find("no annotation 9"), std::string::npos);
    EXPECT_NE(message(R"({"annotation": 1, "tag": "right"}, {"annotation": "right"})").find("2 annotations"), std::string::npos);
    EXPECT_NE(message(R"({"annotation": 1, "id": 2})").find("in use"), std::string::npos);
    EXPECT_NE(message(R"({"annotation": 1, "merge": [3]})").find("a point cannot be merged into a region"), std::string::npos);
    EXPECT_NE(message(R"({"annotation": 1, "merge": [1]})").find("itself"), std::string::npos);
    EXPECT_NE(message(R"({"annotation": 1}, {"annotation": 1, "removeAttributes": ["none"]})").find("edit 2"), std::string::npos);
    EXPECT_NE(message(R"({"annotation": 1, "unknown": 1})").find("annotation-edits.schema.json"), std::string::npos);
    EXPECT_NE(message(R"({"annotation": 1, "attributes": [{"id": 3, "name": "m", "type": "measure",
                          "measure": {"tool": "ruler", "points": [0, 99]}}]})")
                  .find("vertex 99"),
              std::string::npos);
    EXPECT_EQ(message(R"({"annotation": 3, "split": true})"), "") << "one piece stays as it is";
}

TEST(Edit, DamagedListsAreRefusedWithAMessage) {
    const Mesh mesh = grid(4);
    const std::string list = R"({"format": "ostraka-annotation-edits", "version": 1, "edits": [
      {"annotation": "left", "merge": ["right"], "tag": "sides", "colour": [1, 2, 3], "id": 10, "removeAttributes": [1],
       "attributes": [{"id": 7, "name": "age", "type": "semantic", "note": "old"},
                      {"id": 8, "name": "m", "type": "measure", "measure": {"tool": "bounding", "points": [0, 9], "direction": [0, 1, 0]}}]},
      {"annotation": 10, "split": true, "duplicate": true}, {"annotation": "corner", "remove": true}]})";
    std::size_t successes = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        AnnotationSet set = tile_set(mesh);
        try {
            edit_annotations(mesh, set, edits_from_json(parse_json(test::mutate(list, seed), "e"), "e"), "e");
            EXPECT_NO_THROW(check_annotations({mesh, set}, "edited"));
            ++successes;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
        }
    }
    EXPECT_LT(successes, 200U);
}

TEST(RenameUnit, UnitsOfLengthsFollowAndNoNumberChanges) {
    const Mesh mesh = grid(4);
    AnnotationSet set = tile_set(mesh);
    for (const auto& [name, unit] : {std::pair{"bend", "1/mm"}, {"weight", "g"}, {"mmix", "mmol"}}) {
        Attribute attribute;
        attribute.id = 10 + static_cast<int>(set.annotations[1].attributes.size());
        attribute.name = name;
        attribute.value = Descriptor{{2}, false, "", unit, false};
        set.annotations[1].attributes.push_back(attribute);
    }
    const auto units = [&] {
        std::vector<std::string> result;
        for (const Attribute& attribute : set.annotations[1].attributes)
            if (attribute.measure() != nullptr) result.push_back(attribute.measure()->unit);
            else if (attribute.descriptor() != nullptr) result.push_back(attribute.descriptor()->unit);
        return result;
    };
    change_length_unit(mesh, set, "cm");
    EXPECT_EQ(set.unit, "cm");
    EXPECT_EQ(units(), (std::vector<std::string>{"cm^2", "cm", "1/cm", "g", "mmol"}));
    EXPECT_EQ(*set.annotations[1].attributes[2].measure()->value, 4);
    EXPECT_EQ(set.annotations[1].attributes[0].descriptor()->values, std::vector<double>{4});
    // No unit, and back: values computed from the coordinates have a unit again.
    change_length_unit(mesh, set, "");
    EXPECT_EQ(units(), (std::vector<std::string>{"", "", "1/cm", "g", "mmol"}));
    change_length_unit(mesh, set, "m");
    EXPECT_EQ(units(), (std::vector<std::string>{"m^2", "m", "1/cm", "g", "mmol"}));
}
