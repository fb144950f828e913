#include "ostraka/reconstruction/assembly.h"

#include "ostraka/core/error.h"

#include <gtest/gtest.h>

namespace ostraka {
namespace {

/// An assembly with these entries of fragments.
Json assembly_of(const std::string& fragments) {
    return parse_json(R"({"format": "ostraka-assembly", "version": 1, "fragments": [)" + fragments + "]}", "made");
}
std::string entry(const std::string& name, const std::string& matches) {
    return R"({"name": ")" + name + R"(", "annotations": [)" + matches + "]}";
}

/// The error message for an assembly.
template <class Work>
std::string error_message(Work&& work) {
    try {
        work();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_EQ(error.where(), "my.assembly.json");
        EXPECT_FALSE(error.remedy().empty());
        return error.problem();
    }
    return "nothing";
}
std::string refusal(const std::string& fragments) {
    const Json assembly = assembly_of(fragments);
    return error_message([&] { stated_matches(assembly, "top", "my.assembly.json"); });
}
bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Assembly, StatedMatchesAreThoseOfTheFragment) {
    const Json assembly =
        assembly_of(entry("top", R"({"ofFragment": 1, "ofTemplate": 2, "stated": true},
                                    {"ofFragment": 2147483647, "ofTemplate": null, "stated": true},
                                    {"ofFragment": 3, "ofTemplate": 4, "stated": false}, {"ofFragment": 5})") +
                    "," + entry("base", R"({"ofFragment": 9, "ofTemplate": 9, "stated": true})") + R"(, {"name": "bare"})");
    const std::vector<StatedMatch> matches = stated_matches(assembly, "top");
    ASSERT_EQ(matches.size(), 2U);
    EXPECT_EQ(matches[0].fragment_annotation, 1);
    EXPECT_EQ(matches[0].template_annotation, 2);
    EXPECT_EQ(matches[1].fragment_annotation, 2147483647);
    EXPECT_FALSE(matches[1].template_annotation.has_value());
    EXPECT_TRUE(stated_matches(assembly, "bare").empty());
    EXPECT_TRUE(stated_matches(assembly, "absent").empty());
    EXPECT_EQ(unused_statements(assembly, {"top"}), std::vector<std::string>{"base"});
    EXPECT_EQ(unused_statements(assembly, {}), (std::vector<std::string>{"top", "base"}));
    EXPECT_TRUE(unused_statements(assembly, {"base", "top"}).empty());
    EXPECT_TRUE(unused_statements(assembly_of(""), {}).empty());
}

TEST(Assembly, InvalidStatementsAreRefusedWithFileAndPointer) {
    for (const char* number : {"2147483648", "-2147483649", "4294967297", "99999999999999999999", "1.5"}) {
        const std::string text(number);
        EXPECT_TRUE(has(refusal(entry("top", R"({"ofFragment": 1, "stated": true, "ofTemplate": )" + text + "}")),
                        "/fragments/0/annotations/0/ofTemplate"))
            << number;
        EXPECT_TRUE(has(refusal(entry("top", R"({"ofTemplate": 1, "stated": true, "ofFragment": )" + text + "}")),
                        "/fragments/0/annotations/0/ofFragment"))
            << number;
    }
    const std::string match = R"({"ofFragment": 1, "ofTemplate": 2, "stated": true})";
    EXPECT_EQ(refusal(entry("top", match)), "nothing");
    const std::string without = refusal(entry("top", match + R"(, {"ofFragment": 3, "stated": true})"));
    EXPECT_TRUE(has(without, "/fragments/0/annotations/1") && has(without, "'top'") && has(without, "ofTemplate")) << without;
    const std::string misspelt = refusal(entry("top", R"({"ofFragment": 1, "oftemplate": 2, "stated": true})"));
    EXPECT_TRUE(has(misspelt, "/fragments/0/annotations/0") && has(misspelt, "'oftemplate'")) << misspelt;
    const std::string twice = refusal(entry("top", match) + "," + entry("base", match) + "," + entry("top", match));
    EXPECT_TRUE(has(twice, "/fragments/2") && has(twice, "'top'") && has(twice, "/fragments/0")) << twice;
    const std::string settled = refusal(entry("top", match + "," + match));
    EXPECT_TRUE(has(settled, "/fragments/0/annotations/1") && has(settled, "already")) << settled;
}

TEST(Assembly, MissingAnnotationsAreNamed) {
    Fragment top;
    top.name = "top";
    AnnotationSet ours;
    for (AnnotationSet* set : {&top.annotations, &ours})
        for (const AnnotationType type : {AnnotationType::region, AnnotationType::line}) {
            Annotation annotation;
            annotation.id = free_id(*set);
            annotation.type = type;
            set->annotations.push_back(annotation);
        }
    const auto refused = [&](const std::string& match) {
        const Json assembly = assembly_of(entry("base", "") + "," + entry("top", match));
        return error_message([&] { stated_matches(assembly, top, ours, "my.assembly.json"); });
    };
    EXPECT_EQ(
        refused(R"({"ofFragment": 1, "ofTemplate": 1, "stated": true}, {"ofFragment": 0, "ofTemplate": null, "stated": true})"),
        "nothing");
    EXPECT_EQ(refused(R"({"ofFragment": 999, "ofTemplate": 999})"), "nothing") << "not stated";
    const std::string theirs = refused(R"({"ofFragment": 999, "ofTemplate": null, "stated": true})");
    EXPECT_TRUE(has(theirs, "/fragments/1/annotations/0") && has(theirs, "'top'") && has(theirs, "999")) << theirs;
    const std::string ours_missing = refused(R"({"ofFragment": 0, "ofTemplate": 998, "stated": true})");
    EXPECT_TRUE(has(ours_missing, "/fragments/1/annotations/0") && has(ours_missing, "template") && has(ours_missing, "998"))
        << ours_missing;
    const std::string types = refused(R"({"ofFragment": 0, "ofTemplate": 1, "stated": true})");
    EXPECT_TRUE(has(types, "'top'") && has(types, "region") && has(types, "line")) << types;
}

}  // namespace
}  // namespace ostraka
