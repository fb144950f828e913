#include "ostraka/vocabulary/infer.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/core/error.h"
#include "ostraka/io/mesh_file.h"
#include "scratch.h"
#include "vocabulary/vocabulary_examples.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace ostraka;
using namespace ostraka::example;
using ostraka::test::run_command;
using ostraka::test::Scratch;

namespace {

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The words an annotation carries, "name=value" each.
std::string split_words(const AnnotationSet& set, int id) {
    std::string text;
    for (const Attribute& attribute : set.find(id)->attributes)
        if (attribute.note() != nullptr) text += (text.empty() ? "" : " ") + attribute.name + "=" + attribute.note()->text;
    return text;
}

Attribute length(const std::string& name, double value, const std::string& unit = "mm") { return quantity(name, value, unit); }

}  // namespace

TEST(Infer, ARuleThatHoldsInfersItsValueWithAReason) {
    const InferenceResult result = infer(set_of({point(0, "whiskers", {length("bumpiness", 0.05, "1/mm")})}), busts());
    EXPECT_EQ(split_words(result.annotations, 0), "beard style=straight");
    const Attribute& attribute = result.annotations.annotations[0].attributes.back();
    EXPECT_EQ(attribute.note()->origin, "rule 'smooth': bumpiness 0.05 1/mm < 0.1 1/mm");
    EXPECT_EQ(attribute.id, 1);
    ASSERT_EQ(result.inferred.size(), 1U);
    EXPECT_EQ(result.inferred[0].rule, "smooth");
    EXPECT_TRUE(result.contradictions.empty());
    // The rule 'rough' fails on its first condition: missing inputs of the second are not reported.
    EXPECT_EQ(result.missing,
              std::vector<std::string>{"'whiskers' (id 0): the rule 'red' cannot be evaluated: it has no 'remark'"});
    // Inferred attributes satisfy the vocabulary, and are replaced, not duplicated.
    EXPECT_TRUE(check_against_vocabulary(result.annotations, busts()).empty());
    const InferenceResult again = infer(result.annotations, busts());
    EXPECT_EQ(split_words(again.annotations, 0), "beard style=straight");
    EXPECT_EQ(again.annotations.annotations[0].attributes.size(), 2U);
}

TEST(Infer, BoundsAndUnits) {
    const auto style = [](double value, const std::string& unit, const char* bound, double limit) {
        Vocabulary vocabulary = busts();
        Condition& condition = vocabulary.rules[0].conditions[0];
        condition.below.reset();
        (std::string(bound) == "min"     ? condition.min
         : std::string(bound) == "max"   ? condition.max
         : std::string(bound) == "above" ? condition.above
                                         : condition.below) = limit;
        vocabulary.rules.erase(vocabulary.rules.begin() + 1);
        return split_words(infer(set_of({point(0, "beard", {length("bumpiness", value, unit)})}), vocabulary).annotations, 0);
    };
    EXPECT_EQ(style(0.1, "1/mm", "max", 0.1), "beard style=straight");
    EXPECT_EQ(style(0.1, "1/mm", "below", 0.1), "");
    EXPECT_EQ(style(0.1, "1/mm", "min", 0.1), "beard style=straight");
    EXPECT_EQ(style(0.1, "1/mm", "above", 0.1), "");
    EXPECT_EQ(style(200, "1/m", "min", 0.1), "beard style=straight") << "0.2 per mm";
    EXPECT_EQ(style(0.2, "1/m", "min", 0.1), "");
}

TEST(Infer, RatiosAcrossAnnotations) {
    const auto infer_with = [](std::vector<Annotation> more) {
        more.push_back(point(0, "beard", {length("bumpiness", 0.3, "1/mm"), length("width", 5, "cm")}));
        return infer(set_of(std::move(more)), busts());
    };
    EXPECT_EQ(split_words(infer_with({point(1, "eye", {length("height", 10)})}).annotations, 0), "beard style=curly")
        << "5 cm / 10 mm";
    EXPECT_EQ(split_words(infer_with({point(1, "occhio", {length("height", 25)})}).annotations, 0), "") << "exactly 2";
    EXPECT_EQ(split_words(infer_with({point(1, "left eye", {length("height", 1, "in")})}).annotations, 0), "") << "1.97";
    const auto origin = infer_with({point(1, "eye", {length("height", 10)})}).inferred[0].why;
    EXPECT_TRUE(holds(origin, "width / height of eye = 5 > 2 (width 5 cm, height of eye 10 mm)")) << origin;
    // Missing inputs are reported.
    const auto missing = [&](std::vector<Annotation> more) {
        const InferenceResult result = infer_with(std::move(more));
        EXPECT_TRUE(result.inferred.empty());
        for (const std::string& line : result.missing)
            if (holds(line, "'rough'")) return line;
        return std::string("nothing is missing");
    };
    EXPECT_EQ(missing({}), "'beard' (id 0): the rule 'rough' cannot be evaluated: there is no 'eye'");
    EXPECT_TRUE(holds(missing({point(1, "eye"), point(2, "eye")}), "more than one 'eye'"));
    EXPECT_TRUE(holds(missing({point(1, "eye")}), "it has no 'height' of 'eye'"));
    EXPECT_TRUE(holds(missing({point(1, "eye", {length("height", 0)})}), "is zero"));
    EXPECT_TRUE(holds(missing({point(1, "eye", {length("height", 1, "jars")})}), "'cm' and 'jars' cannot be compared"));
    EXPECT_TRUE(holds(missing({point(1, "eye", {word("height", "tall")})}), "is a word"));
    EXPECT_TRUE(holds(missing({point(1, "eye", {length("height", 1), length("HEIGHT", 2)})}), "more than one"));
    Attribute stale = length("height", 10), list = length("height", 10);
    stale.descriptor()->stale = true;
    list.descriptor()->values = {1, 2};
    EXPECT_TRUE(holds(missing({point(1, "eye", {stale})}), "is stale"));
    EXPECT_TRUE(holds(missing({point(1, "eye", {list})}), "a list of numbers"));
}

