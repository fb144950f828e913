// One list of options: checks, texts, settings.
#include "ostraka/core/options.h"

#include <gtest/gtest.h>

using namespace ostraka;

namespace {

enum class Colour { red, green };

struct Sample {
    bool on = true;
    int count = 3;
    std::uint64_t seed = 1;
    double share = 0.5;
    std::string name;
    std::string kind = "a";
    std::vector<std::string> tags;
    std::vector<double> heights;
    std::optional<double> limit;
    Colour colour = Colour::red;
    std::string where;

    void declare_options(OptionList& list) {
        list("on", on, "a switch");
        list("count", count, "how many", Range{1, 10});
        list("seed", seed, "of chance", Range{0, 1e15});
        list("share", share, "of the whole", Range{0, 1}, "share of the diagonal");
        list("name", name, "any text");
        list("kind", kind, "which", Choices{"a", "b"});
        list("tags", tags, "several");
        list("heights", heights, "numbers", Range{0, 100});
        list("limit", limit, "if there is one", Range{-1, 1});
        list("colour", colour, "an enumeration", Choices{"red", "green"});
        list("where", where, "a place", Words{{"top", "left"}, "a letter", [](const std::string& text) {
                                                  if (text.size() != 1 && text != "top" && text != "left")
                                                      throw Error(ErrorKind::usage, "", "option where is '" + text + "'");
                                              }});
    }
};

std::string refused(Sample& sample, const std::string& name, const std::vector<std::string>& words) {
    OptionList list;
    sample.declare_options(list);
    try {
        list.find(name)->set(words);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        return error.what();
    }
    return {};
}

}  // namespace

TEST(Options, AreSetAndChecked) {
    Sample sample;
    EXPECT_EQ(refused(sample, "count", {"7"}), "");
    EXPECT_EQ(sample.count, 7);
    EXPECT_EQ(refused(sample, "heights", {"1,2.5", "3"}), "");
    EXPECT_EQ(sample.heights, (std::vector<double>{1, 2.5, 3}));
    EXPECT_EQ(refused(sample, "tags", {"x", "y,z"}), "");
    EXPECT_EQ(sample.tags, (std::vector<std::string>{"x", "y,z"}));
    EXPECT_EQ(refused(sample, "limit", {"-0.5"}), "");
    EXPECT_EQ(sample.limit, -0.5);
    EXPECT_EQ(refused(sample, "colour", {"green"}), "");
    EXPECT_EQ(sample.colour, Colour::green);
    EXPECT_EQ(refused(sample, "on", {"false"}), "");
    EXPECT_FALSE(sample.on);
    for (const auto& [name, word] : {std::pair<std::string, std::string>{"count", "11"},
                                     {"count", "0"},
                                     {"count", "2.5"},
                                     {"count", ""},
                                     {"count", "x"},
                                     {"share", "1.5"},
                                     {"share", "nan"},
                                     {"kind", "c"},
                                     {"heights", "1,101"},
                                     {"heights", "1,,2"},
                                     {"limit", "2"},
                                     {"colour", "blue"},
                                     {"on", "maybe"},
                                     {"seed", "-1"}})
        EXPECT_NE(refused(sample, name, {word}).find("option " + name), std::string::npos) << name << " " << word;
    EXPECT_NE(refused(sample, "count", {"1", "2"}), "");
    for (const char* word : {"top", "left", "q"}) EXPECT_EQ(refused(sample, "where", {word}), "") << word;
    EXPECT_NE(refused(sample, "where", {"aside"}), "");
}

TEST(Options, AmountsWithAUnitOrADecimalCommaExplainTheFormat) {
    Sample sample;
    const auto says = [&](const std::string& name, const std::string& word, const std::string& remedy) {
        const std::string message = refused(sample, name, {word});
        EXPECT_NE(message.find(remedy), std::string::npos) << message;
        EXPECT_NE(message.find("'" + word + "'"), std::string::npos) << message;
    };
    says("limit", "0,5", "write 0.5, with a decimal point");
    says("limit", "2cm", "write the number alone: 2 (");
    says("limit", "2 mm", "--unit");
    says("share", "50%", "write 0.5, a share");
    says("share", "0,5 of it", "write the number alone: 0.5 (share of the diagonal)");
    says("heights", "2,4mm", "write the number alone: 4 (");
    says("count", "5k", "use a value from 1 to 10");
    says("limit", "wide", "use a value from -1 to 1");
    says("colour", "Gren", "did you mean 'green'? use one of: red, green");
    EXPECT_EQ(refused(sample, "heights", {"2,4"}), "");
}

TEST(Options, StructsAreCheckedAndListed) {
    Sample sample;
    EXPECT_NO_THROW(check_options(sample, "here"));
    const auto listed_options = declare_options(sample);
    ASSERT_EQ(listed_options.size(), 11U);
    EXPECT_EQ(listed_options[0], (std::pair<std::string, std::string>{"on", "true"}));
    EXPECT_EQ(listed_options[3].second, "0.5");
    EXPECT_EQ(listed_options[4].second, "");
    EXPECT_EQ(listed_options[9].second, "red");
    sample.share = 2;
    EXPECT_THROW(check_options(sample, "here"), Error);
    sample.share = 0.5;
    sample.kind = "z";
    EXPECT_THROW(check_options(sample, "here"), Error);
}

TEST(Options, AreDeclaredOnce) {
    OptionList list;
    int variable = 0;
    list("one", variable, "a number");
    EXPECT_THROW(list("one", variable, "a number"), std::logic_error);
}
