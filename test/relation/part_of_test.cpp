// Wholes and parts of a vocabulary, compared with the selections.
#include "ostraka/relation/part_of.h"
#include "meshes.h"
#include "ostraka/core/error.h"
#include "ostraka/vocabulary/skos.h"

#include <gtest/gtest.h>

#include <numeric>

using namespace ostraka;
using namespace ostraka::test;

namespace {

const char* const face = R"({"format": "ostraka-vocabulary", "version": 1, "uri": "https://example.org/face", "concepts": [
    {"id": "head", "label": {"en": "head", "de": "Kopf"}},
    {"id": "face", "label": {"en": "face"}, "partOf": "head"},
    {"id": "feature", "label": {"en": "feature"}, "partOf": "face"},
    {"id": "nose", "label": {"en": "nose", "it": "naso"}, "broader": "feature"},
    {"id": "hand", "label": {"en": "hand"}}]})";

Vocabulary vocabulary() { return vocabulary_from_json(parse_json(face, "face"), "face"); }

Annotation region(int id, const std::string& tag, Index first, Index last) {
    Annotation annotation;
    annotation.id = id;
    annotation.tag = tag;
    annotation.faces.resize(last - first);
    std::iota(annotation.faces.begin(), annotation.faces.end(), first);
    return annotation;
}

}  // namespace

TEST(PartOf, IsInheritedAndTransitive) {
    const Vocabulary concepts = vocabulary();
    const VocabularySearch search(concepts);
    const auto levels = search.containing_concepts(*search.find("nose"));
    ASSERT_EQ(levels.size(), 2U);
    EXPECT_EQ(concepts.concepts[levels[0].at(0)].id, "face");
    EXPECT_EQ(concepts.concepts[levels[1].at(0)].id, "head");
    EXPECT_TRUE(search.containing_concepts(*search.find("hand")).empty());
}

TEST(PartOf, PartsLieInTheirWholes) {
    const Mesh mesh = build_mesh(torus(20, 10));
    AnnotationSet set;
    set.annotations = {region(1, "Kopf", 0, 100), region(2, "naso 1", 10, 20), region(3, "nose 2", 150, 160),
                       region(4, "hand", 200, 210), region(5, "face", 0, 50)};
    const auto findings = check_parts({mesh, set}, vocabulary());
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_TRUE(findings[0].defect);
    EXPECT_EQ(findings[0].where, "/annotations/2");
    EXPECT_NE(findings[0].text.find("face"), std::string::npos);  // the nearest whole that is annotated
    const auto relations = part_relationships(topology({mesh, set}).order, set, vocabulary(), 7);
    ASSERT_EQ(relations.size(), 2U);
    EXPECT_EQ(relations[0].annotations, (std::vector<int>{5, 2}));  // the nose in the face, which is nearer than the head
    EXPECT_EQ(relations[0].id, 7);
    EXPECT_EQ(relations[1].annotations, (std::vector<int>{1, 5}));
    for (const Relationship& relationship : relations) check_relationship(relationship, set, "extracted");
}

TEST(PartOf, TheSmallestContainingWholeIsUsed) {
    const Mesh mesh = build_mesh(torus(20, 10));
    AnnotationSet set;
    set.annotations = {region(1, "head", 0, 200), region(2, "head", 0, 100), region(3, "nose", 10, 20),
                       region(4, "head", 300, 310)};
    const auto relations = part_relationships(topology({mesh, set}).order, set, vocabulary(), 0);
    ASSERT_EQ(relations.size(), 1U);
    EXPECT_EQ(relations[0].annotations, (std::vector<int>{2, 3}));
}

TEST(PartOf, SkosRoundTripIsExact) {
    const Vocabulary original = vocabulary();
    for (const bool xml : {false, true}) {
        const Vocabulary back = vocabulary_from_skos(vocabulary_to_skos(original, xml, "face"), xml, "face");
        EXPECT_EQ(to_text(vocabulary_to_json(back)), to_text(vocabulary_to_json(original)));
    }
    const std::string narrower =
        "@prefix skos: <http://www.w3.org/2004/02/skos/core#> .\n@prefix t: <http://purl.org/iso25964/skos-thes#> .\n"
        "@prefix ex: <https://example.org/> .\n"
        "ex:s a skos:ConceptScheme .\n"
        "ex:head a skos:Concept ; skos:inScheme ex:s ; t:narrowerPartitive ex:nose .\n"
        "ex:nose a skos:Concept ; skos:inScheme ex:s .\n";
    const Vocabulary read = vocabulary_from_skos(narrower, false, "v.ttl");
    const VocabularySearch search(read);
    const auto nose = search.concept_of("nose");
    ASSERT_TRUE(nose);
    EXPECT_EQ(search.containing_concepts(*nose).size(), 1U);
}

TEST(PartOf, RefusesMissingConcepts) {
    std::string text = face;
    text.replace(text.find("\"partOf\": \"head\""), 16, "\"partOf\": \"haed\"");
    EXPECT_THROW((void)vocabulary_from_json(parse_json(text, "face"), "face"), Error);
    text = face;
    text.replace(text.find("\"partOf\": \"head\""), 16, "\"partOf\": \"face\"");
    EXPECT_THROW((void)vocabulary_from_json(parse_json(text, "face"), "face"), Error);
}
