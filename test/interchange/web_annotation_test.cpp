// W3C Web Annotation: round trip by indices, by positions on other meshes, files of other tools, damage.
#include "ostraka/interchange/web_annotation.h"
#include "mutate.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/core/error.h"
#include "sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

using namespace ostraka;
using namespace ostraka::example;

namespace {

/// The same triangles with vertices and faces in another order.
Mesh shuffled(const Mesh& mesh) {
    TriangleSoup soup = to_soup(mesh), other;
    const auto n = static_cast<Index>(soup.points.size());
    std::vector<Index> place(n);
    for (Index i = 0; i < n; ++i) place[i] = (i * 7 + 3) % n;  // a permutation, as no mesh here has a multiple of 7 vertices
    other.points.resize(n);
    for (Index i = 0; i < n; ++i) other.points[place[i]] = soup.points[i];
    for (const auto& [a, b, c] : soup.triangles) other.triangles.push_back({place[b], place[c], place[a]});
    std::reverse(other.triangles.begin(), other.triangles.end());
    return build_mesh(other);
}

/// The positions of the corners of a region's faces, in an order that does not depend on indices.
std::vector<std::array<Point, 3>> triangles_of(const Mesh& mesh, const Annotation& annotation) {
    std::vector<std::array<Point, 3>> triangles;
    for (const Index f : annotation.faces) {
        const auto [a, b, c] = corners(mesh, Face(f));
        std::array<Point, 3> triangle{mesh.point(a), mesh.point(b), mesh.point(c)};
        std::sort(triangle.begin(), triangle.end());
        triangles.push_back(triangle);
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

double area_of(const Mesh& mesh, const Annotation& annotation) { return measure_region(mesh, annotation.faces).area; }

std::string message(const std::string& text, const Mesh& mesh, const PlaceOptions& options = {}) {
    try {
        read_web_annotations(text, mesh, "file", options);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

}  // namespace

TEST(WebAnnotation, RoundTripsByIndices) {
    const Mesh mesh = spheres(3);
    const AnnotationSet set = wild_set(mesh);
    const std::string text = web_annotations({mesh, set}, "m <1>.ply", {});
    const PlacedAnnotations read = read_web_annotations(text, mesh, "file");
    EXPECT_EQ(as_file(read.set, mesh), as_file(set, mesh));
    for (const PlacedAnnotation& placement : read.placements) EXPECT_EQ(placement.how, "indices");
    EXPECT_EQ(web_annotations({mesh, set}, "m <1>.ply", {}), text);
}

TEST(WebAnnotation, ConformsToTheModelAndIsSafeInAPage) {
    const Mesh mesh = spheres(3);
    const AnnotationSet set = wild_set(mesh);
    const std::string text = web_annotations({mesh, set}, "m <1>.ply", {});
    EXPECT_EQ(text.find_first_of("<>&"), std::string::npos);
    const Json document = parse_json(text, "text");
    EXPECT_STREQ(document["@context"][0].GetString(), "http://www.w3.org/ns/anno.jsonld");
    EXPECT_STREQ(document["type"].GetString(), "AnnotationCollection");
    EXPECT_EQ(document["total"].GetUint(), set.annotations.size());
    EXPECT_STREQ(document["first"]["type"].GetString(), "AnnotationPage");
    std::vector<std::string> ids{document["id"].GetString(), document["first"]["id"].GetString()};
    for (const auto& item : document["first"]["items"].GetArray()) {
        validate(item, "web-annotation", "item");
        ids.emplace_back(item["id"].GetString());
        EXPECT_STREQ(item["type"].GetString(), "Annotation");
        EXPECT_STREQ(item["target"]["source"]["id"].GetString(), "m%20%3C1%3E.ply");
        EXPECT_STREQ(item["body"][0]["purpose"].GetString(), "tagging");
    }
    std::sort(ids.begin(), ids.end());
    EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end()) << "identifiers differ";
    EXPECT_EQ(ids.front().substr(0, 9), "urn:uuid:");
}

TEST(WebAnnotation, TheSameShapeWithOtherIndicesGivesTheSameSelections) {
    // Two components and holes: outlines, whole components, the whole.
    const Mesh mesh = spheres(3, {{0, 0, 0}, {3, 0, 0}});
    AnnotationSet set = wild_set(mesh);
    Annotation ball;
    ball.id = 500;
    ball.tag = "whole ball and a cap of the other";
    for (const Face f : mesh.faces())
        if (const Point p = centroid(mesh, f); p.x() > 1.5 || p.z() > 0.7) ball.faces.push_back(f);
    Annotation ring;
    ring.id = 501;
    ring.tag = "ring";
    for (const Face f : mesh.faces())
        if (const Point p = centroid(mesh, f); std::abs(p.z()) < 0.4) ring.faces.push_back(f);
    set.annotations.push_back(ball);
    set.annotations.push_back(ring);
    const Mesh other = shuffled(mesh);
    const PlacedAnnotations read = read_web_annotations(web_annotations({mesh, set}, "m.ply", {}), other, "file");
    ASSERT_EQ(read.set.annotations.size(), set.annotations.size());
    for (std::size_t i = 0; i < set.annotations.size(); ++i) {
        const Annotation &before = set.annotations[i], &after = read.set.annotations[i];
        EXPECT_EQ(read.placements[i].to_vertex, 0);
        EXPECT_EQ(after.tag, before.tag);
        ASSERT_EQ(after.type, before.type);
        ASSERT_EQ(after.faces.size(), before.faces.size()) << before.tag;
        EXPECT_EQ(triangles_of(other, after), triangles_of(mesh, before)) << before.tag;
        for (std::size_t k = 0; k < before.points.size(); ++k)
            EXPECT_EQ(other.point(Vertex(after.points[k])), mesh.point(Vertex(before.points[k])));
        ASSERT_EQ(after.attributes.size(), before.attributes.size());
        for (std::size_t k = 0; k < before.attributes.size(); ++k)
            if (before.attributes[k].measure() != nullptr && before.attributes[k].measure()->locations.empty()) {
                EXPECT_EQ(other.point(Vertex(after.attributes[k].measure()->points[0])),
                          mesh.point(Vertex(before.attributes[k].measure()->points[0])));
                const auto &then = before.attributes[k].measure()->repeats, &now = after.attributes[k].measure()->repeats;
                ASSERT_EQ(now.size(), then.size());
                for (std::size_t n = 0; n < then.size(); ++n)
                    for (std::size_t j = 0; j < then[n].size(); ++j)
                        EXPECT_EQ(other.point(Vertex(now[n].at(j))), mesh.point(Vertex(then[n][j])));
            }
    }
}

TEST(WebAnnotation, AnotherResolutionKeepsPlacesAndAreas) {
    const Mesh mesh = spheres(5);
    AnnotationSet set;
    Annotation cap;
    cap.tag = "cap";
    for (const Face f : mesh.faces())
        if (centroid(mesh, f).z() > 0.5) cap.faces.push_back(f);
    set.annotations.push_back(cap);
    const std::string text = web_annotations({mesh, set}, "m.ply", {});
    const double original_area = area_of(mesh, cap);
    for (const int level : {4, 6}) {
        // Rotated, so that no vertex coincides with an old one.
        TriangleSoup soup = to_soup(spheres(level));
        for (auto& p : soup.points) p = {0.8 * p[0] - 0.6 * p[1], 0.6 * p[0] + 0.8 * p[1], p[2]};
        const Mesh other = build_mesh(soup);
        const PlacedAnnotations read = read_web_annotations(text, other, "file");
        EXPECT_EQ(read.placements[0].how, "places");
        EXPECT_GT(read.placements[0].to_vertex, 0);
        EXPECT_NEAR(area_of(other, read.set.annotations[0]), original_area, 0.05 * original_area) << level;
    }
}

TEST(WebAnnotation, AnnotationsOfOtherToolsAreRead) {
    const Mesh mesh = spheres(2);
    const std::string foreign =
        R"({"@context": "http://www.w3.org/ns/anno.jsonld", "id": "http://example.org/anno1", "type": "Annotation",
      "body": [{"type": "TextualBody", "purpose": "tagging", "value": "vase"}, {"type": "TextualBody", "value": "found in 1925"}],
      "target": "http://example.org/vase.obj"})";
    const PlacedAnnotations read = read_web_annotations(foreign, mesh, "file");
    ASSERT_EQ(read.set.annotations.size(), 1U);
    EXPECT_TRUE(read.set.annotations[0].all);
    EXPECT_EQ(read.set.annotations[0].tag, "vase");
    EXPECT_EQ(read.set.annotations[0].attributes.at(0).note()->text, "found in 1925");
    EXPECT_EQ(read.placements[0].how, "whole");
    const std::string fragment =
        R"([{"type": "Annotation", "bodyValue": "text", "target": {"source": "x", "selector": {"type": "FragmentSelector", "value": "a"}}}])";
    EXPECT_NE(message(fragment, mesh).find("none of its annotations"), std::string::npos);
    EXPECT_NE(message(R"({"type": "AnnotationCollection", "first": "http://example.org/page1"})", mesh).find("not embedded"),
              std::string::npos);
    EXPECT_NE(message(R"({"a": 1})", mesh).find("contains no Annotation"), std::string::npos);
    EXPECT_NE(message(R"({"type": "Annotation"})", mesh).find("needs"), std::string::npos);
    EXPECT_TRUE(read_web_annotations("[]", mesh, "f").set.annotations.empty());
}

TEST(WebAnnotation, FarPointsAreRefusedOrSkipped) {
    const Mesh mesh = spheres(3);
    const std::string text = web_annotations({mesh, wild_set(mesh)}, "m.ply", {});
    const Mesh moved = spheres(3, {{50, 0, 0}});
    EXPECT_NE(message(text, moved).find("--skip-far"), std::string::npos);
    PlaceOptions skip;
    skip.skip_far = true;
    const PlacedAnnotations read = read_web_annotations(text, moved, "file", skip);
    EXPECT_EQ(read.set.annotations.size(), 1U) << "only the whole is left";
}

TEST(WebAnnotation, DamagedFilesAreRefusedWithAMessage) {
    const Mesh mesh = spheres(3), other = shuffled(mesh);
    AnnotationSet set = wild_set(mesh);
    const std::string text = web_annotations({mesh, set}, "m.ply", {});
    std::size_t successes = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        try {
            PlaceOptions skip;
            skip.skip_far = seed % 4 == 1;
            read_web_annotations(test::mutate(text, seed), seed % 2 == 0 ? mesh : other, "file", skip);
            ++successes;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
            EXPECT_FALSE(error.problem().empty());
        }
    }
    EXPECT_LT(successes, 400U);
}

TEST(WebAnnotation, PositionsOutOfRangeAreRefused) {
    const Mesh mesh = spheres(2);
    for (const std::string places :
         {R"({"points": [[0, 0, 2e307]]})", R"({"polylines": [{"closed": false, "points": [[0, 0, 1], [-1e61, 0, 0]]}]})",
          R"({"parts": [{"area": 1, "inside": [1e300, 0, 0], "outlines": []}]})"}) {
        const std::string text_of_error = message(
            R"({"type": "Annotation", "bodyValue": "a", "target": {"source": "x", "selector": {"type": "ostraka:PlaceSelector", "places": )" +
                places + "}}}",
            mesh);
        EXPECT_NE(text_of_error.find("1e+60"), std::string::npos) << text_of_error;
    }
}
