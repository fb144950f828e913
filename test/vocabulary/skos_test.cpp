#include "ostraka/vocabulary/skos.h"

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

std::string text_of(const Vocabulary& vocabulary) { return to_text(vocabulary_to_json(vocabulary)); }

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

void expect_error(const std::string& text, bool xml, const std::string& place, const std::string& words) {
    try {
        vocabulary_from_skos(text, xml, "v.ttl");
        ADD_FAILURE() << "not refused: " << words;
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_TRUE(std::string(error.what()).starts_with(place)) << error.what();
        EXPECT_TRUE(holds(error.what(), words)) << error.what();
        EXPECT_FALSE(error.remedy().empty()) << error.what();
    }
}

const std::string head = "@prefix skos: <http://www.w3.org/2004/02/skos/core#> .\n@prefix ex: <https://example.org/things/> .\n";

std::string xml(const std::string& type, const std::string& label) {
    return "<?xml version=\"1.0\"?>\n" + type +
           "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\" "
           "xmlns:skos=\"http://www.w3.org/2004/02/skos/core#\">\n"
           "<skos:Concept rdf:about=\"http://example.org/a\"><skos:prefLabel xml:lang=\"en\">" +
           label + "</skos:prefLabel></skos:Concept></rdf:RDF>\n";
}

}  // namespace

TEST(Skos, RoundTripKeepsEverything) {
    Vocabulary vocabulary = busts();
    vocabulary.concepts[4].labels["en-GB"] = "nose \"quoted\" \\ back\nnew line\ttab <b>&amp;</b> ]]> \xC3\xB6 \xF0\x9F\x91\x83";
    vocabulary.concepts[4].uri = "http://vocab.example/aat/300264";
    vocabulary.concepts[0].attributes[0].min = 0.1 + 0.2;
    vocabulary.concepts[2].id = "left eye/#%20 \xC3\xA4 \"";
    vocabulary.concepts[3].attributes[0].values[1].labels = {{"de", "wellig"}, {"", "wavy"}};
    for (const bool titled : {true, false}) {
        if (!titled) vocabulary.title.clear(), vocabulary.uri.clear();
        for (const bool rdf_xml : {false, true}) {
            const std::string text = vocabulary_to_skos(vocabulary, rdf_xml, "v");
            const Vocabulary again = vocabulary_from_skos(text, rdf_xml, "v");
            EXPECT_EQ(text_of(again), text_of(vocabulary)) << text;
            EXPECT_TRUE(again.notes.empty());
            EXPECT_EQ(vocabulary_to_skos(again, rdf_xml, "v"), text) << "to the byte";
        }
    }
    // An empty vocabulary has no notes.
    EXPECT_THROW(vocabulary_from_skos(vocabulary_to_skos({}, false, "v"), false, "v"), Error);
}

TEST(Skos, TheVocabularyOfTheProject) {
    const Vocabulary vocabulary = read_vocabulary(OSTRAKA_SOURCE_DIR "/data/terracotta.vocabulary.json");
    EXPECT_GT(vocabulary.concepts.size(), 50U);
    for (const bool rdf_xml : {false, true})
        EXPECT_EQ(text_of(vocabulary_from_skos(vocabulary_to_skos(vocabulary, rdf_xml, "v"), rdf_xml, "v")), text_of(vocabulary));
}

