#include "ostraka/relation/query.h"

#include "meshes.h"
#include "scratch.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::test;

namespace {

/// A box of 12 x 6^2 faces, its faces assigned to parts in order: areas are proportional to the numbers of faces.
class Query : public ::testing::Test {
protected:
    Query() : mesh(build_mesh(box(6))), face(face_area(mesh, Face(0))) {
        set.unit = "mm";
        add("body", 90);
        add("left arm", 10);
        add("right arm", 12);
        add("leg 1", 8);
        add("leg 2", 8);
        add("handle", 30);
        note(0, "decoration", "Painted");
        measure(0, "height", 3, "cm");
        measure(5, "height", 20, "mm");
        graph.relationships.push_back(related(0, "same mould", {4, 6}, false));
        graph.relationships.push_back(related(1, "rests on", {1, 4}, true));
    }
    void add(const std::string& tag, std::size_t faces) {
        Annotation annotation;
        annotation.id = static_cast<int>(set.annotations.size()) + 1;
        annotation.tag = tag;
        for (std::size_t i = 0; i < faces; ++i) annotation.faces.push_back(next++);
        set.annotations.push_back(annotation);
    }
    void note(std::size_t at, const std::string& name, const std::string& word) {
        set.annotations[at].attributes.push_back({free_attribute(at), name, Note{word, {}}});
    }
    void measure(std::size_t at, const std::string& name, double value, const std::string& unit) {
        Attribute attribute{free_attribute(at), name, Descriptor()};
        attribute.descriptor()->values = {value};
        attribute.descriptor()->unit = unit;
        set.annotations[at].attributes.push_back(attribute);
    }
    [[nodiscard]] int free_attribute(std::size_t at) const { return static_cast<int>(set.annotations[at].attributes.size()); }
    static Relationship related(int id, const std::string& type, std::vector<int> annotations, bool directed) {
        Relationship relationship;
        relationship.id = id, relationship.type = type, relationship.annotations = std::move(annotations),
        relationship.directed = directed;
        return relationship;
    }
    QueryAnswer ask(const std::string& text) {
        QueriedObject object{{mesh, set}, &graph, words, {}};
        object.values_elsewhere = [](const QueryReference& reference) {
            return reference == QueryReference{"decoration", "17"} ? std::vector<std::string>{"painted"}
                                                                   : std::vector<std::string>{};
        };
        return AnnotationQuery(text).ask(object);
    }
    [[nodiscard]] bool holds(const std::string& text) { return ask(text).holds; }
    std::vector<int> annotations_of(const std::string& text) { return ask(text).annotations; }

    Mesh mesh;
    double face;
    Index next = 0;
    AnnotationSet set;
    RelationGraph graph;
    const Vocabulary* words = nullptr;
};

using Ids = std::vector<int>;

}  // namespace

TEST_F(Query, CountsParts) {
    EXPECT_EQ(annotations_of("2 leg"), (Ids{4, 5}));
    EXPECT_FALSE(holds("3 leg"));
    EXPECT_TRUE(holds("count(leg) = 2"));
    EXPECT_FALSE(holds("count(leg) != 2"));
    EXPECT_EQ(annotations_of("handle and \"left arm\""), (Ids{2, 6}));
    EXPECT_TRUE(holds("not crown"));
    EXPECT_FALSE(holds("crown or horn"));
    EXPECT_EQ(annotations_of("crown or handle"), (Ids{6}));
    EXPECT_TRUE(holds("has(body) and not (crown or 3 leg)"));
}

