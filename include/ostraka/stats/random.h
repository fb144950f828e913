// Random numbers that are the same with every compiler and library.
#pragma once

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace ostraka {

/// Draws from std::mt19937_64, whose numbers the standard fixes, as it does not for its distributions. Streams of one seed are
/// independent of each other: give each restart, resample or object its own, and their order does not matter.
class Random {
public:
    explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

    /// 64 random bits.
    std::uint64_t bits() { return engine_(); }
    /// Evenly from [0, 1), a multiple of 2^-53.
    double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    /// Evenly from 0 to count - 1; count > 0.
    std::size_t below(std::size_t count);
    /// From the normal distribution with mean 0 and deviation 1 (Box and Muller 1958).
    double normal();
    double normal(double mean, double deviation) { return mean + deviation * normal(); }

    template <class Value>
    void shuffle(std::vector<Value>& values) {
        for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[below(i)]);
    }
    /// 0 to count - 1 in random order.
    std::vector<std::size_t> permutation(std::size_t count);
    /// `count` draws from 0 to count - 1, with replacement.
    std::vector<std::size_t> resample(std::size_t count);

private:
    std::mt19937_64 engine_;
    double spare_ = 0;
    bool has_spare_ = false;
};

/// The counter's number in the seed's sequence (SplitMix64; Steele, Lea and Flood 2014), in [0, 1): for what must not depend on
/// how much was drawn before.
double random_share(std::uint64_t seed, std::uint64_t counter);

}  // namespace ostraka