TEST(Skos, FilesOfOtherToolsAreRead) {
    const Vocabulary vocabulary = vocabulary_from_skos(head + R"(
@prefix dct: <http://purl.org/dc/terms/> .
ex:scheme a skos:ConceptScheme ; dct:title "Things"@en, "Dinge"@de ; skos:hasTopConcept ex:object ; dct:creator [ dct:title "somebody" ] .
ex:object a skos:Concept ; skos:topConceptOf ex:scheme ; skos:prefLabel "object"@en ; skos:narrower ex:vase .
ex:vase a skos:Concept ; skos:inScheme ex:scheme ; skos:prefLabel "vase"@en, "Vase"@de ; skos:altLabel "amphora"@en ;
  skos:notation "V1" ; skos:related <http://elsewhere.example/pot> ; skos:broader <http://elsewhere.example/thing> ;
  skos:definition "holds flowers"@en, "or wine"@en ; skos:scopeNote "wide"@en .
ex:other a skos:Concept ; skos:inScheme <https://example.org/another> ; skos:prefLabel "of another scheme"@en .
<https://example.org/elsewhere#lip> a skos:Concept ; skos:broader ex:vase ; skos:prefLabel "lip" .
)",
                                                       false, "v");
    EXPECT_EQ(vocabulary.uri, "https://example.org/things/scheme");
    EXPECT_EQ(vocabulary.title.at("de"), "Dinge");
    ASSERT_EQ(vocabulary.concepts.size(), 3U) << text_of(vocabulary);
    const Concept& vase = vocabulary.concepts[1];
    EXPECT_EQ(vase.id, "vase");
    EXPECT_EQ(vase.uri, "https://example.org/things/vase");
    EXPECT_EQ(vase.broader, std::vector<std::string>{"object"}) << "narrower is broader read the other way";
    EXPECT_EQ(vase.definition.at("en"), "holds flowers");
    EXPECT_EQ(vase.others.size(), 5U) << "notation, related, broader elsewhere, a second definition, scopeNote";
    EXPECT_EQ(vocabulary.concepts[2].id, "lip");
    ASSERT_EQ(vocabulary.notes.size(), 3U);
    EXPECT_TRUE(holds(vocabulary.notes[0], "1 concept of other schemes"));
    EXPECT_TRUE(holds(vocabulary.notes[1], "creator"));
    // Kept statements are written again.
    EXPECT_TRUE(holds(vocabulary_to_skos(vocabulary, false, "v"), "http://elsewhere.example/pot"));
    const std::string two =
        head + "ex:a a skos:ConceptScheme . ex:b a skos:ConceptScheme . ex:c a skos:Concept ; skos:inScheme ex:b .";
    expect_error(two, false, "v.ttl: ", "2 concept schemes");
    EXPECT_EQ(vocabulary_from_skos(two, false, "v", "https://example.org/things/b").concepts.size(), 1U);
    EXPECT_THROW(vocabulary_from_skos(two, false, "v", "https://example.org/things/c"), Error);
}

TEST(Skos, DroppedDataAreReported) {
    const Vocabulary vocabulary = vocabulary_from_skos(head + R"(
@prefix xl: <http://www.w3.org/2008/05/skos-xl#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
ex:scheme a skos:ConceptScheme .
ex:vase a skos:Concept ; skos:inScheme ex:scheme ; skos:prefLabel "vase"^^xsd:string, "Vase"@de ; xl:prefLabel ex:label .
ex:label a xl:Label ; xl:literalForm "vase"@en .
ex:jug a skos:Concept ; skos:inScheme ex:scheme ; skos:prefLabel "jug"@en .
ex:cup a skos:Concept ; skos:inScheme ex:scheme ; skos:prefLabel "cup"@en .
ex:shapes a skos:Collection ; skos:prefLabel "by shape"@en ; skos:member ex:vase, ex:jug .
[] a skos:OrderedCollection ; skos:memberList ( ex:cup ex:jug ex:vase ) .
ex:somebody <http://xmlns.com/foaf/0.1/name> "somebody" .
)",
                                                       false, "v");
    ASSERT_EQ(vocabulary.concepts.size(), 3U);
    EXPECT_EQ(vocabulary.concepts[0].labels, (Labels{{"", "vase"}, {"de", "Vase"}})) << "a text with its datatype is a text";
    ASSERT_EQ(vocabulary.notes.size(), 3U);
    EXPECT_TRUE(holds(vocabulary.notes[0], "2 collections with 5 members not kept: 'by shape', an unnamed collection"))
        << vocabulary.notes[0];
    EXPECT_TRUE(holds(vocabulary.notes[1], "1 label of SKOS-XL")) << vocabulary.notes[1];
    EXPECT_TRUE(holds(vocabulary.notes[2], "1 resource")) << vocabulary.notes[2];
}

TEST(Skos, ParseErrorsNameTheLine) {
    expect_error(head + "ex:a a skos:Concept ;\n  skos:prefLabel \"a\"@en\nex:b a skos:Concept .\n", false,
                 "v.ttl, line 5: not valid Turtle", "syntax error");
    expect_error(head + "ex:a a skos:Concept ;\n  skos:prefLabel \"a@en .\n", false, "v.ttl, line ", "not valid Turtle");
    expect_error(head + "ex:a sk:b ex:c .\n", false, "v.ttl, line 3: not valid Turtle", "sk:");
    expect_error(head, false, "v.ttl: ", "no SKOS concept");
    expect_error("", false, "v.ttl: ", "no SKOS concept");
    expect_error(std::string(head + "ex:a a \xFFskos:Concept ."), false, "v.ttl, line 3", "UTF-8");
    expect_error(xml("", "a").substr(0, 200), true, "v.ttl, line 3: not valid RDF/XML", "");
    expect_error("", true, "v.ttl", "not valid RDF/XML");
    expect_error(head + "ex:a a skos:Concept ; skos:broader ex:b . ex:b a skos:Concept ; skos:broader ex:a .", false,
                 "v.ttl: ", "broader than itself");
    expect_error(head + "@prefix o: <urn:ostraka:ns#> . ex:a a skos:Concept ; o:attribute [ o:unit \"mm\" ] .", false,
                 "v.ttl: ", "without a name");
    expect_error(head + "@prefix o: <urn:ostraka:ns#> . ex:a a skos:Concept ; o:attribute [ o:name \"h\" ; o:minimum \"nan\" ] .",
                 false, "v.ttl: ", "not a number");
    expect_error(head + "@prefix o: <urn:ostraka:ns#> . ex:s a skos:ConceptScheme ; o:rules \"[{]\" . ex:a a skos:Concept .",
                 false, "v.ttl, ostraka:rules", "JSON");
}

