// Random numbers that depend on nothing but a seed and a counter.
#pragma once

#include <cstdint>

namespace ostraka::shapes {

/// The counter's number in the seed's sequence (SplitMix64: Steele, Lea and Flood, Fast splittable pseudorandom number
/// generators, 2014), in [0, 1).
inline double random_share(std::uint64_t seed, std::uint64_t counter) {
    std::uint64_t z = (seed + 0x632BE59BD9B4E019ULL) * 0x9E3779B97F4A7C15ULL + (counter + 1) * 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    z ^= z >> 31;
    return static_cast<double>(z >> 11) * 0x1.0p-53;
}

}  // namespace ostraka::shapes
