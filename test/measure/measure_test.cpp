#include "ostraka/measure/measure.h"

#include "annotation/example_meshes.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "ostraka/measure/examine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

using namespace ostraka;
using namespace ostraka::example;

namespace {

Annotation whole_annotation(const Mesh& mesh) {
    AnnotationSet set;
    return ensure_root(set, mesh);
}

Measure measure(const std::string& tool, const std::vector<Index>& points, std::optional<std::array<double, 3>> direction = {}) {
    Measure result;
    result.tool = tool;
    result.points = points;
    result.direction = direction;
    return result;
}

bool mentions(const std::vector<Finding>& findings, bool defect, const std::string& text) {
    return std::any_of(findings.begin(), findings.end(),
                       [&](const Finding& f) { return f.defect == defect && f.text.find(text) != std::string::npos; });
}

}  // namespace

TEST(Measure, ToolsOnAFlatSquare) {
    const Mesh mesh = grid(4, 2);
    const Annotation root = whole_annotation(mesh);
    EXPECT_DOUBLE_EQ(evaluate(mesh, root, measure("ruler", {0, 24})), 8 * std::numbers::sqrt2);
    EXPECT_DOUBLE_EQ(evaluate(mesh, root, measure("ruler", {0, 4, 24})), 16);
    EXPECT_DOUBLE_EQ(evaluate(mesh, root, measure("tape", {0, 24})), 8 * std::numbers::sqrt2);  // along the diagonals
    EXPECT_DOUBLE_EQ(evaluate(mesh, root, measure("tape", {4, 20})), 16);                       // and across them
    EXPECT_DOUBLE_EQ(evaluate(mesh, root, measure("tape", {4, 4})), 0);
    EXPECT_DOUBLE_EQ(evaluate(mesh, root, measure("bounding", {24, 0}, std::array<double, 3>{0, 3, 0})), 8);
    EXPECT_DOUBLE_EQ(evaluate(mesh, root, measure("bounding", {0, 24}, std::array<double, 3>{0, 0, 1})), 0);
}

TEST(Measure, IsInvariantToScaleAndPosition) {
    for (const double scale : {1e-9, 1.0, 1e9}) {
        const Mesh mesh = grid(3, scale);
        EXPECT_NEAR(evaluate(mesh, whole_annotation(mesh), measure("tape", {3, 12})) / scale, 6, 1e-12);
    }
    const Mesh centred = spheres(2), distant = spheres(2, {{1e7, 1e7, 1e7}});
    for (const char* tool : {"ruler", "tape"})
        EXPECT_NEAR(evaluate(centred, whole_annotation(centred), measure(tool, {0, 1})),
                    evaluate(distant, whole_annotation(distant), measure(tool, {0, 1})), 1e-6);
    EXPECT_NEAR(*evaluate(centred, whole_annotation(centred), "volume"), *evaluate(distant, whole_annotation(distant), "volume"),
                1e-6);
}

TEST(Measure, DirectionsOfAnyLengthAreTheSameDirection) {
    const Mesh mesh = spheres(3);
    const Annotation root = whole_annotation(mesh);
    const std::array<double, 3> direction_vector{1, 2, -3};
    const auto ends = extremes(mesh, root, direction_vector);
    const double value = evaluate(mesh, root, measure("bounding", {ends[0], ends[1]}, direction_vector));
    for (const double length : {5e307, 1e200, 1e-200, 1e-307}) {
        const std::array<double, 3> direction{length, 2 * length, -3 * length};
        EXPECT_EQ(extremes(mesh, root, direction), ends) << length;
        EXPECT_NEAR(evaluate(mesh, root, measure("bounding", {ends[0], ends[1]}, direction)), value, 1e-12) << length;
        AnnotationSet set;
        ensure_root(set, mesh).attributes.push_back({});
        set.annotations[0].attributes[0].name = "height";
        set.annotations[0].attributes[0].value = measure("bounding", {ends[0], ends[1]}, direction);
        set.up = direction;
        EXPECT_NO_THROW(check_annotations({mesh, set}, "set")) << length;
    }
}

