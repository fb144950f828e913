#include "point_cloud/e57_file.h"

#include "point_cloud/little_endian.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka::clouds {

namespace {

constexpr std::size_t page_size = 1024, payload = 1020;

constexpr std::array<std::uint32_t, 256> crc_table() {
    std::array<std::uint32_t, 256> table{};
    constexpr std::uint32_t polynomial = 0x82F63B78;  // Castagnoli's, with the bits reversed
    for (std::uint32_t i = 0; i < 256; ++i) {
        std::uint32_t value = i;
        for (int bit = 0; bit < 8; ++bit) value = (value >> 1U) ^ ((value & 1U) != 0 ? polynomial : 0U);
        table[i] = value;
    }
    return table;
}

std::uint32_t byte_swapped(std::uint32_t value) {
    return value >> 24U | (value >> 8U & 0xFF00U) | (value << 8U & 0xFF0000U) | value << 24U;
}

}  // namespace

std::uint32_t crc32c(std::string_view bytes) {
    static constexpr std::array<std::uint32_t, 256> table = crc_table();
    std::uint32_t crc = 0xFFFFFFFF;
    for (const char c : bytes) crc = (crc >> 8U) ^ table[(crc ^ static_cast<unsigned char>(c)) & 255U];
    return ~crc;
}

E57Pages::E57Pages(std::string& bytes, const std::string& file) : file_(file) {
    constexpr std::size_t header_size = 48;
    if (!bytes.starts_with("ASTM-E57")) fail_input(file, "does not begin with ASTM-E57", "check that this is an E57 file");
    if (bytes.size() < page_size) fail_input(file, "ends inside the header of E57", "the file is cut off");
    const char* header = bytes.data();
    const auto major = little_endian<std::uint32_t>(header + 8), minor = little_endian<std::uint32_t>(header + 12);
    const auto length = little_endian<std::uint64_t>(header + 16), xml_offset = little_endian<std::uint64_t>(header + 24),
               xml_length = little_endian<std::uint64_t>(header + 32), page = little_endian<std::uint64_t>(header + 40);
    if (major != 1) fail_input(file, fmt::format("is E57 {}.{}", major, minor), "version 1 is read");
    if (page != page_size)
        fail_input(file, fmt::format("has pages of {} bytes", page), "E57 has pages of 1024 bytes; export it again");
    if (length != bytes.size() || length % page_size != 0)
        fail_input(file, fmt::format("has {} bytes, but its header says {}", bytes.size(), length),
                   "the file is cut off or damaged; copy or export it again");
    CancelCheck check;
    for (std::size_t k = 0; k * page_size < bytes.size(); ++k) {
        check();
        const char* begin = bytes.data() + k * page_size;
        // The standard stores the checksum with its highest byte first.
        if (byte_swapped(crc32c({begin, payload})) != little_endian<std::uint32_t>(begin + payload))
            fail_input(fmt::format("{}, byte {}", file, k * page_size), "the checksum of this page of 1024 bytes is wrong",
                       "the file is damaged; copy or export it again");
        std::memmove(bytes.data() + k * payload, begin, payload);
    }
    bytes.resize(bytes.size() / page_size * payload);
    bytes_ = bytes;
    const std::size_t xml = logical(xml_offset, "its XML section");
    constexpr std::uint64_t largest_xml = 16U << 20U;
    if (xml < header_size || xml_length > bytes_.size() - xml)
        fail_input(file, "its XML section lies outside the file", "the file is damaged; export it again");
    if (xml_length > largest_xml)
        fail_input(file, "has an XML section of more than 16 MB", "export it again with fewer scans or images");
    xml_ = bytes_.substr(xml, xml_length);
}

std::size_t E57Pages::logical(std::uint64_t physical, const char* content) const {
    const std::uint64_t pages = bytes_.size() / payload;
    if (physical >= pages * page_size || physical % page_size >= payload)
        fail_input(file_,
                   fmt::format("{} is said to begin at byte {}, which is not inside a page of the file", content, physical),
                   "the file is damaged; export it again");
    return static_cast<std::size_t>(physical / page_size * payload + physical % page_size);
}

unsigned E57Column::bits() const {
    if (type == Type::single_real) return 32;
    if (type == Type::double_real) return 64;
    unsigned count = 0;
    for (auto states = static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(minimum); states > 0; states >>= 1U)
        ++count;
    return count;
}