TEST(Infer, MissingInputs) {
    const InferenceResult result = infer(set_of({point(0, "beard"), point(1, "not a concept"), point(2, "nose")}), busts());
    EXPECT_TRUE(result.inferred.empty());
    // Two rules of the beard, and the one for all concepts on beard and nose.
    ASSERT_EQ(result.missing.size(), 4U);
    EXPECT_EQ(result.missing[0], "'beard' (id 0): the rule 'smooth' cannot be evaluated: it has no 'bumpiness'");
    EXPECT_TRUE(infer(set_of({}), busts()).missing.empty());
}

TEST(Infer, ContradictingRulesAreReported) {
    Vocabulary vocabulary = busts();
    vocabulary.rules[0].conditions[0].below = 0.4;
    const AnnotationSet set = set_of(
        {point(0, "beard", {length("bumpiness", 0.3, "1/mm"), length("width", 50)}), point(1, "eye", {length("height", 5)})});
    const InferenceResult result = infer(set, vocabulary);
    EXPECT_EQ(split_words(result.annotations, 0), "");
    EXPECT_TRUE(result.inferred.empty());
    ASSERT_EQ(result.contradictions.size(), 1U);
    EXPECT_TRUE(holds(result.contradictions[0], "'beard style' is not inferred: the rule 'smooth'")) << result.contradictions[0];
    EXPECT_TRUE(holds(result.contradictions[0], "but the rule 'rough' infers 'curly'")) << result.contradictions[0];
}

TEST(Infer, StatedAttributesAreKept) {
    const auto with = [](const std::string& stated) {
        return infer(set_of({point(0, "beard", {length("bumpiness", 0.05, "1/mm"), word("Tipo di barba", stated)})}), busts());
    };
    const InferenceResult other = with("curly");
    EXPECT_EQ(split_words(other.annotations, 0), "Tipo di barba=curly");
    ASSERT_EQ(other.contradictions.size(), 1U);
    EXPECT_TRUE(holds(other.contradictions[0], "stated to be 'curly', but the rule 'smooth' infers 'straight'"));
    const InferenceResult same = with("Straight");
    EXPECT_EQ(split_words(same.annotations, 0), "Tipo di barba=Straight");
    EXPECT_TRUE(same.contradictions.empty());
}

TEST(Infer, TextValuesAreInputsToo) {
    // red remark -> clay; clay beards are curly; in any order of the rules.
    Vocabulary vocabulary = busts();
    InferenceRule rule = vocabulary.rules[1];
    rule.id = "clay is curly";
    rule.conditions = {Condition{}};
    rule.conditions[0].operand.attribute = "material";
    rule.conditions[0].is = {"clay"};
    vocabulary.rules = {rule, vocabulary.rules[2]};
    check_vocabulary(vocabulary, "v");
    const InferenceResult result = infer(set_of({point(0, "beard", {word("remark", "Reddish")})}), vocabulary);
    EXPECT_EQ(split_words(result.annotations, 0), "remark=Reddish material=clay beard style=curly");
    // If the intermediate value is contradicted, nothing is inferred from it.
    InferenceRule against = vocabulary.rules[1];
    against.id = "no";
    against.value = "marble";
    vocabulary.rules.push_back(against);
    const InferenceResult broken = infer(set_of({point(0, "beard", {word("remark", "red")})}), vocabulary);
    EXPECT_EQ(split_words(broken.annotations, 0), "remark=red");
    EXPECT_EQ(broken.contradictions.size(), 1U);
}

