// Comments of IIIF Presentation manifests with points and well-known text.
#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/files/json.h"
#include "ostraka/interchange/interchange.h"
#include "ostraka/interchange/web_annotation.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"

#include <gtest/gtest.h>

#include <fmt/core.h>

namespace ostraka {
namespace {

Mesh cube() { return build_mesh(test::box(8)); }

std::string comment(const std::string& target, const std::string& body = R"({"type": "TextualBody", "value": "a chip"})") {
    return fmt::format(R"({{"id": "https://example.org/a", "type": "Annotation", "motivation": ["commenting"],
                           "body": {}, "target": {}}})",
                       body, target);
}
std::string resource(const std::string& selector) {
    return fmt::format(R"({{"type": "SpecificResource", "source": [{{"id": "https://example.org/scene", "type": "Scene"}}],
                           "selector": {}}})",
                       selector);
}
std::string page(const std::string& items) {
    return fmt::format(
        R"({{"@context": "http://iiif.io/api/presentation/4/context.json", "type": "AnnotationPage", "items": [{}]}})", items);
}
std::string manifest(const std::string& comments) {
    return fmt::format(
        R"({{"@context": "http://iiif.io/api/presentation/4/context.json", "id": "https://example.org/m", "type": "Manifest",
            "label": {{"en": ["Pot"]}},
            "items": [{{"id": "https://example.org/scene", "type": "Scene",
              "items": [{{"type": "AnnotationPage", "items": [{{"type": "Annotation", "motivation": ["painting"],
                "body": {{"id": "https://example.org/pot.glb", "type": "Model"}},
                "target": {{"type": "SpecificResource", "source": {{"id": "https://example.org/scene", "type": "Scene"}},
                            "selector": [{{"type": "PointSelector", "x": 90, "y": 0, "z": 0}}]}}}}]}}],
              "annotations": [{}]}}]}})",
        comments);
}

PlacedAnnotations read(const std::string& text) { return read_web_annotations(text, cube(), "file", {}); }
const std::string point = R"([{"type": "PointSelector", "x": 0.5, "y": 0.25, "z": 1}])";

TEST(IiifComments, PointsFlatAndNested) {
    const std::string nested = resource(point),
                      nested_source = fmt::format(R"({{"type": "SpecificResource", "source": {}}})", resource(point)),
                      object = resource(R"({"type": "PointSelector", "x": 0.5, "y": 0.25, "z": 1})");
    for (const std::string& text :
         {page(comment(nested)), page(comment(object)), page(comment(nested_source)), page(comment("[" + nested + "]")),
          manifest(page(comment(nested))), manifest(comment(nested)), comment(nested), "[" + comment(nested) + "]"}) {
        const PlacedAnnotations placed = read(text);
        ASSERT_EQ(placed.set.annotations.size(), 1U) << text;
        const Annotation& annotation = placed.set.annotations[0];
        EXPECT_EQ(annotation.tag, "a chip");
        EXPECT_EQ(annotation.type, AnnotationType::point);
        ASSERT_EQ(annotation.points.size(), 1U);
        const Mesh mesh = cube();
        EXPECT_EQ(mesh.point(Vertex(annotation.points[0])), Point(0.5, 0.25, 1));
    }
}

TEST(IiifComments, LabelsBecomeTags) {
    const std::string text = page(R"({"type": "Annotation", "motivation": "commenting", "label": {"en": ["rim"]},
        "body": [{"type": "TextualBody", "value": "worn", "language": "en"}], "target": )" +
                                  resource(point) + "}");
    const PlacedAnnotations placed = read(text);
    ASSERT_EQ(placed.set.annotations.size(), 1U);
    EXPECT_EQ(placed.set.annotations[0].tag, "rim");
    ASSERT_EQ(placed.set.annotations[0].attributes.size(), 1U);
    EXPECT_EQ(placed.set.annotations[0].attributes[0].note()->text, "worn");
}

