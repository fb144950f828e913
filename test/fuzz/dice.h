// Pseudorandom numbers that depend on the seed only, not on the machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ostraka::fuzz {

/// SplitMix64 (Steele, Lea and Flood 2014).
class Dice {
public:
    explicit Dice(std::uint64_t seed) : state_(seed) {}
    /// The generator of one run, independent of those of other runs with the same seed.
    Dice(std::uint64_t seed, std::uint64_t run) : state_(Dice(seed).next() ^ Dice(run + 0x5DEECE66DU).next()) {}

    std::uint64_t next() {
        std::uint64_t z = state_ += 0x9E3779B97F4A7C15U;
        z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
        z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
        return z ^ (z >> 31U);
    }
    /// From 0 to count - 1; 0 for a count of 0.
    std::size_t below(std::size_t count) { return count == 0 ? 0 : static_cast<std::size_t>(next() % count); }
    bool once_in(std::size_t count) { return below(count) == 0; }
    template <class T>
    const T& pick(const std::vector<T>& list) {
        return list[below(list.size())];
    }

private:
    std::uint64_t state_;
};

}  // namespace ostraka::fuzz
