#include "ostraka/collection/measure_definitions.h"

#include "meshes.h"
#include "scratch.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/collection/proportion_graph.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/measure.h"
#include "ostraka/measure/solid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ostraka {
namespace {

using test::Scratch;

std::string definitions_text(const std::string& entries) {
    return R"({"format": "ostraka-measures", "version": 1, "measures": [)" + entries + "]}";
}

MeasureDefinitions definitions(const std::string& entries) {
    return measure_definitions_from_text(definitions_text(entries), "m.json");
}

/// A ball of radius r whose poles are annotated, and its upper half as a region.
struct Ball : AnnotatedMesh {
    explicit Ball(double r) {
        TriangleSoup soup = test::octahedron_sphere(3);
        for (auto& p : soup.points)
            for (double& c : p) c *= r;
        mesh = build_mesh(soup);
        annotations.unit = "mm";
        annotations.up = {0, 0, 1};
        Annotation poles;
        poles.id = 0;
        poles.tag = "pole";
        poles.type = AnnotationType::point;
        Annotation cap;
        cap.id = 1;
        cap.tag = "cap";
        for (const Vertex v : mesh.vertices()) {
            if (std::abs(mesh.point(v).z() - r) < 1e-9 * r) poles.points.insert(poles.points.begin(), v.idx());
            if (std::abs(mesh.point(v).z() + r) < 1e-9 * r) poles.points.push_back(v.idx());
        }
        for (const Face f : mesh.faces())
            if (centroid(mesh, f).z() > 0) cap.faces.push_back(f.idx());
        Attribute height;
        height.name = "height";
        height.value = Descriptor();
        height.descriptor()->values = {r / 10};
        height.descriptor()->unit = "cm";
        cap.attributes.push_back(height);
        annotations.annotations = {poles, cap};
    }
};

const char* const all_kinds = R"(
    {"name": "between poles", "tool": "ruler", "from": "pole", "to": "pole 2"},
    {"name": "over the side", "tool": "tape", "from": "pole", "to": "pole 2", "geodesic": "exact"},
    {"name": "total height", "tool": "bounding", "direction": "up"},
    {"name": "cap height", "tool": "bounding", "annotation": "cap", "direction": [0, 0, 2]},
    {"name": "top to bottom", "tool": "ruler", "from": {"annotation": "cap", "extreme": [0, 0, 1]}, "to": "pole 2"},
    {"name": "stored", "annotation": "cap", "attribute": "height"},
    {"name": "area", "descriptor": "area"},
    {"name": "longest side", "annotation": "cap", "descriptor": "box sides", "entry": 1})";

