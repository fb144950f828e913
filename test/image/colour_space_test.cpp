#include "ostraka/image/colour_space.h"

#include <gtest/gtest.h>

#include <vector>

namespace ostraka {
namespace {

TEST(ColourSpace, LabOfWhiteBlackAndPrimaries) {
    const auto expect_lab = [](const std::array<float, 3>& linear, const Lab& expected) {
        const Lab lab = lab_from_linear(linear);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(lab[k], expected[k], 0.02) << k;
    };
    expect_lab({0, 0, 0}, {0, 0, 0});
    expect_lab({1, 1, 1}, {100, 0, 0});
    expect_lab({1, 0, 0}, {53.24, 80.09, 67.20});
    expect_lab({0, 1, 0}, {87.73, -86.18, 83.18});
    expect_lab({0, 0, 1}, {32.30, 79.19, -107.86});
}

/// Pairs from table 1 of Sharma, Wu and Dalal 2005, which cover every branch of the formula.
TEST(ColourSpace, DifferencesOfThePublishedPairs) {
    struct Pair {
        Lab a, b;
        double difference;
    };
    const std::vector<Pair> pairs{
        {{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
        {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
        {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
        {{50, 0, 0}, {50, -1, 2}, 2.3669},
        {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0009}, 7.1792},
        {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0011}, 7.2195},
        {{50, -0.0010, 2.4900}, {50, 0.0009, -2.4900}, 4.8045},
        {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
        {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
        {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
        {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
        {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
        {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
    };
    for (const Pair& pair : pairs) {
        EXPECT_NEAR(colour_difference(pair.a, pair.b), pair.difference, 5e-5);
        EXPECT_NEAR(colour_difference(pair.b, pair.a), pair.difference, 5e-5);
        EXPECT_EQ(colour_difference(pair.a, pair.a), 0);
    }
}

}  // namespace
}  // namespace ostraka
