// Random numbers that are identical for every compiler and library.
#pragma once

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace ostraka {

/// Draws from std::mt19937_64; its output is fixed by the standard, unlike that of the standard distributions. Streams of one
/// seed are independent: give each restart, resample or object its own stream, so that their order does not matter.
class Random {
public:
    explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

    /// 64 random bits.
    std::uint64_t bits() { return engine_(); }
    /// Uniform on [0, 1), a multiple of 2^-53.
    double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    /// Uniform on 0 to count - 1; count > 0.
    std::size_t below(std::size_t count);
    /// Normal with mean 0 and standard deviation 1 (Box and Muller 1958).
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

/// Element `counter` of the seed's sequence (SplitMix64; Steele, Lea and Flood 2014), in [0, 1): independent of the number of
/// previous draws.
double random_share(std::uint64_t seed, std::uint64_t counter);

}  // namespace ostraka