TEST(MeasureDefinitions, ClayIsAVolumeOfTheWholeObject) {
    const Ball ball(10);
    const auto measures = take_measures(ball, definitions(R"({"name": "most", "clay": "max"}, {"name": "least", "clay": "min"},
                                                                         {"name": "height", "tool": "bounding", "direction": "up"})"));
    ASSERT_TRUE(measures.values[0].has_value());
    EXPECT_EQ(measures.powers[0], 3);
    EXPECT_NEAR(*measures.values[0], closed_volume(ball.mesh), 1e-4 * closed_volume(ball.mesh));
    EXPECT_FALSE(measures.values[1].has_value());  // no wall is detected
    ASSERT_EQ(measures.notes.size(), 1U);
    EXPECT_NE(measures.notes[0].find("no wall is found"), std::string::npos) << measures.notes[0];
    EXPECT_THROW((void)definitions(R"({"name": "a", "clay": "most"})"), Error);
    EXPECT_THROW((void)definitions(R"({"name": "a", "clay": "max", "annotation": "cap"})"), Error);
}

TEST(MeasureDefinitions, AreTakenOnABall) {
    for (const double r : {1.0, 1e-6, 1e6}) {
        const Ball ball(r);
        const ObjectMeasures measures = take_measures(ball, definitions(all_kinds));
        ASSERT_TRUE(measures.notes.empty()) << measures.notes.front();
        ASSERT_EQ(measures.values.size(), 8u);
        EXPECT_NEAR(*measures.values[0], 2 * r, 1e-12 * r);
        EXPECT_NEAR(*measures.values[1], std::numbers::pi * r, 0.03 * r);
        EXPECT_NEAR(*measures.values[2], 2 * r, 1e-12 * r);
        EXPECT_NEAR(*measures.values[3], r, 1e-12 * r);
        EXPECT_NEAR(*measures.values[4], 2 * r, 1e-12 * r);
        EXPECT_NEAR(*measures.values[5], r, 1e-12 * r) << "centimetres become millimetres";
        EXPECT_NEAR(*measures.values[6], surface_area(ball.mesh), 1e-12 * r * r);
        EXPECT_NEAR(*measures.values[7], 2 * r, 0.02 * r);
        EXPECT_EQ(measures.powers, (std::vector<int>{1, 1, 1, 1, 1, 1, 2, 1}));
        EXPECT_EQ(measures.unit, "mm");
    }
}

TEST(MeasureDefinitions, ImpossibleMeasuresAreMissingWithANote) {
    Ball ball(1);
    const ObjectMeasures measures = take_measures(ball, definitions(R"(
        {"name": "a", "tool": "ruler", "from": "pole", "to": "nose"},
        {"name": "b", "tool": "ruler", "from": "pole", "to": "cap"},
        {"name": "c", "tool": "ruler", "from": "pole", "to": "pole 3"},
        {"name": "d", "tool": "bounding", "annotation": "arm", "direction": [1, 0, 0]},
        {"name": "e", "annotation": "cap", "attribute": "weight"},
        {"name": "f", "annotation": "cap", "descriptor": "beauty"},
        {"name": "g", "annotation": "pole", "descriptor": "area"},
        {"name": "h", "annotation": "cap", "descriptor": "box sides", "entry": 4},
        {"name": "i", "tool": "ruler", "from": "pole", "to": "pole 2"})"));
    for (std::size_t i = 0; i < 8; ++i) EXPECT_FALSE(measures.values[i]) << i;
    EXPECT_TRUE(measures.values[8]);
    ASSERT_EQ(measures.notes.size(), 8u);
    EXPECT_EQ(measures.notes[0], "no 'a': nothing is called 'nose'");
    EXPECT_NE(measures.notes[1].find("not a point"), std::string::npos);
    ball.annotations.up.reset();
    EXPECT_FALSE(take_measures(ball, definitions(R"({"name": "h", "tool": "bounding", "direction": "up"})")).values[0]);
    ball.annotations.annotations.push_back(ball.annotations.annotations[1]);
    EXPECT_FALSE(take_measures(ball, definitions(R"({"name": "h", "annotation": "cap", "descriptor": "area"})")).values[0])
        << "two annotations of one name";
}

TEST(MeasureDefinitions, InvalidFilesAreRefused) {
    for (const std::string entries :
         {R"({"name": "a"})", R"({"name": "a", "tool": "ruler", "from": "x"})",
          R"({"name": "a", "tool": "scale", "from": "x", "to": "y"})",
          R"({"name": "a", "tool": "bounding", "from": "x", "to": "y", "direction": [0, 0, 1]})",
          R"({"name": "a", "tool": "bounding", "direction": [0, 0, 0]})", R"({"name": "a", "attribute": "x"})",
          R"({"name": "a", "descriptor": "area", "tool": "tape"})", R"({"name": "a", "descriptor": "area", "entry": 0})",
          R"({"name": "a", "descriptor": "area"}, {"name": "a", "descriptor": "volume"})", ""})
        EXPECT_THROW(definitions(entries), Error) << entries;
    EXPECT_THROW(measure_definitions_from_text("{", "m.json"), Error);
}

TEST(MeasureDefinitions, ObjectsOfLandmarksNeedNoMesh) {
    const Scratch scratch;
    (void)scratch.file(
        "a.mrk.json",
        R"({"@schema": "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/markups-schema-v1.0.3.json#",
        "markups": [{"type": "Fiducial", "coordinateSystem": "LPS", "coordinateUnits": "cm", "controlPoints": [
        {"label": "tip", "position": [0, 3, 4], "positionStatus": "defined"}, {"label": "root", "position": [0, 0, 0], "positionStatus": "defined"}]}]})");
    const Collection collection = read_collection(scratch.path());
    const ObjectMeasures measures = take_measures(
        collection.objects.at(0),
        definitions(
            R"({"name": "l", "tool": "ruler", "from": "tip", "to": "root"}, {"name": "n", "tool": "ruler", "from": "tip", "to": "none"})"));
    EXPECT_EQ(measures.values[0], 5);
    EXPECT_FALSE(measures.values[1]);
    EXPECT_EQ(measures.unit, "cm");
    EXPECT_THROW(take_measures(collection.objects.at(0), definitions(R"({"name": "a", "descriptor": "area"})")), Error)
        << "not one can be taken";
}

TEST(MeasureTable, FromObjectsWithDifferentKinds) {
    const MeasureDefinitions two =
        definitions(R"({"name": "a", "annotation": "x", "attribute": "a"}, {"name": "b", "descriptor": "area"})");
    ObjectMeasures first{"mm", {1, 2}, {1, 2}, {"", ""}, {}}, second{"cm", {3, std::nullopt}, {1, 2}, {"", ""}, {}},
        odd{"mm", {7, 8}, {0, 2}, {"kg", ""}, {}};
    std::vector<std::string> notes;
    const MeasureTable table = measure_table({"p", "q", "r", "s"}, {first, second, std::nullopt, odd}, two, notes);
    EXPECT_EQ(table.objects, (std::vector<std::string>{"p", "q", "s"}));
    EXPECT_EQ(table.units, (std::vector<std::string>{"mm", "cm", "mm"}));
    EXPECT_EQ(table.values(1, 0), 3);
    EXPECT_TRUE(std::isnan(table.values(1, 1)));
    EXPECT_TRUE(std::isnan(table.values(2, 0)));
    EXPECT_EQ(table.measures[1].power, 2);
    EXPECT_EQ(notes.size(), 1u);
    const ObjectMeasures reread = object_measures_from_json(object_measures_to_json(second));
    EXPECT_EQ(reread.values, second.values);
    EXPECT_EQ(reread.unit, "cm");
}

TEST(MeasureTable, ReportsEachNoteOfACollectionOnce) {
    const MeasureDefinitions definition = definitions(R"({"name": "a", "annotation": "x", "attribute": "a"})");
    Collection collection;
    std::vector<ObjectResult> results;
    for (const char* name : {"p", "q", "r"}) {
        collection.objects.emplace_back().name = name;
        results.push_back({object_measures_to_json({"mm", {1}, {1}, {""}, {"no attribute b"}}), {}, false});
    }
    results[1].problem = "broken";
    std::vector<std::string> notes;
    EXPECT_EQ(measure_table(collection, results, definition, notes, "here").objects, (std::vector<std::string>{"p", "r"}));
    EXPECT_EQ(notes, (std::vector<std::string>{"p and 1 more: no attribute b"}));
    for (ObjectResult& each : results) each.problem = "broken";
    EXPECT_THROW(measure_table(collection, results, definition, notes, "here"), Error);
}

TEST(MeasureTable, AsCsvReadsBack) {
    const Scratch scratch;
    const Path file = scratch.file(
        "t.csv", "name;unit;arm length;base [unit^2];weight [kg];angle [-]\n\"A;1\";mm;1.5;4;;0.1\nB;cm;-;9;2;0.2\n");
    const MeasureTable table = read_measure_table(file);
    EXPECT_EQ(table.objects, (std::vector<std::string>{"A;1", "B"}));
    EXPECT_EQ(table.units, (std::vector<std::string>{"mm", "cm"}));
    EXPECT_EQ(table.measures[1].power, 2);
    EXPECT_EQ(table.measures[2].power, 0);
    EXPECT_EQ(table.measures[2].unit, "kg");
    EXPECT_TRUE(std::isnan(table.values(0, 2)));
    EXPECT_TRUE(std::isnan(table.values(1, 0)));
    const MeasureTable reread = read_measure_table(scratch.file("u.csv", measure_table_to_csv(table)));
    EXPECT_EQ(measure_table_to_csv(reread), measure_table_to_csv(table));
    EXPECT_EQ(read_measure_table(scratch.file("v.csv", "name,h [cm],w [cm]\na,1,2\n")).units[0], "cm");
    for (const std::string bad : {"name,a\n", "name\nx\n", "name,a\nx,y\n", "name,a,a\nx,1,2\n", "name,a\nx,1\nx,2\n",
                                  "name,a\nx,1,2\n", "name,a [mm],b [cm]\nx,1,2\n", "name,a\nx,nan\n"})
        EXPECT_THROW(read_measure_table(scratch.file("w.csv", bad)), Error) << bad;
}

TEST(MeasureTable, ADecimalCommaIsReported) {
    const Scratch scratch;
    try {
        (void)read_measure_table(scratch.file("comma.csv", "name;a\nx;1,5\n"));
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("use a decimal point: 1.5"), std::string::npos) << error.what();
    }
}

