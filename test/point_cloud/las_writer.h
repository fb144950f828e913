// LAS files built in memory.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>

namespace ostraka::test {

/// Writes a value at a position of a file, which grows as needed.
template <class T>
void put(std::string& bytes, std::size_t position, T value) {
    if (bytes.size() < position + sizeof(T)) bytes.resize(position + sizeof(T), '\0');
    std::memcpy(bytes.data() + position, &value, sizeof(T));
}

/// Bytes of a point record, and place of its colour (0: none), by point format.
inline constexpr std::array<std::size_t, 11> las_records{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
inline constexpr std::array<std::size_t, 11> las_colours{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

/// A LAS file of three points in this point format.
inline std::string las_file(unsigned format, std::uint16_t red, std::uint16_t intensity = 700) {
    const unsigned minor = format > 5 ? 4 : format > 3 ? 3 : 2;
    const std::uint16_t header = minor == 4 ? 375 : 227, record = static_cast<std::uint16_t>(las_records[format] + 3);
    std::string bytes(header, '\0');
    bytes.replace(0, 4, "LASF");
    bytes[24] = 1;
    bytes[25] = static_cast<char>(minor);
    put<std::uint16_t>(bytes, 94, header);
    put<std::uint32_t>(bytes, 96, header);
    bytes[104] = static_cast<char>(format);
    put<std::uint16_t>(bytes, 105, record);
    if (minor == 4) put<std::uint64_t>(bytes, 247, 3);
    else put<std::uint32_t>(bytes, 107, 3);
    const std::array<double, 3> scale{0.001, 0.001, 0.01}, offset{650000, 5600000, -10};
    for (std::size_t k = 0; k < 3; ++k) {
        put(bytes, 131 + 8 * k, scale[k]);
        put(bytes, 155 + 8 * k, offset[k]);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t begin = header + i * record;
        bytes.resize(begin + record, '\0');
        for (std::size_t k = 0; k < 3; ++k) put<std::int32_t>(bytes, begin + 4 * k, static_cast<std::int32_t>(1000 * i + k));
        put<std::uint16_t>(bytes, begin + 12, intensity);
        if (las_colours[format] > 0) put<std::uint16_t>(bytes, begin + las_colours[format], red);
    }
    return bytes;
}

}  // namespace ostraka::test