double E57Column::value(std::uint64_t packed) const {
    if (type == Type::single_real) return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(packed)));
    if (type == Type::double_real) return std::bit_cast<double>(packed);
    const auto whole = static_cast<std::int64_t>(packed + static_cast<std::uint64_t>(minimum));
    return static_cast<double>(whole) * scale + offset;
}

std::uint64_t E57Stream::next(unsigned count) {
    std::uint64_t value = 0;
    for (unsigned have = 0; have < count;) {
        if (left_ == 0) {
            if (position_ == parts_[part_].second) {
                ++part_;
                position_ = 0;
            }
            byte_ = static_cast<unsigned char>(bytes_[parts_[part_].first + position_++]);
            left_ = 8;
        }
        const unsigned taken = std::min(count - have, left_);
        value |= static_cast<std::uint64_t>(byte_ & ((1U << taken) - 1U)) << have;
        byte_ >>= taken;
        left_ -= taken;
        have += taken;
    }
    return value;
}

namespace {

constexpr const char* damaged = "the file is damaged; export it again";

/// A data packet: its bytestreams are appended to the streams of the wanted columns.
void take_packet(std::string_view packet, std::size_t begin, const std::vector<bool>& wanted, std::vector<E57Stream>& streams,
                 const std::string& place) {
    constexpr std::size_t packet_header = 6;
    const std::size_t count = packet.size() < packet_header ? 0 : little_endian<std::uint16_t>(packet.data() + 4);
    if (count != wanted.size() || packet.size() < packet_header + 2 * count)
        fail_input(place, fmt::format("a packet of points has {} columns, but {} are declared", count, wanted.size()), damaged);
    std::size_t position = packet_header + 2 * count, stream = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t size = little_endian<std::uint16_t>(packet.data() + packet_header + 2 * k);
        if (size > packet.size() - position) fail_input(place, "a column of a packet of points exceeds the packet", damaged);
        if (wanted[k]) streams[stream++].append(begin + position, size);
        position += size;
    }
}

}  // namespace

std::vector<E57Stream> e57_streams(const E57Pages& pages, std::uint64_t section, std::uint64_t records,
                                   const std::vector<E57Column>& columns, const std::vector<bool>& wanted,
                                   const std::string& place) {
    constexpr std::size_t section_header = 32;
    const std::string_view bytes = pages.bytes();
    const std::size_t start = pages.logical(section, "the points of a scan");
    if (bytes.size() - start < section_header || bytes[start] != 1)
        fail_input(place, fmt::format("at byte {} there are no points (the section has a wrong kind)", section), damaged);
    const auto length = little_endian<std::uint64_t>(bytes.data() + start + 8);
    if (length < section_header || length > bytes.size() - start) fail_input(place, "the points exceed the file", damaged);
    std::vector<E57Stream> streams;
    std::vector<unsigned> bits;
    for (std::size_t k = 0; k < columns.size(); ++k) {
        if (!wanted[k]) continue;
        streams.emplace_back(bytes);
        bits.push_back(columns[k].bits());
    }
    if (records == 0) return streams;
    const std::size_t end = start + static_cast<std::size_t>(length);
    std::size_t position = pages.logical(little_endian<std::uint64_t>(bytes.data() + start + 16), "the first packet of points");
    if (position < start + section_header) fail_input(place, "the first packet of points lies outside its section", damaged);
    CancelCheck check;
    while (position < end && end - position >= 4) {
        check();
        const auto kind = static_cast<unsigned char>(bytes[position]);
        const std::size_t size = little_endian<std::uint16_t>(bytes.data() + position + 2) + std::size_t(1);
        if (kind > 2 || size < 4 || size > end - position)
            fail_input(place, "a packet of points has a wrong kind or exceeds its section", damaged);
        if (kind == 1) take_packet(bytes.substr(position, size), position, wanted, streams, place);
        position += size;
    }
    for (std::size_t k = 0; k < streams.size(); ++k)
        if (bits[k] > 0 && 8 * streams[k].size() / bits[k] < records)
            fail_input(place, fmt::format("promises {} points, but holds only {}", records, 8 * streams[k].size() / bits[k]),
                       damaged);
    return streams;
}

}  // namespace ostraka::clouds