TEST(Measure, PinsInsideFaces) {
    const Mesh mesh = grid(2);
    const Annotation root = whole_annotation(mesh);
    Measure tape = measure("tape", {0, 1});
    tape.locations = {face_point(0, {0.5, 0.25, 0.25}), face_point(0, {0.25, 0.5, 0.25})};
    Measure ruler = tape;
    ruler.tool = "ruler";
    EXPECT_DOUBLE_EQ(evaluate(mesh, root, tape), evaluate(mesh, root, ruler)) << "in one face the way is straight";
    tape.locations[1] = face_point(7, {0.25, 0.5, 0.25});
    ruler.locations = tape.locations;
    EXPECT_GE(evaluate(mesh, root, tape), evaluate(mesh, root, ruler));
    EXPECT_LE(evaluate(mesh, root, tape), 1.2 * evaluate(mesh, root, ruler));
    // A location at a corner is that vertex.
    tape.locations = {face_point(0, {1, 0, 0}), face_point(7, {0, 1, 0})};
    const Index a = corners(mesh, Face(0))[0], b = corners(mesh, Face(7))[1];
    EXPECT_DOUBLE_EQ(evaluate(mesh, root, tape), evaluate(mesh, root, measure("tape", {a, b})));
}

TEST(Measure, DescriptorsOfASphere) {
    const Mesh mesh = spheres(5, {{0, 0, 0}}, 2);
    const Annotation root = whole_annotation(mesh);
    EXPECT_NEAR(*evaluate(mesh, root, "area"), 16 * std::numbers::pi, 0.01 * 16 * std::numbers::pi);
    EXPECT_NEAR(*evaluate(mesh, root, "volume"), 32 * std::numbers::pi / 3, 0.01 * 32 * std::numbers::pi / 3);
    EXPECT_EQ(*evaluate(mesh, root, "perimeter"), 0);
    EXPECT_FALSE(evaluate(mesh, root, "length"));
    EXPECT_FALSE(evaluate(mesh, root, "roundness"));
    EXPECT_EQ(*evaluate(grid(1), whole_annotation(grid(1)), "volume"), 0)
        << "closed by its outline, a flat mesh encloses nothing";
    const Mesh square = grid(4);
    EXPECT_DOUBLE_EQ(*evaluate(square, whole_annotation(square), "circularity"), 16);
    EXPECT_EQ(descriptor_unit("area", "mm"), "mm^2");
    EXPECT_EQ(descriptor_unit("circularity", "mm"), "");
    EXPECT_EQ(extremes(mesh, root, {0, 0, 1}), (std::array<Index, 2>{5, 4}));
}

TEST(Measure, ErrorsNameTheAnnotation) {
    const Mesh mesh = spheres(0, {{0, 0, 0}, {5, 0, 0}});
    Annotation annotation = whole_annotation(mesh);
    annotation.tag = "pair";
    const auto fails = [&](const Measure& m) {
        try {
            evaluate(mesh, annotation, m);
        } catch (const Error& error) {
            return std::string(error.what()).find("pair") != std::string::npos;
        }
        return false;
    };
    EXPECT_TRUE(fails(measure("tape", {0, 6})));
    EXPECT_TRUE(fails(measure("ruler", {0, 99})));
    EXPECT_TRUE(fails(measure("ruler", {0})));
    EXPECT_TRUE(fails(measure("bounding", {0, 1})));
    EXPECT_TRUE(fails(measure("bounding", {0, 1}, std::array<double, 3>{0, 0, 0})));
    EXPECT_TRUE(fails(measure("laser", {0, 1})));
    Measure invalid = measure("ruler", {0, 1});
    invalid.locations = {face_point(0, {1, 0, 0}), face_point(99, {1, 0, 0})};
    EXPECT_TRUE(fails(invalid));
    annotation.faces.clear();
    EXPECT_THROW((void)extremes(mesh, annotation, {0, 0, 1}), Error);
}

