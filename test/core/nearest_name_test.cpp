#include "ostraka/core/nearest_name.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace ostraka {
namespace {

TEST(EditDistance, IsTheFewestEdits) {
    EXPECT_EQ(edit_distance("kitten", "sitting", 9), 3U);
    EXPECT_EQ(edit_distance("neck", "nekc", 9), 1U) << "neighbours swapped";
    EXPECT_EQ(edit_distance("", "abc", 9), 3U);
    EXPECT_EQ(edit_distance("\xC3\xA4hre", "ahre", 9), 1U) << "letters, not bytes";
    EXPECT_EQ(edit_distance("ca", "abc", 9), 3U) << "optimal string alignment";
    // The band does not affect distances below the limit: tested on random words.
    std::uint64_t state = 1;
    const auto random_word = [&state] {
        std::string text;
        state = state * 6364136223846793005U + 1442695040888963407U;
        for (std::uint64_t k = 0; k < state >> 61; ++k) {
            state = state * 6364136223846793005U + 1442695040888963407U;
            text += static_cast<char>('a' + (state >> 33) % 3);
        }
        return text;
    };
    for (int i = 0; i < 2000; ++i) {
        const std::string a = random_word(), b = random_word();
        const std::size_t full_distance = edit_distance(a, b, 20);
        EXPECT_EQ(edit_distance(b, a, 20), full_distance);
        EXPECT_EQ(full_distance == 0, a == b);
        for (std::size_t limit = 0; limit < 8; ++limit)
            EXPECT_EQ(edit_distance(a, b, limit), std::min(full_distance, limit + 1)) << a << ' ' << b << ' ' << limit;
    }
}

TEST(EditDistance, OfInvalidUtf8) {
    EXPECT_EQ(edit_distance("a\xFF", "a\xFE", 9), 1U);
    EXPECT_EQ(edit_distance("a\xFF", "a\xFF", 9), 0U);
}

TEST(NearestName, WithinTwoEditsOrOneInThreeLetters) {
    const std::vector<std::string> names{"handle", "lip", "hands", "candle", "decoration"};
    EXPECT_EQ(nearest_name("candel", names), "candle");
    EXPECT_EQ(nearest_name("handl", names), "handle") << "the first of equally near ones";
    EXPECT_EQ(nearest_name("dekorazion", names), "decoration");
    EXPECT_EQ(nearest_name("spout", names), "");
    EXPECT_EQ(nearest_name("", {"abc"}), "");
    EXPECT_EQ(nearest_name("HANDLE", names), "handle") << "capital letters or not";
    const std::vector<std::string> parts{"seat width", "seat depth", "Back height", "leg"};
    EXPECT_EQ(nearest_name("seet width", parts), "seat width");
    EXPECT_EQ(nearest_name("back hight", parts), "Back height");
    EXPECT_EQ(nearest_name("height", parts), "Back height") << "the only one with that word";
    EXPECT_EQ(nearest_name("seat", parts), "") << "two of them";
    EXPECT_EQ(nearest_name("idth", parts), "") << "no word begins so";
    EXPECT_EQ(nearest_name("x", {}), "");
}

}  // namespace
}  // namespace ostraka