TEST(Infer, LongChainsOfRulesInAnyOrder) {
    // The value of each attribute follows from that of the previous one. Work that grows with more than the number of rules would
    // take this test from seconds to days.
    constexpr int count = 4000;
    Vocabulary vocabulary;
    Concept thing;
    thing.id = "thing";
    std::vector<InferenceRule> rules;
    for (int i = 0; i <= count; ++i) {
        AllowedAttribute attribute;
        attribute.name = "a" + std::to_string(i);
        thing.attributes.push_back(attribute);
        if (i == 0) continue;
        InferenceRule rule;
        rule.id = "r" + std::to_string(i);
        rule.concept_id = i % 2 == 0 ? "thing" : "";
        rule.attribute = attribute.name;
        rule.value = "yes";
        rule.conditions.emplace_back();
        rule.conditions[0].operand.attribute = "A" + std::to_string(i - 1);
        rule.conditions[0].is = {"yes"};
        rules.push_back(rule);
    }
    vocabulary.concepts.push_back(thing);
    for (const bool backwards : {false, true}) {
        vocabulary.rules = rules;
        if (backwards) std::reverse(vocabulary.rules.begin(), vocabulary.rules.end());
        check_vocabulary(vocabulary, "v");
        const InferenceResult result = infer(set_of({point(0, "thing", {word("a0", "yes")})}), vocabulary);
        ASSERT_EQ(result.inferred.size(), std::size_t(count));
        for (int i = 0; i < count; ++i) EXPECT_EQ(result.inferred[i].attribute, "a" + std::to_string(i + 1));
        EXPECT_TRUE(result.missing.empty());
        EXPECT_TRUE(examine(vocabulary).size() < 10);
    }
}

TEST(Infer, ManyContradictionsAreCountedNotListed) {
    Vocabulary vocabulary;
    Concept thing;
    thing.id = "thing";
    thing.labels["en"] = "thing";
    for (const char* name : {"style", "size"}) {
        AllowedAttribute attribute;
        attribute.name = name;
        thing.attributes.push_back(attribute);
    }
    vocabulary.concepts.push_back(thing);
    for (int i = 0; i < 1000; ++i) {
        InferenceRule rule;
        rule.id = "r" + std::to_string(i);
        rule.attribute = "style";
        rule.value = "style " + std::to_string(i);
        rule.conditions.emplace_back();
        rule.conditions[0].operand.attribute = "size";
        rule.conditions[0].above = i;
        vocabulary.rules.push_back(rule);
    }
    const auto findings = examine(vocabulary);
    ASSERT_EQ(findings.size(), 101U);
    EXPECT_TRUE(holds(findings[0].text, "the rules 'r0' and 'r1' can both hold")) << findings[0].text;
    EXPECT_TRUE(holds(findings.back().text, "499400 more pairs")) << findings.back().text;
}

TEST(Infer, TheCommand) {
    const Scratch scratch;
    const std::string data = OSTRAKA_SOURCE_DIR "/data/", words = data + "terracotta.vocabulary.json",
                      out = (scratch / "o.ant.json").string();
    for (const auto& [object, word] :
         std::vector<std::pair<std::string, std::string>>{{"vase", "slender"}, {"teapot", "squat"}, {"statuette", "slender"}}) {
        const std::string pair = data + object + ".ply " + data + object + ".ant.json ";
        const auto result = run_command("annotation infer " + pair + words + " " + out);
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_TRUE(holds(result.out, word)) << result.out;
        EXPECT_TRUE(holds(read_file(out), "\"origin\": \"rule '" + word)) << object;
        EXPECT_EQ(run_command("annotation check " + data + object + ".ply " + out + " --vocabulary " + words).code, 0);
        // Other commands preserve the origin.
        const MeshFile mesh = read_mesh(data + object + ".ply");
        const AnnotationSet set = read_annotations(out, mesh.mesh);
        EXPECT_TRUE(set.notes.empty());
        EXPECT_TRUE(holds(to_text(annotations_to_json({mesh.mesh, set}, "m.ply", {})), "\"origin\": \"rule '" + word));
    }
    const std::string vase = data + "vase.ply " + data + "vase.ant.json ";
    EXPECT_EQ(run_command("annotation infer " + vase + words + " " + words).code, 2);
    EXPECT_EQ(run_command("annotation infer " + vase + scratch.file("bad.vocabulary.json", "{}").string() + " " + out).code, 1);
    // A contradiction: the answer is no, and the rest is written.
    std::string text = read_file(words);
    const std::size_t at = text.find("\"below\": 1.5");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, 12, "\"below\": 1.9");
    const auto clash = run_command("annotation infer " + vase + scratch.file("c.vocabulary.json", text).string() + " " + out);
    EXPECT_EQ(clash.code, 3) << clash.err;
    EXPECT_TRUE(holds(clash.out, "'slender vessel'") && holds(clash.out, "'balanced vessel'")) << clash.out;
    EXPECT_FALSE(holds(read_file(out), "\"name\": \"proportion\""));
}
