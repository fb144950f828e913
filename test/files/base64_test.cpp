// Base64 as RFC 4648 states it.
#include "ostraka/files/base64.h"

#include <gtest/gtest.h>

using namespace ostraka;

TEST(Base64, EncodesTheExamplesOfTheStandard) {
    for (const auto& [bytes, text] : {std::pair{"", ""},
                                      {"f", "Zg=="},
                                      {"fo", "Zm8="},
                                      {"foo", "Zm9v"},
                                      {"foob", "Zm9vYg=="},
                                      {"fooba", "Zm9vYmE="},
                                      {"foobar", "Zm9vYmFy"}}) {
        EXPECT_EQ(to_base64(bytes), text);
        EXPECT_EQ(from_base64(text), bytes);
    }
}

TEST(Base64, RestoresAllBytesAndRefusesOtherTexts) {
    std::string bytes;
    for (int i = 0; i < 777; ++i) bytes += static_cast<char>(i * 37);
    EXPECT_EQ(from_base64(to_base64(bytes)), bytes);
    for (const char* text : {"Zg=", "Zg", "Z", "Zm9v!", "Zm9v Zm8=", "====", "Z==="}) {
        SCOPED_TRACE(text);
        EXPECT_FALSE(from_base64(text).has_value());
    }
}