TEST(Measure, RefreshMarksValuesThatCannotBeComputed) {
    const Mesh mesh = spheres(0, {{0, 0, 0}, {5, 0, 0}});
    AnnotationSet set;
    Annotation& root = ensure_root(set, mesh);
    Descriptor stale_value;
    stale_value.stale = true;
    root.attributes = {{0, "span", measure("ruler", {0, 1})},
                       {1, "way", measure("tape", {0, 6})},
                       {2, "area", stale_value},
                       {3, "bumpiness", stale_value}};
    root.attributes[0].measure()->stale = true;
    const RefreshResult result = refresh_measures(mesh, set);
    EXPECT_EQ(result.computed, 2U);
    EXPECT_EQ(result.stale, 2U);
    EXPECT_EQ(result.notes.size(), 2U);
    EXPECT_DOUBLE_EQ(root.attributes[0].measure()->value.value(), 2);
    EXPECT_FALSE(root.attributes[0].measure()->stale);
    EXPECT_TRUE(root.attributes[1].measure()->stale);
    EXPECT_FALSE(root.attributes[2].descriptor()->stale);
    EXPECT_TRUE(root.attributes[3].descriptor()->stale);
}

TEST(Examine, DefectsAndRemarks) {
    const Mesh mesh = grid(4);
    AnnotationSet set;
    set.annotations.resize(5);
    for (int i = 0; i < 5; ++i) set.annotations[i].id = i, set.annotations[i].tag = i < 2 ? "same" : "tag " + std::to_string(i);
    set.annotations[0].faces = {0, 1, 10, 11};  // two cells that touch at a vertex
    set.annotations[2].type = AnnotationType::point;
    set.annotations[2].points = {3, 3};
    set.annotations[3].type = AnnotationType::line;
    set.annotations[3].polylines = {{0, 1, 0}};
    set.annotations[4].type = AnnotationType::line;
    set.annotations[4].tag = "";
    Attribute& attribute = set.annotations[0].attributes.emplace_back();
    attribute.name = "width";
    attribute.value = measure("ruler", {0, 1});
    attribute.measure()->value = 1.5;
    std::vector<Finding> findings = examine({mesh, set});
    EXPECT_TRUE(mentions(findings, false, "2 separate patches"));
    EXPECT_TRUE(mentions(findings, false, "touch"));
    EXPECT_TRUE(mentions(findings, false, "'same' is used 2 times"));
    EXPECT_TRUE(mentions(findings, true, "no faces"));
    EXPECT_TRUE(mentions(findings, true, "repeated"));
    EXPECT_TRUE(mentions(findings, true, "twice"));
    EXPECT_TRUE(mentions(findings, true, "no poly-lines"));
    EXPECT_TRUE(mentions(findings, true, "tag is empty"));
    EXPECT_TRUE(mentions(findings, true, "is 1.5 but measures 1"));
    attribute.measure()->stale = true;
    EXPECT_TRUE(mentions(examine({mesh, set}), true, "stale"));
    attribute.measure()->stale = false;
    attribute.measure()->value.reset();
    EXPECT_TRUE(mentions(examine({mesh, set}), false, "has no value"));
    EXPECT_TRUE(examine({mesh, AnnotationSet()}).empty());
}

TEST(Examine, Summaries) {
    const Mesh mesh = grid(4);
    Annotation region;
    region.faces = {0, 1, 10, 11};
    const AnnotationSummary summary = summarise(mesh, region);
    EXPECT_EQ(summary.elements, 4U);
    EXPECT_EQ(summary.patches, 2U);
    EXPECT_EQ(summary.outlines, 2U);
    EXPECT_DOUBLE_EQ(summary.area, 2);
    EXPECT_DOUBLE_EQ(summary.length, 8);
    Annotation line;
    line.type = AnnotationType::line;
    line.polylines = {{0, 1, 2}, {5, 6}};
    EXPECT_EQ(summarise(mesh, line).elements, 3U);
    EXPECT_DOUBLE_EQ(summarise(mesh, line).length, 3);
    Annotation points;
    points.type = AnnotationType::point;
    points.points = {1, 2};
    EXPECT_EQ(summarise(mesh, points).elements, 2U);
}