TEST(IiifComments, WellKnownText) {
    const auto with = [](const std::string& wkt, const char* type = "WktSelector", const char* member = "value") {
        return read(page(comment(resource(fmt::format(R"([{{"type": "{}", "{}": "{}"}}])", type, member, wkt)))));
    };
    for (const char* wkt : {"POINT Z (0.5 0.5 1)", "POINTZ(0.5 0.5 1)", "point z(0.5 0.5 1)", "MULTIPOINT Z ((0.5 0.5 1))"})
        EXPECT_EQ(with(wkt).set.annotations.at(0).points.size(), 1U) << wkt;
    EXPECT_EQ(with("POINT Z (0.5 0.5 1)", "WKTSelector").set.annotations.at(0).points.size(), 1U);
    EXPECT_EQ(with("POINT Z (0.5 0.5 1)", "WktSelector", "wktLiteral").set.annotations.at(0).points.size(), 1U);
    const auto line = with("LINESTRING Z (0.25 0.25 1, 0.75 0.25 1, 0.75 0.75 1)");
    EXPECT_EQ(line.set.annotations.at(0).type, AnnotationType::line);
    EXPECT_EQ(line.set.annotations.at(0).polylines.at(0).size(), 9U);
    // Either direction, closed or not, and a comma that is missing.
    for (const char* wkt : {"POLYGON Z ((0.25 0.25 1, 0.75 0.25 1, 0.75 0.75 1, 0.25 0.75 1, 0.25 0.25 1))",
                            "POLYGONZ((0.25 0.75 1, 0.75 0.75 1, 0.75 0.25 1, 0.25 0.25 1))",
                            "POLYGON Z (0.25 0.25 1, 0.75 0.25 1 0.75 0.75 1, 0.25 0.75 1)",
                            "MULTIPOLYGON Z (((0.25 0.25 1, 0.75 0.25 1, 0.75 0.75 1, 0.25 0.75 1)))"}) {
        const auto area = with(wkt);
        ASSERT_EQ(area.set.annotations.size(), 1U) << wkt;
        EXPECT_EQ(area.set.annotations[0].type, AnnotationType::region);
        EXPECT_EQ(area.set.annotations[0].faces.size(), 32U) << wkt;
    }
    const auto ring = with(
        "POLYGON Z ((0.125 0.125 1, 0.875 0.125 1, 0.875 0.875 1, 0.125 0.875 1), "
        "(0.25 0.25 1, 0.75 0.25 1, 0.75 0.75 1, 0.25 0.75 1))");
    EXPECT_EQ(ring.set.annotations.at(0).faces.size(), 72U - 32U) << "with a hole";
    for (const char* wkt : {"", "POINT Z", "POINT Z (1 2 x)", "CIRCLE (0 0 1)", "POLYGON Z ((0 0 1, 1 0 1", "POINT Z (1)",
                            "POINT Z (0.5 0.5 1) more", "POLYGON Z (())"})
        EXPECT_THROW((void)with(wkt), Error) << wkt;
    EXPECT_THROW((void)with("POINT Z (50 0 0)"), Error) << "far from the surface";
}

TEST(IiifComments, ScenesInMetresAreRecognised) {
    // A mesh in mm with z up, shown in metres with y up: (x, y, z) -> (x, z, -y) / 1000.
    TriangleSoup soup = test::box(8);
    for (auto& p : soup.points) p = {80 * p[0], 100 * p[1], 300 * p[2]};
    const Mesh mesh = build_mesh(soup);
    const std::string text = page(comment(resource(R"([{"type": "PointSelector", "x": 0.08, "y": 0.15, "z": -0.05}])")) + "," +
                                  comment(resource(R"([{"type": "PointSelector", "x": 0.04, "y": 0.3, "z": -0.025}])")));
    const PlacedAnnotations placed = read_web_annotations(text, mesh, "file", {});
    ASSERT_EQ(placed.set.annotations.size(), 2U);
    EXPECT_EQ(mesh.point(Vertex(placed.set.annotations[0].points.at(0))), Point(80, 50, 150));
    EXPECT_EQ(mesh.point(Vertex(placed.set.annotations[1].points.at(0))), Point(40, 25, 300));
    ASSERT_FALSE(placed.set.notes.empty());
    EXPECT_NE(placed.set.notes[0].find("metres"), std::string::npos);
}

TEST(IiifComments, ManifestsWithoutCommentsAreRefused) {
    EXPECT_THROW((void)read(manifest(page(""))), Error);
    EXPECT_THROW((void)read(R"({"type": "Manifest"})"), Error);
    EXPECT_THROW((void)read(page(comment(resource(R"([{"type": "PointSelector", "x": "1", "y": 0, "z": 0}])")))), Error);
}

TEST(IiifComments, WhatPublishWritesIsReadBack) {
    const test::Scratch scratch;
    const std::string data = OSTRAKA_SOURCE_DIR "/data/", folder = (scratch / "web").string(),
                      out = (scratch / "in.ant.json").string();
    ASSERT_EQ(test::run_command("publish " + data + "teapot.ply " + data + "teapot.ant.json " + folder +
                                " --address https://pots.example/1")
                  .code,
              0);
    const auto result = test::run_command("annotation import --json " + data + "teapot.ply " + folder + "/manifest.json " + out);
    ASSERT_EQ(result.code, 0) << result.err;
    const Mesh mesh = read_mesh(data + "teapot.ply").mesh;
    const AnnotationSet before = read_annotations(data + "teapot.ant.json", mesh), after = read_annotations(out, mesh);
    EXPECT_EQ(after.annotations.size(), before.annotations.size());
    // Points of the original that publish comments on are found again.
    for (const Annotation& annotation : before.annotations) {
        if (annotation.type != AnnotationType::point || annotation.points.size() != 1) continue;
        const bool found = std::any_of(after.annotations.begin(), after.annotations.end(),
                                       [&](const Annotation& other) { return other.points == annotation.points; });
        EXPECT_TRUE(found) << annotation.tag;
    }
}

}  // namespace
}  // namespace ostraka
