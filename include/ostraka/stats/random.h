// Random numbers that are identical for every compiler and library.
#pragma once

#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace ostraka {

/// Random numbers drawn from std::mt19937_64, whose output is fixed by the C++ standard, unlike the output of the standard
/// distributions. Streams of one seed are independent. Use a separate stream for each restart, resample or object, so that
/// results do not depend on the order of draws.
class Random {
public:
    explicit Random(std::uint64_t seed, std::uint64_t stream = 0);  ///< a stream of random numbers for this seed

    /// 64 random bits.
    std::uint64_t bits() { return engine_(); }
    /// Uniformly distributed number in [0, 1), a multiple of 2^-53.
    double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    /// Uniformly distributed number in [low, high).
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    /// Uniformly distributed integer from 0 to count - 1; count > 0.
    std::size_t below(std::size_t count);
    /// Normally distributed number with mean 0 and standard deviation 1 (Box and Muller 1958).
    double normal();
    double normal(double mean, double deviation) { return mean + deviation * normal(); }  ///< normally distributed number

    template <class Value>
    void shuffle(std::vector<Value>& values) {
        for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[below(i)]);
    }
    /// The integers 0 to count - 1 in random order.
    std::vector<std::size_t> permutation(std::size_t count);
    /// `count` integers drawn from 0 to count - 1 with replacement.
    std::vector<std::size_t> resample(std::size_t count);

private:
    std::mt19937_64 engine_;
    double spare_ = 0;        ///< second number of the last pair of normal numbers
    bool has_spare_ = false;  ///< true: spare_ was not used yet
};

/// Element `counter` of the random sequence of a seed (SplitMix64; Steele, Lea and Flood 2014), a number in [0, 1); the result
/// does not depend on previous calls.
double random_share(std::uint64_t seed, std::uint64_t counter);

}  // namespace ostraka