/// A study result: the first measure is in fixed proportion to the second.
ProportionStudy fixed_ratio(double low, double high) {
    ProportionStudy study;
    RatioRow ratio;
    ratio.numerator = 0;
    ratio.denominator = 1;
    ratio.low = low;
    ratio.high = high;
    ratio.row.name = "first / second";
    ratio.fixedness = Fixedness::fixed;
    study.ratios.push_back(ratio);
    return study;
}

TEST(ProposedProportions, BecomeConstraintsOfTheTemplate) {
    Ball ball(1);
    Annotation belt = ball.annotations.annotations[1];
    belt.id = 2;
    belt.tag = "belt";
    belt.attributes.clear();
    belt.faces.resize(belt.faces.size() / 2);
    ball.annotations.annotations.push_back(belt);
    const MeasureDefinitions two_measures = definitions(R"(
        {"name": "cap width", "tool": "bounding", "annotation": "cap", "direction": [1, 0, 0]},
        {"name": "belt width", "tool": "bounding", "annotation": "belt", "direction": [1, 0, 0]})");
    const Proposals proposals = propose_proportions(ball, {}, two_measures, fixed_ratio(1.25, 2));
    ASSERT_EQ(proposals.proposed, 1u);
    const Relationship& r = proposals.graph.relationships.at(0);
    EXPECT_EQ(r.type, "proportion");
    EXPECT_EQ(r.annotations, (std::vector<int>{2, 1})) << "the smaller follows the larger";
    EXPECT_TRUE(r.is_constraint);
    const Json parameters = parse_json(r.constraint, "constraint");
    EXPECT_EQ(parameters["minValue"].GetDouble(), 0.5);
    EXPECT_EQ(parameters["maxValue"].GetDouble(), 0.8);
    EXPECT_STREQ(parameters["measure1"].GetString(), "belt width");
    EXPECT_STREQ(parameters["measure2"].GetString(), "cap width");
    // The measures now exist, with values, and a second proposal adds nothing.
    EXPECT_NEAR(*proposals.set.find(1)->attributes.back().measure()->value, 2, 1e-12);
    Relationship copy = r;
    RelationGraph relabelled;
    relabelled.relationships.push_back(copy);
    const Proposals second_proposals =
        propose_proportions({ball.mesh, proposals.set}, std::move(relabelled), two_measures, fixed_ratio(1.25, 2));
    EXPECT_EQ(second_proposals.proposed, 0u);
    EXPECT_EQ(second_proposals.graph.relationships.size(), 1u);
    EXPECT_EQ(second_proposals.notes.size(), 1u);
    EXPECT_EQ(second_proposals.set.find(1)->attributes.size(), proposals.set.find(1)->attributes.size());
}

TEST(ProposedProportions, ReportRejectedProposals) {
    const Ball ball(1);
    for (const std::string first :
         {R"({"name": "a", "descriptor": "area"})", R"({"name": "a", "tool": "bounding", "direction": "up"})",
          R"({"name": "a", "tool": "bounding", "annotation": "arm", "direction": "up"})",
          R"({"name": "a", "tool": "bounding", "annotation": "cap", "direction": "up"})",
          R"({"name": "a", "annotation": "cap", "attribute": "height"})",
          R"({"name": "a", "annotation": "cap", "tool": "ruler", "from": "pole", "to": "nose"})"}) {
        const Proposals proposals = propose_proportions(
            ball, {}, definitions(first + R"(, {"name": "b", "tool": "bounding", "annotation": "cap", "direction": [1, 0, 0]})"),
            fixed_ratio(1, 2));
        EXPECT_EQ(proposals.proposed, 0u) << first;
        EXPECT_EQ(proposals.notes.size(), 1u) << first;
        EXPECT_TRUE(proposals.graph.relationships.empty());
    }
}

}  // namespace
}  // namespace ostraka
