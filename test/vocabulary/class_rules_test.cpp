#include "ostraka/vocabulary/class_rules.h"

#include "mutate.h"
#include "ostraka/core/error.h"
#include "scratch.h"
#include "vocabulary/vocabulary_examples.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::example;
using ostraka::test::mutate;
using ostraka::test::run_command;
using ostraka::test::Scratch;

namespace {

const std::string rules_text = R"({"format": "ostraka-rules", "version": 1, "class": "bust", "rules": [
  {"id": "two eyes", "count": {"of": "eye", "min": 2, "max": 2}},
  {"id": "few points", "count": {"of": {"tag": "*", "type": "point"}, "max": 6}},
  {"id": "nose on the head", "note": "else it is another's", "relation": {"of": "nose", "is": ["adjacency", "containment"], "to": "head", "place": "second"}},
  {"id": "material", "attribute": {"of": {"tag": "*", "type": "point"}, "name": "material", "is": ["clay", "Marmor"]}},
  {"id": "eyes are small", "attribute": {"of": "eye", "name": "height", "max": 2, "unit": "cm"}}]})";

ClassRules rules(const std::string& text = rules_text) { return class_rules_from_json(parse_json(text, "r.json"), "r.json"); }

std::vector<std::string> broken(const AnnotationSet& set, const std::vector<RelationFact>& relations,
                                const std::string& text = rules_text) {
    static const Vocabulary vocabulary = busts();
    std::vector<std::string> violations;
    for (const RuleViolation& rule : check_class_rules(set, rules(text), &vocabulary, relations, "r.json"))
        violations.push_back(rule.rule + ": " + rule.text);
    return violations;
}

Annotation clay(int id, const std::string& tag, std::vector<Attribute> more = {}) {
    more.push_back(word("material", "clay"));
    return point(id, tag, std::move(more));
}

std::vector<Annotation> good() {
    return {clay(0, "head"), clay(1, "left eye", {quantity("height", 15, "mm")}),
            clay(2, "Occhio 2", {quantity("height", 1.5, "cm")}), clay(3, "nose")};
}

const std::vector<RelationFact> on_head{{"Containment", true, {0, 3}}};

std::string rule(const std::string& body) {
    return R"({"format": "ostraka-rules", "version": 1, "rules": [{"id": "r", )" + body + "}]}";
}

void expect_error(const std::string& text, const std::string& place, const std::string& words) {
    try {
        check_class_rules(set_of(good()), rules(text), nullptr, {}, "r.json");
        static const Vocabulary vocabulary = busts();
        check_class_rules(set_of(good()), rules(text), &vocabulary, {}, "r.json");
        ADD_FAILURE() << "not refused: " << words;
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_TRUE(message.starts_with("r.json: ")) << message;
        EXPECT_NE(message.find(place), std::string::npos) << message;
        EXPECT_NE(message.find(words), std::string::npos) << message;
        EXPECT_FALSE(error.remedy().empty());
    }
}

}  // namespace

TEST(ClassRules, ASetThatSatisfiesThemHasNoViolations) { EXPECT_EQ(broken(set_of(good()), on_head), std::vector<std::string>{}); }

TEST(ClassRules, Counts) {
    auto annotations = good();
    annotations.push_back(clay(4, "eye", {quantity("height", 1, "mm")}));
    EXPECT_EQ(
        broken(set_of(annotations), on_head),
        std::vector<std::string>{
            "two eyes: there must be exactly 2 of 'eye', but there are 3: 'left eye' (id 1), 'Occhio 2' (id 2), 'eye' (id 4)"});
    for (int id = 5; id < 8; ++id) annotations.push_back(clay(id, "beard"));
    EXPECT_EQ(broken(set_of(annotations), on_head).at(1).substr(0, 65),
              "few points: there must be at most 6 of point, but there are 8: 'h");
    EXPECT_EQ(broken(set_of({}), {}), std::vector<std::string>{"two eyes: there must be exactly 2 of 'eye', but there are 0"});
}

