// The prototype's .ant and .fct: round trip, losses, damage.
#include "interchange/prototype_files.h"
#include "mutate.h"
#include "ostraka/core/error.h"
#include "sets.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::example;

TEST(PrototypeFiles, AnnotationsRoundTrip) {
    const Mesh mesh = spheres(3);
    const AnnotationSet set = wild_set(mesh);
    std::vector<std::string> notes;
    const std::string text = prototype_annotations({mesh, set}, notes);
    EXPECT_EQ(text.find_first_of("<>&"), std::string::npos);
    EXPECT_FALSE(notes.empty());
    const Json document = parse_json(text, "f");
    for (const auto& annotation : document["annotations"].GetArray()) {
        EXPECT_TRUE(annotation.HasMember("color") && annotation.HasMember("attributes"));
        for (const auto& attribute : annotation["attributes"].GetArray()) EXPECT_TRUE(attribute.HasMember("value"));
        if (annotation.HasMember("boundaries")) {
            for (const auto& boundary : annotation["boundaries"].GetArray())
                EXPECT_EQ(boundary[0], boundary[boundary.Size() - 1]);
        }
    }
    const AnnotationSet read = annotations_from_json(document, mesh, "f");
    ASSERT_EQ(read.annotations.size(), set.annotations.size());
    for (std::size_t i = 0; i < set.annotations.size(); ++i) {
        const Annotation &before = set.annotations[i], &after = read.annotations[i];
        EXPECT_EQ(after.id, before.id);
        EXPECT_EQ(after.tag, before.tag);
        EXPECT_EQ(after.colour, before.colour);
        EXPECT_EQ(after.points, before.points);
        EXPECT_EQ(after.polylines, before.polylines);
        EXPECT_EQ(after.faces, before.faces) << before.tag;
        ASSERT_EQ(after.attributes.size(), before.attributes.size());
        for (std::size_t k = 0; k < before.attributes.size(); ++k) {
            const Attribute &expected = before.attributes[k], &actual = after.attributes[k];
            EXPECT_EQ(actual.name, expected.name);
            if (expected.note() != nullptr) {
                ASSERT_NE(actual.note(), nullptr);
                EXPECT_EQ(actual.note()->text, expected.note()->text);
            }
            if (expected.measure() == nullptr) continue;
            EXPECT_EQ(actual.measure()->points, expected.measure()->points);
            EXPECT_EQ(actual.measure()->tool, expected.measure()->tool);
            EXPECT_EQ(actual.measure()->direction, expected.measure()->direction);
            if (expected.measure()->value) {
                EXPECT_EQ(actual.measure()->value, expected.measure()->value);
            }
        }
    }
}

TEST(PrototypeFiles, FacetsRoundTrip) {
    const Mesh mesh = spheres(3, {{0, 0, 0}, {3, 0, 0}});
    AnnotationSet set = wild_set(mesh);
    set.annotations.back().attributes.push_back(semantic(0, "facet", "fracture"));
    Annotation ball;
    ball.tag = "whole ball";
    ball.id = 900;
    for (const Face f : mesh.faces())
        if (centroid(mesh, f).x() > 1.5) ball.faces.push_back(f);
    set.annotations.push_back(ball);
    std::vector<std::string> notes;
    const std::string text = prototype_facets({mesh, set}, "m.ply", notes);
    const AnnotationSet read = read_prototype_facets(text, mesh, "f");
    std::vector<const Annotation*> regions;
    for (const Annotation& annotation : set.annotations)
        if (annotation.type == AnnotationType::region && !annotation.all) regions.push_back(&annotation);
    ASSERT_EQ(read.annotations.size(), regions.size());
    for (std::size_t i = 0; i < regions.size(); ++i) {
        EXPECT_EQ(read.annotations[i].tag, regions[i]->tag);
        EXPECT_EQ(read.annotations[i].faces, regions[i]->faces);
        EXPECT_EQ(read.annotations[i].attributes[0].note()->text, i + 2 == regions.size() ? "fracture" : "external");
    }
    // Borders with reversed direction: the inner vertices determine the side.
    std::string turned;
    bool border = false;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = text.find('\n', at);
        std::string line = text.substr(at, end - at);
        at = end + 1;
        if (line == "Vertices:") border = false;
        if (border) {
            std::vector<std::string> words;
            std::istringstream stream(line);
            for (std::string word; stream >> word;) words.insert(words.begin(), word);
            line.clear();
            for (const auto& word : words) line += word + " ";
        }
        if (line == "Border:") border = true;
        turned += line + "\n";
    }
    const AnnotationSet reread = read_prototype_facets(turned, mesh, "f");
    for (std::size_t i = 0; i < regions.size(); ++i) EXPECT_EQ(reread.annotations[i].faces, regions[i]->faces);
}

TEST(PrototypeFiles, DamagedFacetsAreRefusedWithAMessage) {
    const Mesh mesh = spheres(3);
    std::vector<std::string> notes;
    const std::string facets = prototype_facets({mesh, wild_set(mesh)}, "m.ply", notes),
                      ant = prototype_annotations({mesh, wild_set(mesh)}, notes);
    std::size_t successes = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed)
        for (const bool facet : {true, false}) {
            try {
                if (facet) read_prototype_facets(test::mutate(facets, seed), mesh, "f");
                else annotations_from_json(parse_json(test::mutate(ant, seed), "f"), mesh, "f");
                ++successes;
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
            }
        }
    EXPECT_LT(successes, 400U);
    const auto message = [&](const std::string& text) {
        try {
            read_prototype_facets(text, mesh, "f");
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(message("").find("Filename"), std::string::npos);
    EXPECT_NE(message("Filename: a\nNumber of Facets: 1\n\nFacet ID: a\nType: odd\n").find("line 5"), std::string::npos);
    EXPECT_NE(message("Filename: a\nNumber of Facets: 1\n\nFacet ID: a\nType: internal\nBorder:\n0 1 99999\n").find("99999"),
              std::string::npos);
    EXPECT_TRUE(message("Filename: a\nNumber of Facets: 0\n\n").empty());
}