TEST(Skos, MaliciousFilesAreRefusedOrHarmless) {
    const Scratch scratch;
    const std::string secret = scratch.file("secret", "the secret").string();
    expect_error(xml("<!DOCTYPE r [<!ENTITY x SYSTEM \"file://" + secret + "\">]>\n", "&x;"), true, "v.ttl, line 2",
                 "another file");
    expect_error(xml("<!DOCTYPE r SYSTEM \"http://example.org/x.dtd\">\n", "a"), true, "v.ttl, line 2", "another file");
    expect_error(xml("<!DOCTYPE r [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;\">]>\n", "&b;"), true, "v.ttl, line 2",
                 "contains other entities");
    expect_error(xml("<!DOCTYPE r [<!ENTITY % a \"ha\"> %a;]>\n", "a"), true, "v.ttl, line 2", "contains other entities");
    expect_error(xml("<!DOCTYPE r [<!ENTITY a \"" + std::string(5000, 'a') + "\">]>\n", "&a;"), true, "v.ttl, line 2",
                 "1000 bytes");
    expect_error("<?xml version=\"1.0\" encoding=\"UTF-7\"?>\n<a/>", true, "v.ttl, line 1", "UTF-8");
    EXPECT_EQ(vocabulary_from_skos(xml("<!DOCTYPE r [<!ENTITY a \"short for\">]>\n", "&a; this"), true, "v")
                  .concepts[0]
                  .labels.at("en"),
              "short for this")
        << "plain entities are common";
    // Deep nesting, and one text of eight million letters.
    std::string deep = head + "ex:a skos:related ";
    for (int i = 0; i < 20000; ++i) deep += "[ skos:related ";
    expect_error(deep, false, "v.ttl", "not valid Turtle");
    std::string nested = xml("", "a");
    const std::string inner = "<rdf:Description><skos:related>", outer = "</skos:related></rdf:Description>";
    std::string tower;
    for (int i = 0; i < 50000; ++i) tower += inner;
    for (int i = 0; i < 50000; ++i) tower += outer;
    nested.insert(nested.find("<skos:prefLabel"), "<skos:related>" + tower + "</skos:related>");
    expect_error(nested, true, "v.ttl, line 3", "deeper than 1000");
    EXPECT_THROW(vocabulary_from_skos(head + "ex:a skos:related " + std::string(200000, '(') + std::string(200000, ')') + " .",
                                      false, "v"),
                 Error);
    const std::string huge(8000000, 'x');
    EXPECT_EQ(vocabulary_from_skos(head + "ex:a a skos:Concept ; skos:prefLabel \"" + huge + "\" .", false, "v")
                  .concepts[0]
                  .labels.at(""),
              huge);
    // Relative URIs lead nowhere.
    EXPECT_NO_THROW(
        vocabulary_from_skos(head + "<../../../../../../a/./../b?c#d> a skos:Concept . <#x> a skos:Concept .", false, "v"));
}

TEST(Skos, FilesOfManyMegabytes) {
    Vocabulary vocabulary = busts();
    for (int i = 0; i < 12; ++i) {
        Concept entry;
        entry.id = "large " + std::to_string(i);
        entry.definition["en"] = std::string(1000000, static_cast<char>('a' + i));
        vocabulary.concepts.push_back(std::move(entry));
    }
    for (const bool rdf_xml : {false, true})
        EXPECT_TRUE(text_of(vocabulary_from_skos(vocabulary_to_skos(vocabulary, rdf_xml, "v"), rdf_xml, "v")) ==
                    text_of(vocabulary));
}

TEST(Skos, TextThatRdfCannotStoreIsRefused) {
    Vocabulary vocabulary = busts();
    vocabulary.concepts[0].labels["en"] = std::string("a\x01") + "b";
    EXPECT_THROW(vocabulary_to_skos(vocabulary, true, "v"), Error);
    EXPECT_EQ(text_of(vocabulary_from_skos(vocabulary_to_skos(vocabulary, false, "v"), false, "v")), text_of(vocabulary));
    vocabulary = busts();
    vocabulary.uri = "no uri";
    EXPECT_THROW(vocabulary_to_skos(vocabulary, false, "v"), Error);
    vocabulary = busts();
    vocabulary.concepts[6].others[0].property = "http://example.org/> . <http://example.org/injected";
    EXPECT_THROW(vocabulary_to_skos(vocabulary, false, "v"), Error);
    vocabulary.concepts[6].others[0].property = "http://example.org/123";
    EXPECT_THROW(vocabulary_to_skos(vocabulary, true, "v"), Error) << "no XML name";
}

