// The arctangent and the logarithm of the loops over points, in units in the last place against long double.
#include "../../src/coords/lanes.h"

#include <gtest/gtest.h>

#include <cfloat>
#include <iostream>
#include <numbers>
#include <random>

namespace ostraka::coords {
namespace {

double units(double value, long double truth) {
    if (truth == 0) return value == 0 ? 0 : INFINITY;
    int exponent = 0;
    (void)std::frexp(static_cast<double>(truth), &exponent);
    return static_cast<double>(std::fabs(value - truth) / std::ldexp(1.0L, exponent - 53));
}

TEST(Functions, Angle) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0, 1), power(-300, 300);
    double max_error = 0;
    for (int i = 0; i < 2'000'000; ++i) {
        const double a = std::numbers::pi * unit(random), r = std::pow(10, 0.5 * power(random));
        double y = r * std::sin(a), x = r * std::cos(a);
        if (i % 4 == 1) y *= std::pow(10, -15 * unit(random));
        if (i % 4 == 2) x *= std::pow(10, -15 * unit(random));
        if (i % 4 == 3) y = r * unit(random) * 0.01 + std::fabs(x);
        max_error = std::max(max_error, units(angle(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x))));
    }
    EXPECT_LT(max_error, 2);
    std::cout << "angle: " << max_error << " units in the last place\n";
    EXPECT_EQ(angle(0, 0), 0);
    EXPECT_EQ(angle(0, 3), 0);
    EXPECT_EQ(angle(0, -3), std::numbers::pi);
    EXPECT_EQ(angle(2, 0), std::numbers::pi / 2);
    EXPECT_EQ(angle(1e-300, 1), 1e-300);
    EXPECT_EQ(angle(5, 5), std::numbers::pi / 4);
}

TEST(Functions, Logarithm) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> unit(0, 1);
    double max_error = 0;
    for (int i = 0; i < 2'000'000; ++i) {
        const double x = i % 2 == 0 ? 1 + unit(random) * std::pow(10, -15 * unit(random)) : std::pow(10, 200 * unit(random));
        max_error = std::max(max_error, units(logarithm(x), std::log(static_cast<long double>(x))));
    }
    EXPECT_LT(max_error, 2);
    std::cout << "logarithm: " << max_error << " units in the last place\n";
    EXPECT_EQ(logarithm(1), 0);
}

}  // namespace
}  // namespace ostraka::coords
