// Graph files: read, written, refused.
#include "ostraka/relation/graph.h"

#include "mutate.h"
#include "ostraka/core/error.h"
#include "scratch.h"

#include <gtest/gtest.h>

using namespace ostraka;
using ostraka::test::mutate;
using ostraka::test::Scratch;

namespace {

AnnotationSet four() {
    AnnotationSet set;
    for (int id = 0; id < 4; ++id) {
        Annotation a;
        a.id = id, a.tag = "part " + std::to_string(id);
        set.annotations.push_back(a);
    }
    return set;
}

const char* const thesis_file = R"({"relationships": [
  {"id": 0, "type": "Containment", "isDirected": true, "annotations": [0, 1], "isConstraint": false},
  {"id": 1, "type": "Proportion", "isDirected": true, "annotations": [1, 2], "isConstraint": true, "weight": 2.5,
   "constraint": {"measure1": 0, "measure2": 1, "minValue": 0.25, "maxValue": 0.33}}]})";

const char* const own_file = R"({"format": "ostraka-graph", "version": 1, "relationships": [
  {"id": 5, "type": "co-axiality", "isDirected": false, "annotations": [0, 1, 3], "isConstraint": false, "origin": "stated",
   "parameters": {"deviations": [{"quantity": "angle", "value": 0.25, "tolerance": 5, "unit": "degree"},
                                 {"quantity": "distance", "tolerance": 1.5, "unit": "mm"}],
                  "axis": {"point": [1, 2, 3], "direction": [0, 0, 1]}, "up": [0, 0, 1]}},
  {"id": 2, "type": "made by the same hand", "isDirected": true, "annotations": [2, 0, 1], "isConstraint": false},
  {"id": 3, "type": "mirror symmetry", "isDirected": false, "annotations": [2], "isConstraint": false,
   "parameters": {"plane": {"point": [0, 0, 0], "normal": [1, 0, 0]}}},
  {"id": 4, "type": "equal attributes", "isDirected": false, "annotations": [2, 3], "isConstraint": false,
   "parameters": {"attribute": "area"}}]})";

RelationGraph read(const std::string& text) { return graph_from_json(parse_json(text, "g"), four(), "g"); }

/// The message of the refusal.
std::string refused(const std::string& entry) {
    try {
        read("{\"relationships\": [" + entry + "]}");
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_FALSE(error.where().empty());
        EXPECT_FALSE(error.remedy().empty()) << error.what();
        return error.what();
    }
    return "read";
}
void expect_refused(const std::string& entry, const std::string& words) {
    EXPECT_NE(refused(entry).find(words), std::string::npos) << refused(entry);
}

}  // namespace

TEST(Graph, ThesisFileIsRead) {
    const RelationGraph graph = read(thesis_file);
    ASSERT_EQ(graph.relationships.size(), 2U);
    EXPECT_EQ(graph.relationships[0].type, "containment");
    EXPECT_TRUE(graph.relationships[0].directed);
    EXPECT_EQ(graph.relationships[1].weight, 2.5);
    EXPECT_EQ(parse_json(graph.relationships[1].constraint, "c")["maxValue"].GetDouble(), 0.33);
}

TEST(Graph, RoundTripIsExact) {
    const Scratch scratch;
    for (const char* text : {thesis_file, own_file}) {
        const RelationGraph graph = read(text);
        write_graph(scratch / "a.graph.json", graph, four(), {});
        const RelationGraph again = read_graph(scratch / "a.graph.json", four());
        write_graph(scratch / "b.graph.json", again, four(), {});
        EXPECT_EQ(read_file(scratch / "a.graph.json"), read_file(scratch / "b.graph.json"));
    }
    const RelationGraph again = read_graph(scratch / "a.graph.json", four());
    const auto& parameters = again.relationships[0].parameters;
    EXPECT_EQ(parameters.deviations[0].value, 0.25);
    EXPECT_FALSE(parameters.deviations[1].value);
    EXPECT_EQ(parameters.deviations[1].tolerance, 1.5);
    EXPECT_EQ(parameters.axis->point, (std::array<double, 3>{1, 2, 3}));
    EXPECT_EQ(again.relationships[1].annotations, (std::vector<int>{2, 0, 1}));
    EXPECT_EQ(again.relationships[3].parameters.attribute, "area");
}

