#include "ostraka/files/json.h"
#include "ostraka/core/error.h"

#include <gtest/gtest.h>

using namespace ostraka;

TEST(Json, ErrorNamesLineAndColumn) {
    try {
        parse_json("{\"a\": 1,\n  \"b\": }", "some.json");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("some.json, line 2, column 8"), std::string::npos) << error.what();
    }
}

TEST(Json, DeepNestingIsRefused) { EXPECT_THROW(parse_json(std::string(100000, '['), "deep"), Error); }

TEST(Json, ADuplicateMemberIsRefused) {
    EXPECT_THROW(parse_json(R"([{"a": {"b": 1, "c": 2, "b": 1}}])", "twins"), Error);
    EXPECT_NO_THROW(parse_json(R"([{"b": 1}, {"b": 1}, {"a": {"b": 1}}])", "no twins"));
}

TEST(Json, TextThatIsNotUtf8IsReadableAfterWriting) {
    Json document(rapidjson::kArrayType);
    for (const char* text : {"caf\xE9.ply", "\xC3\xA9", "\xED\xA0\x80", "\xF0\x9F\x8F\xBA", "\xE2\x82", "\xC0\xAF"})
        document.PushBack(json_string(text, document.GetAllocator()), document.GetAllocator());
    const Json again = parse_json(to_text(document), "again");
    EXPECT_STREQ(again[0].GetString(), "caf\xEF\xBF\xBD.ply");
    EXPECT_STREQ(again[1].GetString(), "\xC3\xA9");
    EXPECT_STREQ(again[3].GetString(), "\xF0\x9F\x8F\xBA");
}

TEST(Json, NumbersSurviveARoundTrip) {
    const Json value = parse_json("[0.1, 1e-300, 123456789.123456789, -0.0, 3]", "numbers");
    const std::string text = to_text(value);
    EXPECT_EQ(text, to_text(parse_json(text, "again")));
    EXPECT_EQ(parse_json(text, "again")[0].GetDouble(), 0.1);
}

TEST(Json, AnUnknownMemberIsNamed) {
    try {
        validate(
            parse_json(
                R"({"format": "ostraka-measures", "version": 1, "foo": 1, "measures": [{"name": "a", "descriptor": "area"}]})",
                "m"),
            "measures", "m");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("unknown member 'foo'"), std::string::npos) << error.what();
    }
}

TEST(Json, SchemaErrorNamesPointerAndRule) {
    const Json value = parse_json(R"({"format": "ostraka-report", "command": 3, "result": {}})", "r");
    try {
        validate(value, "report", "r.json");
        FAIL();
    } catch (const Error& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("/command"), std::string::npos) << text;
        EXPECT_NE(text.find("a text"), std::string::npos) << text;
    }
}

TEST(Json, ViolatedRulesAreInWords) {
    const auto message = [](const std::string& text) {
        try {
            validate(parse_json(text, "file"), "web-annotation", "file");
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    for (const char* text : {R"({"type": "Annotation"})", "[]", R"({"type": "Annotation", "target": 7})",
                             R"({"type": "Annotation", "target": {"selector": {"places": {"points": [[1, 2]]}}}})"}) {
        const std::string problem = message(text);
        ASSERT_FALSE(problem.empty()) << text;
        for (const char* raw : {"{\"", "[\"", "anyOf", "$ref", "minItems", "definitions"})
            EXPECT_EQ(problem.find(raw), std::string::npos) << problem;
    }
    EXPECT_NE(message(R"({"type": "Annotation"})").find("'target'"), std::string::npos);
    EXPECT_NE(message("[]").find("an object"), std::string::npos);
}

TEST(Json, ErrorsQuoteNoBinary) {
    const Error error(ErrorKind::input, "file",
                      std::string("the word '\x01\x02\xff\xfe"
                                  "abc\0def'",
                                  22),
                      "write it again");
    EXPECT_EQ(error.problem(), "the word '...abc...def'");
    const Error longer(ErrorKind::input, "file", std::string(100000, 'x'), "");
    EXPECT_LT(std::string(longer.what()).size(), 5000U);
    const Error foreign(ErrorKind::input, "file", "Gefäß", "");
    EXPECT_EQ(foreign.problem(), "Gefäß");
}
