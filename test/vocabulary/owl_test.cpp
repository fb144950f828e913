#include "ostraka/core/error.h"
#include "ostraka/vocabulary/skos.h"
#include "ostraka/vocabulary/tag_matcher.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace ostraka;

namespace {

const std::string prefixes = R"(
@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix obo: <http://purl.obolibrary.org/obo/> .
@prefix : <https://example.org/pots#> .
<https://example.org/pots> a owl:Ontology ; rdfs:label "Pots"@en .
)";

Vocabulary read(const std::string& text) { return vocabulary_from_skos(prefixes + text, false, "pots.ttl"); }

const Concept& concept_of(const Vocabulary& vocabulary, const std::string& id) {
    const auto match = std::find_if(vocabulary.concepts.begin(), vocabulary.concepts.end(),
                                    [&](const Concept& candidate) { return candidate.id == id; });
    if (match == vocabulary.concepts.end()) throw std::runtime_error("no concept " + id);
    return *match;
}

using Names = std::vector<std::string>;

}  // namespace

TEST(Owl, ClassesBecomeConceptsAndRestrictionsParts) {
    const Vocabulary vocabulary = read(R"(
:partOf a owl:ObjectProperty .
:Pot a owl:Class ; rdfs:label "pot"@en, "vaso"@it ; rdfs:comment "A vessel."@en .
:Handle a owl:Class ; rdfs:label "handle"@en, "ansa"@it ;
    rdfs:subClassOf [ a owl:Restriction ; owl:onProperty :partOf ; owl:someValuesFrom :Pot ] .
:Lug a owl:Class ; rdfs:label "lug"@en ; rdfs:subClassOf :Handle, owl:Thing .
)");
    EXPECT_EQ(vocabulary.uri, "https://example.org/pots");
    EXPECT_EQ(vocabulary.title.at("en"), "Pots");
    ASSERT_EQ(vocabulary.concepts.size(), 3U);
    EXPECT_EQ(concept_of(vocabulary, "Pot").labels.at("it"), "vaso");
    EXPECT_EQ(concept_of(vocabulary, "Pot").definition.at("en"), "A vessel.");
    EXPECT_EQ(concept_of(vocabulary, "Handle").part_of, Names{"Pot"});
    EXPECT_EQ(concept_of(vocabulary, "Lug").broader, Names{"Handle"});
    EXPECT_TRUE(vocabulary.notes.empty()) << vocabulary.notes.front();
    EXPECT_TRUE(TagMatcher(&vocabulary).means("lug", "ansa"));
    // The result is an ordinary vocabulary: the round trip is exact.
    const Vocabulary again = vocabulary_from_skos(vocabulary_to_skos(vocabulary, false, "v.ttl"), false, "v.ttl");
    EXPECT_EQ(concept_of(again, "Handle").part_of, Names{"Pot"});
}

TEST(Owl, PartPropertiesByNameLabelOrderAndInverse) {
    const Vocabulary vocabulary = read(R"(
obo:BFO_0000050 a owl:ObjectProperty .
:r1 a owl:ObjectProperty ; rdfs:label "is part of"@en .
:r2 a owl:ObjectProperty ; rdfs:subPropertyOf :regional_part_of .
:regional_part_of a owl:ObjectProperty .
:r3 a owl:ObjectProperty ; owl:inverseOf :r1 .
:hasComponentPart a owl:ObjectProperty .
:near a owl:ObjectProperty .
:Pot a owl:Class ; rdfs:subClassOf [ a owl:Restriction ; owl:onProperty :r3 ; owl:someValuesFrom :E ],
    [ a owl:Restriction ; owl:onProperty :hasComponentPart ; owl:someValuesFrom :F ] .
:A a owl:Class ; rdfs:subClassOf [ a owl:Restriction ; owl:onProperty obo:BFO_0000050 ; owl:someValuesFrom :Pot ] .
:B a owl:Class ; rdfs:subClassOf [ a owl:Restriction ; owl:onProperty :r1 ; owl:someValuesFrom :Pot ] .
:C a owl:Class ; rdfs:subClassOf [ a owl:Restriction ; owl:onProperty :r2 ; owl:someValuesFrom :Pot ] .
:D a owl:Class ; owl:equivalentClass [ owl:intersectionOf ( :A [ a owl:Restriction ; owl:onProperty :r1 ; owl:someValuesFrom :B ] ) ] .
:E a owl:Class . :F a owl:Class .
:G a owl:Class ; rdfs:subClassOf [ a owl:Restriction ; owl:onProperty :near ; owl:someValuesFrom :Pot ],
    [ a owl:Restriction ; owl:onProperty :r1 ; owl:allValuesFrom :Pot ], [ owl:unionOf ( :A :B ) ] .
:H a owl:Class ; owl:deprecated true ; rdfs:subClassOf :A .
)");
    for (const char* part : {"A", "B", "C", "E", "F"}) EXPECT_EQ(concept_of(vocabulary, part).part_of, Names{"Pot"}) << part;
    EXPECT_EQ(concept_of(vocabulary, "D").broader, Names{"A"});
    EXPECT_EQ(concept_of(vocabulary, "D").part_of, Names{"B"});
    EXPECT_TRUE(concept_of(vocabulary, "G").part_of.empty());
    EXPECT_EQ(vocabulary.concepts.size(), 8U);
    ASSERT_EQ(vocabulary.notes.size(), 2U);
    EXPECT_NE(vocabulary.notes[0].find("1 deprecated"), std::string::npos);
    EXPECT_NE(vocabulary.notes[1].find("3 statements about classes not kept"), std::string::npos) << vocabulary.notes[1];
}

TEST(Owl, SkosFilesStayAsTheyAre) {
    const Vocabulary vocabulary = read(R"(
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
:handle a skos:Concept ; skos:prefLabel "handle"@en .
:Kind a owl:Class ; rdfs:label "kind"@en .
)");
    ASSERT_EQ(vocabulary.concepts.size(), 1U);
    EXPECT_EQ(vocabulary.concepts[0].id, "handle");
}

TEST(Owl, InvalidAndHostileFilesGiveAnErrorOrAVocabulary) {
    EXPECT_THROW(read(""), Error);
    EXPECT_THROW(read(":a a owl:Class ; rdfs:subClassOf :b . :b a owl:Class ; rdfs:subClassOf :a ."), Error);  // a cycle
    // Lists and intersections that contain themselves.
    EXPECT_EQ(read(":a a owl:Class ; rdfs:subClassOf _:x . _:x owl:intersectionOf _:l . _:l rdf:first _:x ; rdf:rest _:l ;"
                   " owl:onProperty :partOf . _:x owl:onProperty :partOf ; owl:someValuesFrom :a .")
                  .concepts.size(),
              1U);
    EXPECT_EQ(read(":p owl:inverseOf :p . :partOf rdfs:subPropertyOf :partOf . :a a owl:Class ; rdfs:label 5 .").concepts.size(),
              1U);
    std::string deep;
    for (int i = 0; i < 2000; ++i)
        deep += ":c" + std::to_string(i) + " a owl:Class ; rdfs:subClassOf :c" + std::to_string(i + 1) + " .\n";
    EXPECT_EQ(read(deep + ":c2000 a owl:Class .").concepts.size(), 2001U);
}