TEST(Graph, InvalidGraphsAreRefusedWithLocationAndRemedy) {
    const std::string rest = R"(, "isConstraint": false})", head = R"({"id": 0, "type": )";
    expect_refused(head + R"("adjacency", "isDirected": false, "annotations": [0, 9])" + rest,
                   "annotation 9, which does not exist");
    expect_refused(head + R"("adjacency", "isDirected": false, "annotations": [0])" + rest, "is said of 1 annotation");
    expect_refused(head + R"("adjacency", "isDirected": false, "annotations": [0, 1, 2])" + rest, "is said of 3 annotations");
    expect_refused(head + R"("adjacency", "isDirected": true, "annotations": [0, 1])" + rest, "has no direction");
    expect_refused(head + R"("containment", "isDirected": false, "annotations": [0, 1])" + rest, "has a direction");
    expect_refused(head + R"("my own", "isDirected": false, "annotations": [1, 1])" + rest, "twice");
    expect_refused(head + R"("equal attributes", "isDirected": false, "annotations": [0, 1])" + rest, "which attribute");
    expect_refused(head + R"("line", "isDirected": false, "annotations": [1], "isConstraint": true, "weight": -1})", "weight");
    expect_refused(head + R"("line", "isDirected": false, "annotations": [1], "isConstraint": false, "constraint": {"a": 1}})",
                   "is not marked as one");
    expect_refused(head + R"("same level", "isDirected": false, "annotations": [0, 1],
        "parameters": {"deviations": [{"quantity": "height", "tolerance": -0.5}]})" +
                       rest,
                   "tolerance of 'height' is negative");
    expect_refused(head + R"("same level", "isDirected": false, "annotations": [0, 1], "parameters": {"up": [0, 0, 0]})" + rest,
                   "up");
    const std::string good = head + R"("my own", "isDirected": true, "annotations": [1, 2])" + rest;
    EXPECT_EQ(refused(good), "read");
    expect_refused(good + "," + good, "id is used twice");
    std::string other = good;
    other.replace(other.find("\"id\": 0"), 7, "\"id\": 1");
    expect_refused(good + "," + other, "repeats relationship 0");
    // The first part of a proportion changes, so that the order matters. For one level it does not.
    const auto both = [&](const std::string& type) {
        const auto relationship_text = [&](const char* id, const char* members) {
            return std::string(R"({"id": )") + id + R"(, "isConstraint": true, "type": ")" + type +
                   R"(", "isDirected": false, "annotations": )" + members + "}";
        };
        return relationship_text("0", "[2, 1]") + "," + relationship_text("1", "[1, 2]");
    };
    EXPECT_EQ(refused(both("proportion")), "read");
    EXPECT_EQ(refused(both("structural continuity")), "read");
    EXPECT_EQ(refused(both("co-axiality")), "read");
    expect_refused(both("same level"), "repeats relationship 0");
    EXPECT_THROW(read(R"({"relationships": [{"id": 0}]})"), Error);
    EXPECT_THROW(read(R"({"relationships": 3})"), Error);
    EXPECT_THROW(read(R"({"relationships": [], "unknown": 1})"), Error);
}

TEST(Graph, NearestTypeIsSuggested) {
    EXPECT_EQ(nearest_relation_type("Coaxiality"), "co-axiality");
    EXPECT_EQ(nearest_relation_type("mirror simmetry"), "mirror symmetry");
    EXPECT_EQ(find_relation_type("Same Level")->name, "same level");
    EXPECT_EQ(find_relation_type("same levels"), nullptr);
}

TEST(Graph, TextIsEscapedInDot) {
    AnnotationSet set = four();
    set.annotations[0].tag = "a\"]; evil [label=\"<b>x</b>\\N &lt;i&gt;\n\x01 Ä \xC2\x9B \xE2\x80\xAE";
    RelationGraph graph = read(own_file);
    graph.relationships[1].type = "</text><script>alert(\"1\")</script>";
    const std::string dot = graph_to_dot(graph, set);
    EXPECT_EQ(dot.find("evil [label=\""), std::string::npos);
    EXPECT_EQ(dot.find('<'), std::string::npos);
    EXPECT_EQ(dot.find('\\'), std::string::npos);
    for (const char* control : {"\x01", "\xC2\x9B", "\xE2\x80\xAE"}) EXPECT_EQ(dot.find(control), std::string::npos);
    EXPECT_NE(dot.find("&lt;b&gt;x&lt;/b&gt;&#92;N &amp;lt;i&amp;gt;"), std::string::npos) << dot;
    EXPECT_NE(dot.find("Ä"), std::string::npos);
    // Every quote opens or closes a string: an even number on each line.
    std::size_t quotes = 0;
    for (const char c : dot) {
        if (c == '"') ++quotes;
        if (c == '\n') {
            EXPECT_EQ(quotes % 2, 0U);
            quotes = 0;
        }
    }
    // Three members: one node for the relationship, an arc to each.
    EXPECT_NE(dot.find("\"r5\" -> \"a3\" [dir=none]"), std::string::npos) << dot;
    EXPECT_NE(dot.find("\"a2\" -> \"r2\""), std::string::npos) << "the subject points to the relationship";
}

TEST(Graph, DamagedFilesEndInAReadOrAClearError) {
    std::size_t read_well = 0;
    for (const char* text : {thesis_file, own_file})
        for (std::uint64_t seed = 0; seed < 300; ++seed) {
            try {
                const RelationGraph graph = read(mutate(text, seed));
                (void)to_text(graph_to_json(graph, {}));
                (void)graph_to_dot(graph, four());
                ++read_well;
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
                EXPECT_FALSE(error.problem().empty());
            }
        }
    EXPECT_LT(read_well, 500U);
    EXPECT_GT(read_well, 5U);
}
