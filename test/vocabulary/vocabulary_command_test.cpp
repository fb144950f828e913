// The built command, as people run it.
#include "ostraka/io/mesh_file.h"
#include "scratch.h"
#include "vocabulary/vocabulary_examples.h"

#include <gtest/gtest.h>

using namespace ostraka;
using namespace ostraka::example;
using ostraka::test::run_command;
using ostraka::test::Scratch;

namespace {

const std::string data = OSTRAKA_SOURCE_DIR "/data/";
const std::string words = data + "terracotta.vocabulary.json";

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST(VocabularyCommand, Check) {
    const Scratch scratch;
    const auto good = run_command("vocabulary check " + words);
    EXPECT_EQ(good.code, 0) << good.out << good.err;
    EXPECT_TRUE(holds(good.out, "no defects"));
    std::string text = bust_vocabulary;
    text.replace(text.find("\"it\": \"testa\"}"), 14, "\"it\": \"testa\"}, \"broader\": \"beard\"");
    const auto cycle = run_command("vocabulary check --json " + scratch.file("c.vocabulary.json", text).string());
    EXPECT_EQ(cycle.code, 3) << cycle.err;
    const Json report = parse_json(cycle.out, "report");
    validate(report, "report", "report");
    EXPECT_FALSE(report["result"]["sound"].GetBool());
    EXPECT_TRUE(holds(report["result"]["findings"][0]["text"].GetString(), "'head' -> 'beard' -> 'head'")) << cycle.out;
    const auto torn = run_command("vocabulary check " + scratch.file("t.json", "{\"format\": ").string());
    EXPECT_EQ(torn.code, 1);
    EXPECT_TRUE(holds(torn.err, "line 1"));
    EXPECT_EQ(run_command("vocabulary check").code, 2);
    EXPECT_EQ(run_command("vocabulary check " + (scratch / "none.json").string()).code, 1);
}

TEST(VocabularyCommand, ShowIsATree) {
    const auto result = run_command("vocabulary show --language it " + words);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(holds(result.out, "\n    testa ")) << result.out;
    EXPECT_TRUE(holds(result.out, "\n      volto ")) << result.out;
    const auto under = run_command("vocabulary show --under occhio " + words);
    EXPECT_TRUE(holds(under.out, "\neye ")) << under.out;
    EXPECT_TRUE(holds(under.out, "\n  left eye ")) << under.out;
    EXPECT_FALSE(holds(under.out, "vase"));
    // English, with a note, if the vocabulary does not have the language.
    const auto unknown_language = run_command("vocabulary show --language xx " + words);
    EXPECT_EQ(unknown_language.code, 0);
    EXPECT_TRUE(holds(unknown_language.err, "no label is in the language 'xx'; there are de, en, it")) << unknown_language.err;
    EXPECT_EQ(unknown_language.out.substr(0, unknown_language.out.find("  id")),
              run_command("vocabulary show " + words).out.substr(0, unknown_language.out.find("  id")));
    EXPECT_TRUE(holds(unknown_language.out, "\n    head ")) << unknown_language.out;
    EXPECT_EQ(run_command("vocabulary show --language it " + words).err, "");
    EXPECT_TRUE(holds(under.out, " of ")) << "the rules that may apply to eyes, of all: " << under.out;
    const auto unknown_concept = run_command("vocabulary show --under ocho " + words);
    EXPECT_EQ(unknown_concept.code, 1);
    EXPECT_TRUE(holds(unknown_concept.err, "occhio")) << unknown_concept.err;
}

TEST(VocabularyCommand, TheAnnotatedObjectsOfTheProjectSatisfyTheVocabulary) {
    for (const std::string object : {"vase", "teapot", "statuette"}) {
        const auto result = run_command("annotation check " + data + object + ".ply " + data + object +
                                        ".ant.json --strict --vocabulary " + words);
        EXPECT_EQ(result.code, 0) << result.out << result.err;
        EXPECT_FALSE(holds(result.out, "not among those")) << result.out;
    }
    // A chair is not in the vocabulary.
    const auto chair = run_command("annotation check " + data + "chair.ply " + data + "chair.ant.json --vocabulary " + words);
    EXPECT_EQ(chair.code, 3) << chair.err;
    EXPECT_TRUE(holds(chair.out, "the tag 'armchair' is not in the vocabulary") ||
                holds(chair.out, "the tag 'chair' is not in the vocabulary"))
        << chair.out;
}

TEST(VocabularyCommand, ApplyRefusesAnUnknownTag) {
    const Scratch scratch;
    write_mesh(scratch / "tile.ply", grid(4));
    const auto recipe = [](const std::string& tag) {
        return R"({"format": "ostraka-recipe", "version": 1, "class": "bust", "unit": "mm", "annotations": [
            {"id": 1, "tag": ")" +
               tag + R"(", "type": "point", "select": {"nearest": [1, 0, 0]}}]})";
    };
    const std::string output = scratch.file("out.ant.json", "earlier").string();
    const auto apply = [&](const std::string& tag, const std::string& vocabulary) {
        return run_command("annotation apply " + (scratch / "tile.ply").string() + " " +
                           scratch.file("r.recipe.json", recipe(tag)).string() + " " + output + " --vocabulary " + vocabulary);
    };
    const auto refused = apply("noze", words);
    EXPECT_EQ(refused.code, 1);
    EXPECT_TRUE(holds(refused.err, "r.recipe.json: annotation 1: the tag 'noze' is not in the vocabulary: did you mean 'nose'"))
        << refused.err;
    EXPECT_EQ(read_file(output), "earlier");
    EXPECT_EQ(apply("Naso", scratch.file("bad.vocabulary.json", "{}").string()).code, 1);
    EXPECT_EQ(read_file(output), "earlier");
    EXPECT_EQ(apply("Naso", output).code, 2) << "an output that is an input";
    const auto accepted = apply("Naso", words);
    EXPECT_EQ(accepted.code, 0) << accepted.err;
    EXPECT_TRUE(holds(read_file(output), "terracotta.vocabulary.json")) << "provenance";
}