TEST(ClassRules, Attributes) {
    auto annotations = good();
    annotations[0].attributes.clear();
    annotations[1].attributes[0].descriptor()->values = {25};
    annotations[3].attributes[0].note()->text = "bronze";
    EXPECT_EQ(broken(set_of(annotations), on_head),
              (std::vector<std::string>{"material: 'head' (id 0) has no attribute 'material'",
                                        "material: the 'material' of 'nose' (id 3) is 'bronze', but must be 'clay' or 'Marmor'",
                                        "eyes are small: the 'height' of 'left eye' (id 1) is 25 mm, but must be 2 cm or less"}));
    annotations = good();
    annotations[3].attributes[0].note()->text = "marmo";  // the same word in another language
    annotations[1].attributes[0].descriptor()->stale = true;
    EXPECT_EQ(
        broken(set_of(annotations), on_head),
        std::vector<std::string>{"eyes are small: the 'height' of 'left eye' (id 1) is 15 mm (stale), but must be 2 cm or less"});
}

TEST(ClassRules, Relations) {
    const std::string missing_relation =
        "nose on the head: 'nose' (id 3) has no relationship of type 'adjacency' or 'containment' to 'head' (else it is "
        "another's)";
    const auto with = [](const std::vector<RelationFact>& relations) { return broken(set_of(good()), relations); };
    EXPECT_EQ(with({}), std::vector<std::string>{missing_relation});
    EXPECT_TRUE(with({{"adjacency", false, {3, 0}}}).empty());
    EXPECT_EQ(with({{"containment", true, {3, 0}}}), std::vector<std::string>{missing_relation}) << "the head in the nose";
    EXPECT_EQ(with({{"same level", false, {0, 3}}}), std::vector<std::string>{missing_relation});
    EXPECT_TRUE(with({{"containment", true, {1, 3}}}).empty()) << "an eye is a concept below head";
    auto apart = good();
    apart.push_back(clay(9, "rock"));
    EXPECT_TRUE(broken(set_of(apart), {{"containment", true, {0, 9}}, {"containment", true, {9, 3}}}).empty())
        << "through what lies between";
    // A cycle, which no mesh produces, terminates.
    EXPECT_EQ(with({{"containment", true, {3, 1}}, {"containment", true, {1, 3}}}).size(), 0U);
    // A nose is a narrower concept of head, but not related to itself.
    EXPECT_EQ(with({{"adjacency", false, {3, 3}}}), std::vector<std::string>{missing_relation});
    auto annotations = good();
    annotations.erase(annotations.begin(), annotations.begin() + 3);
    const auto lonely = broken(set_of(annotations), {}, rule(R"("relation": {"of": "nose", "is": "adjacency", "to": "eye"})"));
    EXPECT_EQ(lonely, std::vector<std::string>{
                          "r: 'nose' (id 3) has no relationship of type 'adjacency' to any 'eye', as there is none"});
}

TEST(ClassRules, WithoutAVocabularyTagsAreComparedLiterally) {
    const auto text = [](const std::vector<Annotation>& annotations) {
        std::string all;
        for (const auto& violation :
             check_class_rules(set_of(annotations), rules(rule(R"("count": {"of": "Eye", "min": 2})")), nullptr, {}, "r"))
            all += violation.text;
        return all;
    };
    EXPECT_EQ(text({point(0, "eye 1"), point(1, " EYE")}), "");
    EXPECT_EQ(text({point(0, "eye 1"), point(1, "left eye")}),
              "there must be at least 2 of 'Eye', but there are 1: 'eye 1' (id 0)");
}

