#include "ostraka/stats/random.h"
#include "ostraka/core/angles.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace ostraka {

namespace {

/// A hash to which each bit of `x` contributes (SplitMix64; Steele, Lea and Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31);
}

}  // namespace

double random_share(std::uint64_t seed, std::uint64_t counter) {
    const std::uint64_t x = (seed + 0x632be59bd9b4e019U + counter) * 0x9e3779b97f4a7c15U;
    return static_cast<double>(mixed(x) >> 11) * 0x1p-53;
}

Random::Random(std::uint64_t seed, std::uint64_t stream) : engine_(mixed(mixed(seed) + stream)) {}

std::size_t Random::below(std::size_t count) {
    // Rejects draws in the last, incomplete run of `count` numbers, so that all results are equally likely.
    const std::uint64_t n = count,
                        last = std::numeric_limits<std::uint64_t>::max() - std::numeric_limits<std::uint64_t>::max() % n;
    for (;;)
        if (const std::uint64_t x = engine_(); x < last) return static_cast<std::size_t>(x % n);
}

double Random::normal() {
    if (has_spare_) {
        has_spare_ = false;
        return spare_;
    }
    const double radius = std::sqrt(-2 * std::log(1 - uniform())), angle = 2 * pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
}

std::vector<std::size_t> Random::permutation(std::size_t count) {
    std::vector<std::size_t> indices(count);
    std::iota(indices.begin(), indices.end(), std::size_t{0});
    shuffle(indices);
    return indices;
}

std::vector<std::size_t> Random::resample(std::size_t count) {
    std::vector<std::size_t> indices(count);
    for (std::size_t& i : indices) i = below(count);
    return indices;
}

}  // namespace ostraka