TEST_F(Query, ComparesQuantitiesInAnyUnit) {
    EXPECT_EQ(annotations_of("area(handle) >= area(body) / 3"), (Ids{1, 6}));
    EXPECT_FALSE(holds("area(handle) > area(body) / 3"));
    EXPECT_TRUE(holds("height(body) > height(handle)"));  // 3 cm and 20 mm
    EXPECT_TRUE(holds("height(body) = 30 mm and height(handle) <= 0.02 m"));
    EXPECT_TRUE(holds("height(body) / height(handle) = 1.5"));
    EXPECT_TRUE(holds("height(body) - height(handle) = 10 mm"));
    EXPECT_TRUE(holds("2 * area(leg) < area(\"right arm\") + area(\"left arm\")"));
    EXPECT_TRUE(holds("height(body) > -1 mm"));
    EXPECT_FALSE(holds("height(leg) > 0"));  // it has none
    EXPECT_TRUE(ask("height(leg) > 0").problems.empty());
}

TEST_F(Query, AWordDenotesOneAnnotationThroughout) {
    EXPECT_TRUE(holds("related(\"same mould\", leg)"));
    EXPECT_EQ(annotations_of("related(\"same mould\", leg, handle)"), (Ids{4, 6}));
    // Both conditions hold, but not for the same arm.
    EXPECT_TRUE(holds("2 leg and area(leg) > 0"));
    note(3, "side", "left");
    note(4, "glaze", "none");
    EXPECT_TRUE(holds("side(leg) = left"));
    EXPECT_TRUE(holds("glaze(leg) = none"));
    EXPECT_FALSE(holds("side(leg) = left and glaze(leg) = none"));
}

TEST_F(Query, Relationships) {
    EXPECT_TRUE(holds("related(\"rests on\", body, leg)"));
    EXPECT_FALSE(holds("related(\"rests on\", leg, body)"));  // it has a direction
    EXPECT_TRUE(holds("related('Same  Mould', 6)"));
    EXPECT_FALSE(holds("related(\"same mould\", 1)"));
    EXPECT_FALSE(holds("related(\"same mould\", handle, handle)"));
}

TEST_F(Query, WordsAndOtherObjects) {
    EXPECT_TRUE(holds("decoration(body) = painted"));
    EXPECT_TRUE(holds("\"PAINTED\" = Decoration(body)"));
    EXPECT_FALSE(holds("decoration(body) != painted"));
    EXPECT_EQ(annotations_of("same(decoration, 17)"), (Ids{1}));
    EXPECT_FALSE(holds("same(height, 17)"));
    QueriedObject object{{mesh, set}, nullptr, nullptr, {}};
    EXPECT_EQ(values_of(object, "decoration"), std::vector<std::string>{"painted"});
    EXPECT_EQ(values_of(object, "height").size(), 2U);
}

TEST_F(Query, WordsOfAVocabularyInAnyLanguageAndNarrower) {
    Vocabulary vocabulary;
    Concept limb, arm;
    limb.id = "limb";
    limb.labels = {{"en", "limb"}, {"it", "arto"}};
    arm.id = "arm";
    arm.labels = {{"en", "arm"}, {"it", "braccio"}};
    arm.alternatives = {{"en", {"left arm", "right arm"}}};
    arm.broader = {"limb"};
    vocabulary.concepts = {limb, arm};
    words = &vocabulary;
    EXPECT_EQ(annotations_of("2 braccio"), (Ids{2, 3}));
    EXPECT_EQ(annotations_of("2 arto"), (Ids{2, 3}));
    EXPECT_TRUE(holds("area(limb) > 0"));
    words = nullptr;
    EXPECT_FALSE(holds("2 arto"));
}

TEST_F(Query, IncompatibleUnitsAreAProblemAndNoMatch) {
    for (const char* text : {"area(handle) > 5", "area(handle) > 5 mm", "height(body) + area(body) > 0 mm"}) {
        const QueryAnswer answer = ask(text);
        EXPECT_FALSE(answer.holds) << text;
        ASSERT_EQ(answer.problems.size(), 1U) << text;
        EXPECT_NE(answer.problems[0].find("column"), std::string::npos);
    }
    set.unit.clear();
    EXPECT_TRUE(holds("area(handle) > 0.001"));
}

