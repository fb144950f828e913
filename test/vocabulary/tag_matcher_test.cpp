// Tags that a word denotes.
#include "ostraka/vocabulary/tag_matcher.h"
#include "ostraka/core/error.h"

#include <gtest/gtest.h>

using namespace ostraka;

namespace {

Vocabulary parts() {
    return vocabulary_from_json(
        parse_json(R"({"format": "ostraka-vocabulary", "version": 1, "uri": "http://example.org/parts", "concepts": [
        {"id": "handle", "label": {"en": "handle", "it": "manico", "de": "Henkel"}, "alternatives": {"en": ["handles"]}},
        {"id": "grip", "label": {"en": "grip"}, "broader": ["handle"]},
        {"id": "spout", "label": {"en": "spout", "it": "beccuccio"}}]})",
                   "test"),
        "test");
}

AnnotationSet tagged(const std::vector<std::string>& tags) {
    AnnotationSet set;
    for (std::size_t i = 0; i < tags.size(); ++i) {
        Annotation annotation;
        annotation.id = static_cast<int>(10 + i);
        annotation.tag = tags[i];
        set.annotations.push_back(annotation);
    }
    return set;
}

using Places = std::vector<std::size_t>;

}  // namespace

TEST(TagMatcher, WithoutAVocabularyCompareLiterally) {
    const TagMatcher words;
    EXPECT_TRUE(words.means("Flower 3", "flower"));
    EXPECT_TRUE(words.means("flower", " FLOWER "));
    EXPECT_FALSE(words.means("flower", "flower 3"));
    EXPECT_FALSE(words.means("manico", "handle"));
    EXPECT_EQ(words.key("Flower  3"), words.key("flower 3"));
    EXPECT_NE(words.key("flower 3"), words.key("flower 4"));
}

TEST(TagMatcher, WithAVocabularyCompareConcepts) {
    const Vocabulary vocabulary = parts();
    const TagMatcher words(&vocabulary);
    EXPECT_TRUE(words.means("manico", "handle"));
    EXPECT_TRUE(words.means("Henkel 2", "handles"));
    EXPECT_TRUE(words.means("grip", "manico"));   // narrower
    EXPECT_FALSE(words.means("manico", "grip"));  // broader
    EXPECT_FALSE(words.means("spout", "handle"));
    EXPECT_TRUE(words.means("crack 4", "crack"));  // not in the vocabulary: compared literally
    EXPECT_EQ(words.key("manico 2"), words.key("handle 2"));
    EXPECT_NE(words.key("manico 2"), words.key("handle 3"));
    EXPECT_NE(words.key("grip"), words.key("handle"));
}

TEST(TagMatcher, FindAnnotationsByIdTagOrMeaning) {
    const AnnotationSet set = tagged({"manico 1", "Handle 2", "spout", "10"});
    EXPECT_EQ(TagMatcher().find(set, "10"), Places{0});  // ids have priority
    EXPECT_EQ(TagMatcher().find(set, "handle"), Places{1});
    EXPECT_EQ(TagMatcher().find(set, "manico"), Places{0});
    EXPECT_EQ(TagMatcher().find(set, "lid"), Places{});
    const Vocabulary vocabulary = parts();
    EXPECT_EQ(TagMatcher(&vocabulary).find(set, "handle"), (Places{0, 1}));
    try {
        (void)TagMatcher().require(set, "spuot", "pot.ant.json");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.where(), "pot.ant.json");
        EXPECT_NE(error.remedy().find("spout"), std::string::npos);
    }
}
