// Loops over eight points at a time, which the compiler vectorises for each vector width the processor may have.
//
// The loops use plain IEEE arithmetic without contraction (see the compiler flags of these files), so that every vector width
// and every machine gives the same bits.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define OSTRAKA_EACH_WIDTH __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define OSTRAKA_EACH_WIDTH
#endif
#define OSTRAKA_INLINE inline __attribute__((always_inline))

namespace ostraka::coords {

inline constexpr int lanes = 8;  ///< number of points processed at a time
using Lanes = double[lanes];     ///< one number per point

inline constexpr double pi = 3.14159265358979323846;

/// atan2(y, x) for y >= 0, in [0, pi]; 0 if both are 0. The quotient is reduced to |z| <= tan(pi / 8), where the polynomial
/// (Chebyshev interpolation of degree 10 in z^2) has an error below 6e-18.
OSTRAKA_INLINE double angle(double y, double x) {
    const double a = std::fabs(x);
    const bool low = y <= 0.41421356237309503 * a, high = y >= 2.4142135623730951 * a;
    const double above = low ? y : (high ? -a : y - a), below = low ? a : (high ? y : y + a);
    const double base = low ? 0 : (high ? 0.5 * pi : 0.25 * pi),
                 rest = low ? 0 : (high ? 6.123233995736766e-17 : 3.061616997868383e-17);
    const double z = above / (below > 0 ? below : 1), w = z * z;
    double p = -0.019176872294336067;
    p = p * w + 0.039231646190551486;
    p = p * w - 0.05085449318930035;
    p = p * w + 0.05858148832731273;
    p = p * w - 0.06664511438164644;
    p = p * w + 0.07692183190171728;
    p = p * w - 0.09090904578095735;
    p = p * w + 0.11111111015255669;
    p = p * w - 0.14285714284666534;
    p = p * w + 0.1999999999999552;
    p = p * w - 0.3333333333333333;
    const double value = base + (z + (z * w * p + rest));
    return x < 0 ? (pi - value) + 1.2246467991473532e-16 : value;
}

/// Natural logarithm of x for 1 <= x < 2^1000; undefined for other x.
OSTRAKA_INLINE double logarithm(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x) + (0x3FF0000000000000U - 0x3FE6A09E667F3BCDU);
    // The exponent as a double without a conversion: placed in the lowest bits of a number near 2^52.
    const double exponent = std::bit_cast<double>((bits >> 52) | 0x4330000000000000U) - (4503599627370496.0 + 1023);
    const double m = std::bit_cast<double>((bits & 0x000FFFFFFFFFFFFFU) + 0x3FE6A09E667F3BCDU);
    const double s = (m - 1) / (m + 1), w = s * s;
    double p = 0.14616451042434167;
    p = p * w + 0.15331721490738642;
    p = p * w + 0.18182889128565508;
    p = p * w + 0.22222211134749734;
    p = p * w + 0.28571428625975764;
    p = p * w + 0.39999999999899505;
    p = p * w + 0.666666666666667;
    return exponent * 0.69314718055994529 + (2 * s + s * w * p);
}

}  // namespace ostraka::coords
