// The container of E57 (ASTM E2807-11): pages with checksums, the XML section, and the bit-packed columns of points.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ostraka::clouds {

/// The bytes of an E57 file without the checksums of its pages ("logical" bytes).
class E57Pages {
public:
    /// Checks the header, the size and the checksum of every page, and removes the checksums from `bytes` in place. Throws Error
    /// (input) for a damaged or incomplete file.
    E57Pages(std::string& bytes, const std::string& file);

    [[nodiscard]] std::string_view bytes() const { return bytes_; }
    [[nodiscard]] std::string_view xml() const { return xml_; }
    /// Place in `bytes()` of a physical offset, which counts the checksums; throws Error (input) if it lies outside the file.
    [[nodiscard]] std::size_t logical(std::uint64_t physical, const char* content) const;

private:
    std::string_view bytes_, xml_;
    const std::string& file_;
};

/// A column of the prototype of the points.
struct E57Column {
    enum class Type : std::uint8_t { integer, single_real, double_real, text };
    std::string name;  ///< without the prefix of an extension
    Type type = Type::double_real;
    std::int64_t minimum = 0, maximum = 0;      ///< range of a whole number
    double real_minimum = 0, real_maximum = 0;  ///< range of a real number; both 0: none
    double scale = 1, offset = 0;               ///< of a scaled whole number

    [[nodiscard]] unsigned bits() const;                     ///< bits of one value in its bytestream
    [[nodiscard]] double value(std::uint64_t packed) const;  ///< the number of a packed value
};

/// The bytestream of a column: the parts of all data packets that belong to it, read bit by bit, lowest bit first.
class E57Stream {
public:
    explicit E57Stream(std::string_view bytes) : bytes_(bytes) {}
    void append(std::size_t begin, std::size_t size) {
        if (size > 0) parts_.emplace_back(begin, size);
        size_ += size;
    }
    [[nodiscard]] std::uint64_t size() const { return size_; }  ///< bytes of all parts
    /// The next `count` bits, at most 64. The caller has checked that there are as many.
    std::uint64_t next(unsigned count);

private:
    std::string_view bytes_;
    std::vector<std::pair<std::size_t, std::size_t>> parts_;
    std::uint64_t size_ = 0;
    std::size_t part_ = 0, position_ = 0;
    unsigned byte_ = 0, left_ = 0;
};

/// The bytestreams of the columns for which `wanted` is true, in the order of the columns, of the compressed vector that begins
/// at the physical offset `section`. Throws Error (input) if the section is damaged or too short for `records` records.
std::vector<E57Stream> e57_streams(const E57Pages& pages, std::uint64_t section, std::uint64_t records,
                                   const std::vector<E57Column>& columns, const std::vector<bool>& wanted,
                                   const std::string& place);

/// CRC-32C (Castagnoli; RFC 3720) of bytes.
std::uint32_t crc32c(std::string_view bytes);

}  // namespace ostraka::clouds