TEST(ClassRules, InvalidInputIsRefused) {
    expect_error(rule(R"("count": {"of": "eye"})"), "/rules/0/count", "without bounds");
    expect_error(rule(R"("count": {"of": "eye", "min": 3, "max": 2})"), "/rules/0/count", "above");
    expect_error(rule(R"("count": {"of": "ey", "min": 3})"), "/rules/0/count/of", "no concept 'ey'");
    expect_error(rule(R"("count": {"of": "Nase", "min": 3})"), "/rules/0/count/of", "more than one");
    expect_error(rule(R"("note": "x")"), "/rules/0", "one of the three");
    expect_error(rule(R"("count": {"of": "eye", "min": 1}, "relation": {"of": "eye", "is": "adjacency", "to": "nose"})"),
                 "/rules/0", "one of the three");
    expect_error(rule(R"("attribute": {"of": "eye", "name": "height", "is": "x", "min": 1})"), "/rules/0/attribute",
                 "words and bounds");
    expect_error(rule(R"("attribute": {"of": "eye", "name": "height", "mim": 1})"), "/rules/0/attribute", "unknown member 'mim'");
    expect_error(R"({"format": "ostraka-vocabulary", "version": 1, "rules": []})", "/format", "ostraka-vocabulary");
    std::string twice = rules_text;
    twice.replace(twice.find("few points"), 10, "two eyes");
    expect_error(twice, "/rules/1/id", "two eyes");
}

TEST(ClassRules, DamagedFiles) {
    static const Vocabulary vocabulary = busts();
    std::size_t read = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        try {
            check_class_rules(set_of(good()), rules(mutate(rules_text, seed)), &vocabulary, on_head, "r.json");
            ++read;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
        }
    }
    EXPECT_LT(read, 200U);
}

TEST(ClassRules, TheCommandDerivesRelationsFromTheMesh) {
    const Scratch scratch;
    const std::string data = OSTRAKA_SOURCE_DIR "/data/", pair = data + "teapot.ply " + data + "teapot.ant.json ";
    const auto check = [&](const std::string& text, const std::string& more = {}) {
        return run_command("annotation check " + pair + "--rules " + scratch.file("t.rules.json", text).string() + more);
    };
    const std::string words = " --vocabulary " + data + "terracotta.vocabulary.json";
    const std::string sound = R"({"format": "ostraka-rules", "version": 1, "rules": [
        {"id": "five flowers", "count": {"of": "flower", "min": 5, "max": 5}},
        {"id": "spout", "relation": {"of": "spout", "is": "adjacency", "to": "body"}},
        {"id": "flowers", "relation": {"of": {"tag": "flower", "type": "region"}, "is": ["containment", "adjacency"], "to": "body"}},
        {"id": "whole", "relation": {"of": {"tag": "knob", "type": "region"}, "is": "containment", "to": "flowered teapot", "place": "second"}}]})";
    EXPECT_EQ(check(sound).code, 3) << "without a vocabulary a 'flowered teapot' is no tag of the file";
    const auto good_answer = check(sound, words);
    EXPECT_EQ(good_answer.code, 3) << "the root is tagged 'teapot', the broader concept";
    EXPECT_NE(good_answer.out.find("to any 'flowered teapot'"), std::string::npos) << good_answer.out;
    std::string mended = sound;
    mended.replace(mended.find("\"flowered teapot\""), 17, "\"teapot\"");
    const auto remaining_violations = check(mended, words);
    EXPECT_EQ(remaining_violations.code, 0) << remaining_violations.out << remaining_violations.err;
    const auto no_material =
        check(rule(R"("attribute": {"of": {"tag": "*", "type": "region"}, "name": "material"})"), words + " --json");
    EXPECT_EQ(no_material.code, 3);
    const Json report = parse_json(no_material.out, "report");
    EXPECT_EQ(report["result"]["defects"].GetInt(), 12) << "twelve regions";
    EXPECT_EQ(check("{}").code, 1);
    EXPECT_EQ(run_command("annotation check " + pair + "--graph x.graph.json").code, 2);
    // An empty graph.
    const std::string graph =
        scratch.file("e.graph.json", R"({"format": "ostraka-graph", "version": 1, "relationships": []})").string();
    const auto stated = check(rule(R"("relation": {"of": "spout", "is": "adjacency", "to": "body"})"), " --graph " + graph);
    EXPECT_EQ(stated.code, 3) << stated.err;
    EXPECT_NE(stated.out.find("'spout' (id 5) has no relationship of type 'adjacency' to 'body'"), std::string::npos)
        << stated.out;
}
