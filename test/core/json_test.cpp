#include "ostraka/core/json.h"
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

TEST(Json, NumbersSurviveARoundTrip) {
    const Json value = parse_json("[0.1, 1e-300, 123456789.123456789, -0.0, 3]", "numbers");
    const std::string text = to_text(value);
    EXPECT_EQ(text, to_text(parse_json(text, "again")));
    EXPECT_EQ(parse_json(text, "again")[0].GetDouble(), 0.1);
}

TEST(Json, SchemaErrorNamesPointerAndRule) {
    const Json value = parse_json(R"({"format": "ostraka-report", "command": 3, "result": {}})", "r");
    try {
        validate(value, "report", "r.json");
        FAIL();
    } catch (const Error& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("/command"), std::string::npos) << text;
        EXPECT_NE(text.find("string"), std::string::npos) << text;
    }
}
