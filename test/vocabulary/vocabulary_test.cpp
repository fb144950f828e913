#include "ostraka/vocabulary/vocabulary.h"

#include "ostraka/core/error.h"
#include "ostraka/vocabulary/text_match.h"
#include "vocabulary/vocabulary_examples.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace ostraka;
using namespace ostraka::example;

namespace {

/// The example with a piece of its text replaced.
std::string changed(const std::string& from, const std::string& to) {
    std::string text = bust_vocabulary;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

void expect_error(const std::string& text, const std::string& place, const std::string& words) {
    try {
        vocabulary_from_json(parse_json(text, "v.json"), "v.json");
        ADD_FAILURE() << "not refused: " << words;
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        const std::string message = error.what();
        EXPECT_EQ(message.find("v.json"), 0U) << message;
        EXPECT_NE(message.find(place), std::string::npos) << message;
        EXPECT_NE(message.find(words), std::string::npos) << message;
        EXPECT_FALSE(error.remedy().empty()) << message;
    }
}

std::vector<std::string> defects(const AnnotationSet& set, const CheckVocabularyOptions& options = {}) {
    std::vector<std::string> list;
    for (const auto& finding : check_against_vocabulary(set, busts(), options))
        if (finding.defect) list.push_back(finding.where + " " + finding.text);
    return list;
}

std::string only_defect(const Annotation& annotation, const CheckVocabularyOptions& options = {}) {
    const auto found_defects = defects(set_of({annotation}), options);
    EXPECT_EQ(found_defects.size(), 1U);
    return found_defects.empty() ? "" : found_defects.front();
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST(TextMatch, CaseAndBlanksAreIgnored) {
    EXPECT_EQ(folded("  Left \t EYE "), "left eye");
    EXPECT_EQ(folded("\xC3\x84RMEL \xC3\x96hr"), "\xC3\xA4rmel \xC3\xB6hr");
    EXPECT_EQ(folded("\xCE\x9A\xCE\x95\xCE\xA6\xCE\x91\xCE\x9B\xCE\x89"), "\xCE\xBA\xCE\xB5\xCF\x86\xCE\xB1\xCE\xBB\xCE\xAE");
    EXPECT_EQ(folded("\xD0\x93\xD0\x9E\xD0\x9B"), "\xD0\xB3\xD0\xBE\xD0\xBB");
    EXPECT_EQ(folded("\xC5\xBDIVOT"), "\xC5\xBEivot");
    EXPECT_EQ(folded("a\xFF"), "a\xFF") << "bytes that are no text stay";
    EXPECT_EQ(folded(" \n "), "");
}

TEST(TextMatch, NearMisses) {
    const std::vector<std::string> words{"handle", "lip", "hand", "candle", "neck", "Handle"};
    EXPECT_EQ(near_misses("hadnle", words), (std::vector<std::string>{"handle", "Handle", "candle"}));
    EXPECT_EQ(near_misses("xyzzy", words), std::vector<std::string>{});
    EXPECT_EQ(near_misses(std::string(1000, 'a'), words), std::vector<std::string>{});
    EXPECT_EQ(did_you_mean({"a", "b", "c"}), ": did you mean 'a', 'b' or 'c'?");
    EXPECT_EQ(did_you_mean({}), "");
}

TEST(TextMatch, Units) {
    EXPECT_DOUBLE_EQ(*converted(2.5, "cm", "mm"), 25);
    EXPECT_DOUBLE_EQ(*converted(1, "m^2", "mm^2"), 1e6);
    EXPECT_DOUBLE_EQ(*converted(1, "1/mm", "1/m"), 1000);
    EXPECT_DOUBLE_EQ(*converted(1, "in", "mm"), 25.4);
    EXPECT_DOUBLE_EQ(*converted(180, "deg", "rad"), std::acos(-1.0));
    // Ratios of units of length are rounded once.
    EXPECT_EQ(*converted(1, "mm", "um"), 1000);
    EXPECT_EQ(*converted(1, "in", "mm"), 25.4);
    EXPECT_EQ(*converted(1, "in", "dm"), 0.254);
    EXPECT_EQ(*converted(1, "ft", "in"), 12);
    EXPECT_EQ(*converted(7, "jars", "jars"), 7);
    EXPECT_FALSE(converted(1, "mm", "mm^2"));
    EXPECT_FALSE(converted(1, "mm", "jars"));
    EXPECT_FALSE(converted(1, "rad", "mm"));
}

TEST(Vocabulary, ReadingAndWritingGivesTheSame) {
    const Vocabulary vocabulary = busts();
    ASSERT_EQ(vocabulary.concepts.size(), 7U);
    EXPECT_EQ(vocabulary.concepts[3].alternatives.at("en").size(), 2U);
    EXPECT_EQ(vocabulary.concepts[1].attributes[0].max, 20.5);
    EXPECT_EQ(vocabulary.rules[1].conditions[1].divisor->concept_id, "eye");
    const std::string text = to_text(vocabulary_to_json(vocabulary));
    const Vocabulary again = vocabulary_from_json(parse_json(text, "w"), "w");
    EXPECT_EQ(to_text(vocabulary_to_json(again)), text);
    // No data are lost: the same members, apart from lists of one element.
    EXPECT_NE(text.find("\"a note\""), std::string::npos);
    EXPECT_NE(text.find("\"above\": 2"), std::string::npos);
    EXPECT_EQ(again.concepts[6].others, vocabulary.concepts[6].others);
}

TEST(Vocabulary, InvalidInputIsRefused) {
    expect_error(changed("\"id\": \"nose\"", "\"id\": \"eye\""), "/concepts/4/id", "/concepts/1");
    expect_error(changed("\"broader\": \"head\",\n   \"attributes\": [{\"name\": \"height\", \"min\": 1",
                         "\"broader\": \"haed\",\n   \"attributes\": [{\"name\": \"height\", \"min\": 1"),
                 "/concepts/1/broader", "did you mean 'head'");
    expect_error(changed(R"("it": "testa"}, )", R"("it": "testa"}, "broader": "left eye", )"), "/broader", "-> 'head'");
    expect_error(changed(R"("broader": ["eye"])", R"("broader": "left eye")"), "/concepts/2/broader", "'left eye' -> 'left eye'");
    expect_error(changed(R"("broader": ["eye"])", R"("broader": ["eye", "eye"])"), "/concepts/2/broader", "twice");
    expect_error(changed(R"("min": 10, "max": 400)", R"("min": 400, "max": 10)"), "/concepts/0/attributes/0", "reversed");
    expect_error(changed(R"({"name": "remark"})", R"({"name": "Height "})"), "/concepts/0/attributes/1", "twice");
    expect_error(changed(R"("curly", "wavy", "straight"])", R"("curly", "wavy", "Wavy"])"), "/values/2", "twice");
    expect_error(changed(R"(["curly", "wavy", "straight"])", R"(["curly"], "min": 1)"), "/concepts/3/attributes/0", "keep one");
    expect_error(changed(R"("id": "nose")", R"("id": "")"), "/concepts/4/id", "at least 1 character");
    expect_error(changed(R"("id": "nose")", R"("id": "nose", "lable": "x")"), "/concepts/4", "unknown member 'lable'");
    expect_error(changed(R"("format": "ostraka-vocabulary")", R"("format": "ostraka-recipe")"), "/format", "ostraka-recipe");
    expect_error(changed(R"({"en": "head")", R"({"english!": "head")"), "/concepts/0/label", "not a language tag");
    expect_error(changed(R"("en": ["whiskers")", R"("en-": ["whiskers")"), "/concepts/3/alternatives", "not a language tag");
    expect_error("[]", "the root", "object");
}

TEST(Vocabulary, InvalidRulesAreRefused) {
    expect_error(changed(R"("id": "rough", "concept": "beard")", R"("id": "rough", "concept": "baerd")"), "/rules/1/concept",
                 "'beard'");
    expect_error(changed(R"("id": "rough")", R"("id": "smooth")"), "/rules/1/id", "smooth");
    expect_error(changed(R"("value": "curly")", R"("value": "curlie")"), "/rules/1/then/value", "did you mean 'curly'");
    expect_error(changed(R"("attribute": "beard style", "value": "curly")", R"("attribute": "style", "value": "curly")"),
                 "/rules/1/then/attribute", "not an attribute of");
    expect_error(changed(R"("attribute": "beard style", "value": "curly")", R"("attribute": "width", "value": "curly")"),
                 "/rules/1/then/attribute", "quantity");
    expect_error(changed(R"("min": 0.1, "max": 0.5)", R"("min": 0.6, "max": 0.5)"), "/rules/1/if/0", "no number");
    expect_error(changed(R"("min": 0.1, "max": 0.5)", R"("min": 0.5, "below": 0.5)"), "/rules/1/if/0", "no number");
    expect_error(changed(R"("min": 0.1, "max": 0.5)", R"("min": 0.1, "above": 0.2)"), "/rules/1/if/0", "one side");
    expect_error(changed(R"(, "min": 0.1, "max": 0.5)", ""), "/rules/1/if/0", "without bounds");
    expect_error(changed(R"("is": ["red", "reddish"])", R"("is": "red", "min": 1)"), "/rules/2/if/0", "bounds and words");
    expect_error(changed(R"("attribute": "bumpiness", "min": 0.1)", R"("min": 0.1)"), "/rules/1/if/0", "attribute or a ratio");
    expect_error(changed(R"("concept": "eye"}], "above": 2)", R"("concept": "eye"}], "above": 2, "unit": "mm")"), "/rules/1/if/1",
                 "no unit");
    expect_error(changed(R"("attribute": "remark", "is": ["red", "reddish"])", R"("attribute": "material", "is": "woad")"),
                 "/rules/2/if/0/is", "woad");
}

TEST(Vocabulary, AVeryLongChainIsNoStackOverflow) {
    Vocabulary vocabulary;
    for (int i = 0; i < 200000; ++i) {
        Concept entry;
        entry.id = std::to_string(i);
        if (i > 0) entry.broader = {std::to_string(i - 1)};
        vocabulary.concepts.push_back(std::move(entry));
    }
    ASSERT_NO_THROW(check_vocabulary(vocabulary, "v"));
    EXPECT_TRUE(VocabularySearch(vocabulary).is_a(199999, 0));
    vocabulary.concepts[0].broader = {"199999"};
    EXPECT_THROW(check_vocabulary(vocabulary, "v"), Error);
}

TEST(Vocabulary, TagsByIdAndByLabel) {
    const Vocabulary vocabulary = busts();
    const VocabularySearch search(vocabulary);
    const auto id = [&](const std::string& tag) {
        const auto concept_index = search.concept_of(tag);
        return concept_index ? vocabulary.concepts[*concept_index].id : std::string();
    };
    EXPECT_EQ(id("eye"), "eye");
    EXPECT_EQ(id("OCCHIO"), "eye");
    EXPECT_EQ(id(" left  Eye"), "left eye");
    EXPECT_EQ(id("Goatee"), "beard");
    EXPECT_EQ(id("eye 2"), "eye") << "a number tells parts of one kind apart";
    EXPECT_EQ(id("n2"), "n2");
    EXPECT_EQ(id("eye2"), "");
    EXPECT_EQ(id("2"), "");
    EXPECT_EQ(id(""), "");
    EXPECT_EQ(search.concepts_of("nase").size(), 2U);
    EXPECT_TRUE(search.is_a(2, 0));
    EXPECT_FALSE(search.is_a(0, 2));
    EXPECT_TRUE(search.is_a(6, 5)) << "two broader concepts";
    EXPECT_EQ(search.label(1, "it"), "occhio");
    EXPECT_EQ(search.label(4, "it"), "nose");
}

TEST(Vocabulary, AttributesAreInherited) {
    const Vocabulary vocabulary = busts();
    const VocabularySearch search(vocabulary);
    EXPECT_EQ(*search.attribute_of(2, "height")->max, 20.5) << "the nearer one";
    EXPECT_EQ(*search.attribute_of(3, "height")->max, 400);
    EXPECT_NE(search.attribute_of(3, "Tipo di barba"), nullptr);
    EXPECT_NE(search.attribute_of(2, "material"), nullptr);
    EXPECT_EQ(search.attribute_of(2, "beard style"), nullptr);
}

TEST(CheckAgainstVocabulary, KnownAndUnknownTags) {
    EXPECT_TRUE(defects(set_of({point(0, "head"), point(1, "Auge 1"), point(2, "whiskers")})).empty());
    EXPECT_EQ(only_defect(point(0, "bread")),
              "/annotations/0/tag the tag 'bread' is not in the vocabulary: did you mean 'head' or 'beard'?");
    EXPECT_TRUE(holds(only_defect(point(0, "Nase")), "is ambiguous between 'rock', 'n2'"));
    EXPECT_TRUE(holds(only_defect(point(0, "")), "not in the vocabulary"));
    EXPECT_TRUE(defects(set_of({})).empty());
}

TEST(CheckAgainstVocabulary, Words) {
    EXPECT_TRUE(defects(set_of({point(0, "beard",
                                      {word("beard style", "Wavy"), word("tipo di barba", "curly"), word("remark", "any text"),
                                       word("material", "Marmor")})}))
                    .empty());
    EXPECT_TRUE(holds(only_defect(point(0, "beard", {word("beard style", "curley")})), "did you mean 'curly'?"));
    EXPECT_TRUE(
        holds(only_defect(point(0, "beard", {word("beard style", "plaited")})), "its values are 'curly', 'wavy', 'straight'"));
    EXPECT_TRUE(holds(only_defect(point(0, "beard", {word("beard stile", "curly")})), "did you mean 'beard style'?"));
    EXPECT_TRUE(holds(only_defect(point(0, "nose", {word("beard style", "curly")})), "not among those of 'nose'"));
    EXPECT_TRUE(holds(only_defect(point(0, "beard", {word("width", "broad")})), "a quantity in the vocabulary"));
    EXPECT_TRUE(holds(only_defect(point(0, "beard", {quantity("beard style", 3, "")})), "a quantity here"));
}

TEST(CheckAgainstVocabulary, Quantities) {
    EXPECT_TRUE(defects(set_of({point(0, "eye", {quantity("height", 1.5, "cm")})})).empty());
    EXPECT_TRUE(
        holds(only_defect(point(0, "eye", {quantity("height", 2.5, "cm")})), "2.5 cm, outside its range of 1 to 20.5 mm"));
    EXPECT_TRUE(holds(only_defect(point(0, "eye", {quantity("height", 2.5, "mm^2")})), "cannot be converted"));
    EXPECT_TRUE(holds(only_defect(point(0, "beard", {quantity("bumpiness", -1, "1/mm")})), "0 1/mm or more"));
    Attribute list = quantity("height", 5, "mm");
    list.descriptor()->values = {5, 6, 77};
    EXPECT_TRUE(holds(only_defect(point(0, "eye", {list})), "77"));
    // Values that cannot be checked give remarks.
    Attribute stale = quantity("height", 999, "mm");
    stale.descriptor()->stale = true;
    const AnnotationSet doubtful = set_of({point(0, "eye", {stale, quantity("height", 999, ""), quantity("roundness", 1, "")})});
    EXPECT_TRUE(defects(doubtful).empty());
    EXPECT_EQ(check_against_vocabulary(doubtful, busts()).size(), 3U);
    EXPECT_TRUE(holds(only_defect(point(0, "eye", {quantity("roundness", 1, "")}), {.strict = true}), "'roundness'"));
}

TEST(CheckAgainstVocabulary, RangesApplyToMeasures) {
    Attribute measure;
    measure.name = "height";
    measure.value = Measure();
    measure.measure()->unit = "mm";
    measure.measure()->value = 25;
    EXPECT_TRUE(holds(only_defect(point(0, "eye", {measure})), "25 mm, outside"));
    measure.measure()->value.reset();
    EXPECT_TRUE(defects(set_of({point(0, "eye", {measure})})).empty());
    try {
        require_vocabulary(set_of({point(7, "ey"), point(8, "ee")}), busts(), "r.json");
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_TRUE(holds(error.what(), "r.json: annotation 7: the tag 'ey'")) << error.what();
        EXPECT_TRUE(holds(error.what(), "and 1 more")) << error.what();
    }
}

TEST(Vocabulary, ExamineReportsAmbiguities) {
    const auto text_of = [](const Vocabulary& vocabulary) {
        std::string text;
        for (const auto& finding : examine(vocabulary)) {
            EXPECT_FALSE(finding.defect);
            text += finding.text + "\n";
        }
        return text;
    };
    std::string text = text_of(busts());
    EXPECT_TRUE(holds(text, "the label 'Nase' belongs to 'rock', 'n2'")) << text;
    EXPECT_TRUE(holds(text, "'left eye' has no label in de, it")) << text;
    EXPECT_FALSE(holds(text, "can both hold")) << text;
    Vocabulary clash = busts();
    clash.rules[0].conditions[0].max = 0.2;
    clash.rules[0].conditions[0].below.reset();
    text = text_of(clash);
    EXPECT_TRUE(holds(text, "the rules 'smooth' and 'rough' can both hold, and infer 'straight' and 'curly' for 'beard style'"))
        << text;
    clash.rules[0].conditions[0].unit = "1/m";
    clash.rules[1].conditions[0].unit = "1/mm";
    EXPECT_FALSE(holds(text_of(clash), "can both hold")) << "0.2 per m is far less than 0.1 per mm";
    clash.concepts[0].labels.clear();
    EXPECT_TRUE(holds(text_of(clash), "'head' has no label"));
}
