// Numbers in bytes of little-endian order, as LAS, PCD and E57 store them.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

namespace ostraka::clouds {

/// The number of type T at `bytes`.
template <class T>
T little_endian(const char* bytes) {
    std::array<char, sizeof(T)> copy;
    std::memcpy(copy.data(), bytes, sizeof(T));
    if constexpr (std::endian::native != std::endian::little) std::reverse(copy.begin(), copy.end());
    return std::bit_cast<T>(copy);
}

}  // namespace ostraka::clouds