TEST(QueryText, InvalidQueriesAreRefusedWithLocationAndRemedy) {
    const std::pair<const char*, const char*> wrong[]{
        {"", "column 1"},
        {"2 arm and", "column 10"},
        {"area(handle)", "column 1"},
        {"area(handle) > ", "column 16"},
        {"(handle", "column 8"},
        {"handle)", "column 7"},
        {"handle body", "column 8"},
        {"2.5 arm", "column 1"},
        {"0 arm", "column 1"},
        {"area(handle) > 5 mm^7", "column 18"},
        {"area(handle) > big", "column 14"},
        {"area() > 5", "column 6"},
        {"related(handle)", "column 1"},
        {"same(a, b, c)", "column 1"},
        {"has(a, b)", "column 1"},
        {"\"arm", "column 1"},
        {"arm & leg", "column 5"},
        {"area(handle) + (arm and leg) > 5", "column"},
        {"area(1e999) > 5", "column 6"},
    };
    for (const auto& [text, place] : wrong) {
        try {
            const AnnotationQuery query(text);
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage) << text;
            EXPECT_NE(error.problem().find(place), std::string::npos) << text << ": " << error.what();
            EXPECT_FALSE(error.remedy().empty()) << text;
        }
    }
    EXPECT_THROW(AnnotationQuery(std::string(5000, '(')), Error);
    EXPECT_THROW(AnnotationQuery(std::string(20000, 'a')), Error);
    std::string many = "not ";
    for (int i = 0; i < 10; ++i) many += many.size() < 4000 ? many : "";
    EXPECT_THROW(AnnotationQuery(many + "a"), Error);
}

TEST_F(Query, TooManyChoicesAreRefused) {
    for (int i = 0; i < 120; ++i) add("a", 0), add("b", 0), add("c", 0);
    EXPECT_THROW(ask("x(a) = y and x(b) = y and x(c) = y"), Error);
    EXPECT_NO_THROW(ask("100 a and x(b) = y"));
}

TEST(FindCommand, FindsInFoldersAndSingleFiles) {
    const Scratch scratch;
    const std::string data = OSTRAKA_SOURCE_DIR "/data/";
    for (const char* name : {"teapot", "chair"}) {
        write_file(scratch / (std::string(name) + ".ply"), read_file(data + name + ".ply"));
        write_file(scratch / (std::string(name) + ".ant.json"), read_file(data + name + ".ant.json"));
    }
    const std::string folder = scratch.path().string();
    const CommandResult pots = run_command("annotation find 'spout and area(spout) < area(body)' " + folder + " --json");
    ASSERT_EQ(pots.code, 0) << pots.err;
    const Json report = parse_json(pots.out, "report");
    validate(report, "report", "report");
    ASSERT_EQ(report["result"]["matches"].Size(), 1U);
    EXPECT_STREQ(report["result"]["matches"][0]["object"].GetString(), "teapot");
    EXPECT_EQ(report["result"]["matches"][0]["annotations"].Size(), 2U);
    EXPECT_EQ(run_command("annotation find spout " + data + "teapot.ant.json").code, 0);
    EXPECT_EQ(run_command("annotation find spout " + data + "teapot.ply").code, 0);
    const CommandResult none = run_command("annotation find spuot " + folder);
    EXPECT_EQ(none.code, 3);
    EXPECT_NE(none.err.find("did you mean 'spout'"), std::string::npos) << none.err;
    const CommandResult wrong = run_command("annotation find 'spout and' " + folder);
    EXPECT_EQ(wrong.code, 2);
    EXPECT_NE(wrong.err.find("column"), std::string::npos) << wrong.err;
    EXPECT_EQ(run_command("annotation find 'same(area, nobody)' " + folder).code, 2);
    EXPECT_EQ(run_command("annotation find spout " + data + "chair.obj").code, 1);
    write_file(scratch / "broken.ply", "ply\n");
    write_file(scratch / "broken.ant.json", "{}");
    const CommandResult some = run_command("annotation find spout " + folder);
    EXPECT_EQ(some.code, 0) << some.err;
    EXPECT_NE(some.err.find("left out: broken"), std::string::npos) << some.err;
}