TEST(Skos, DamagedFiles) {
    const Vocabulary vocabulary = busts();
    for (const bool rdf_xml : {false, true}) {
        const std::string text = vocabulary_to_skos(vocabulary, rdf_xml, "v");
        std::size_t read = 0;
        for (std::uint64_t seed = 0; seed < 200; ++seed) {
            try {
                text_of(vocabulary_from_skos(mutate(text, seed), rdf_xml, "v"));
                ++read;
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
                EXPECT_FALSE(error.problem().empty());
            }
        }
        EXPECT_LT(read, 200U);
    }
    std::size_t read = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        try {
            const Vocabulary damaged = vocabulary_from_json(parse_json(mutate(bust_vocabulary, seed), "v"), "v");
            examine(damaged);
            check_against_vocabulary(set_of({point(0, "eye", {quantity("height", 5, "mm")})}), damaged);
            ++read;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
        }
    }
    EXPECT_LT(read, 200U);
}

TEST(VocabularyCommand, ConvertRoundTrip) {
    const Scratch scratch;
    const auto at = [&](const std::string& name) { return (scratch / name).string(); };
    const std::string words = OSTRAKA_SOURCE_DIR "/data/terracotta.vocabulary.json";
    ASSERT_EQ(run_command("vocabulary convert " + words + " " + at("a.ttl")).code, 0);
    ASSERT_EQ(run_command("vocabulary convert " + at("a.ttl") + " " + at("b.rdf")).code, 0);
    ASSERT_EQ(run_command("vocabulary convert " + at("b.rdf") + " " + at("c.vocabulary.json")).code, 0);
    EXPECT_EQ(read_file(scratch / "c.vocabulary.json"), read_file(words));
    EXPECT_EQ(run_command("vocabulary check " + at("a.ttl")).code, 0);
    const auto bad =
        run_command("vocabulary convert " + scratch.file("bad.ttl", head + "ex:a a\n").string() + " " + at("c.vocabulary.json"));
    EXPECT_EQ(bad.code, 1);
    EXPECT_TRUE(holds(bad.err, "bad.ttl, line ")) << bad.err;
    EXPECT_EQ(read_file(scratch / "c.vocabulary.json"), read_file(words)) << "untouched";
    EXPECT_EQ(run_command("vocabulary check " + at("bad.ttl")).code, 1);
    // The input contains text that RDF cannot represent.
    const std::string control = R"({"format": "ostraka-vocabulary", "version": 1, "concepts": [{"id": "a", "label": "\u0001"}]})";
    const auto unfit =
        run_command("vocabulary convert " + scratch.file("odd.vocabulary.json", control).string() + " " + at("o.rdf"));
    EXPECT_EQ(unfit.code, 1);
    EXPECT_TRUE(holds(unfit.err, "ostraka: " + at("odd.vocabulary.json") + ": a text contains a control")) << unfit.err;
    EXPECT_EQ(run_command("vocabulary convert " + words + " " + at("x.txt")).code, 2);
    EXPECT_EQ(run_command("vocabulary convert " + at("a.ttl") + " " + at("a.ttl")).code, 2);
    EXPECT_EQ(run_command("vocabulary convert " + words + " " + at("y.ttl") + " --scheme urn:x").code, 2);
    const std::string data = OSTRAKA_SOURCE_DIR "/data/";
    EXPECT_EQ(run_command("annotation check " + data + "vase.ply " + data + "vase.ant.json --vocabulary " + at("a.ttl")).code, 0);
}

TEST(Skos, ShortFilesThatExpandWithoutLimitAreRefused) {
    // A long prefix and a short entity, each referenced often.
    std::string turtle = head + "@prefix long: <https://example.org/" + std::string(200'000, 'a') + "/> .\n";
    for (int i = 0; i < 3000; ++i) turtle += "long:a" + std::to_string(i) + " a skos:Concept .\n";
    expect_error(turtle, false, "v.ttl", "many times the size of the file");
    std::string label;
    for (int i = 0; i < 60'000; ++i) label += "&e;";
    expect_error(xml("<!DOCTYPE rdf:RDF [<!ENTITY e \"" + std::string(900, 'x') + "\">]>", label), true, "v.ttl, line 3",
                 "entities expand to many times the size");
}
