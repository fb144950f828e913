// Writes small E57 files for tests: any columns, packets cut anywhere.
#pragma once

#include "../../src/point_cloud/e57_file.h"

#include <cstdint>
#include <cstring>
#include <deque>
#include <string>
#include <utility>
#include <vector>

namespace ostraka::test {

/// One scan: the columns are declarations in XML with their packed values.
struct E57WriterScan {
    struct Column {
        std::string declaration;
        unsigned bits;
        std::vector<std::uint64_t> values;
    };
    std::deque<Column> columns;
    std::string pose, record_count;  ///< record_count: text to write instead of the number of values

    std::vector<std::uint64_t>& column(std::string declaration, unsigned bits) {
        return columns.emplace_back(Column{std::move(declaration), bits, {}}).values;
    }
};

/// Writes the checksum of every page of 1024 bytes.
inline void seal_e57_pages(std::string& bytes) {
    for (std::size_t page = 0; page + 1024 <= bytes.size(); page += 1024) {
        const std::uint32_t checksum = clouds::crc32c(std::string_view(bytes).substr(page, 1020));
        for (std::size_t k = 0; k < 4; ++k) bytes[page + 1020 + k] = static_cast<char>(checksum >> (24 - 8 * k) & 255U);
    }
}

struct E57Writer {
    std::deque<E57WriterScan> scans;

    /// The file; each packet has at most `most` bytes of each column.
    [[nodiscard]] std::string file(std::size_t most) const {
        std::string logical(48, '\0'), xml = "<?xml version=\"1.0\"?><e57Root type=\"Structure\"><data3D type=\"Vector\">";
        for (const E57WriterScan& scan : scans) {
            while (logical.size() % 4 != 0) logical += '\0';
            const std::size_t section = logical.size();
            logical += section_of(scan, most, section);
            const std::string count =
                scan.record_count.empty() ? std::to_string(scan.columns.front().values.size()) : scan.record_count;
            xml += "<vectorChild type=\"Structure\">" + scan.pose + "<points type=\"CompressedVector\" fileOffset=\"" +
                   std::to_string(physical(section)) + "\" recordCount=\"" + count + "\"><prototype type=\"Structure\">";
            for (const auto& column : scan.columns) xml += column.declaration;
            xml += "</prototype><codecs type=\"Vector\"/></points></vectorChild>";
        }
        xml += "</data3D></e57Root>";
        const std::size_t xml_begin = logical.size();
        logical += xml;
        while (logical.size() % 1020 != 0) logical += '\0';
        std::memcpy(logical.data(), "ASTM-E57", 8);
        put32(logical, 8, 1);
        put64(logical, 16, logical.size() / 1020 * 1024);
        put64(logical, 24, physical(xml_begin));
        put64(logical, 32, xml.size());
        put64(logical, 40, 1024);
        std::string bytes;
        for (std::size_t page = 0; page < logical.size(); page += 1020)
            bytes += logical.substr(page, 1020) + std::string(4, '\0');
        seal_e57_pages(bytes);
        return bytes;
    }

private:
    static std::size_t physical(std::size_t logical) { return logical / 1020 * 1024 + logical % 1020; }
    static void put16(std::string& bytes, std::size_t position, std::size_t value) {
        for (std::size_t k = 0; k < 2; ++k) bytes[position + k] = static_cast<char>(value >> (8 * k) & 255U);
    }
    static void put32(std::string& bytes, std::size_t position, std::size_t value) {
        put16(bytes, position, value & 0xFFFFU);
        put16(bytes, position + 2, value >> 16U);
    }
    static void put64(std::string& bytes, std::size_t position, std::size_t value) {
        put32(bytes, position, value & 0xFFFFFFFFU);
        put32(bytes, position + 4, value >> 32U);
    }

    static std::string packed(const E57WriterScan::Column& column) {
        std::string bytes;
        std::size_t bit = 0;
        for (const std::uint64_t value : column.values)
            for (unsigned k = 0; k < column.bits; ++k, ++bit) {
                if (bit % 8 == 0) bytes += '\0';
                if ((value >> k & 1U) != 0) bytes.back() = static_cast<char>(bytes.back() | (1 << bit % 8));
            }
        return bytes;
    }

    static std::string section_of(const E57WriterScan& scan, std::size_t most, std::size_t begin) {
        std::vector<std::string> streams;
        for (const auto& column : scan.columns) streams.push_back(packed(column));
        std::string section(32, '\0');
        section[0] = 1;
        // An index packet, which readers skip, and then data packets with other shares of each column.
        section += std::string("\0\0\x0F\0", 4) + std::string(12, '\0');
        for (std::size_t round = 0;; ++round) {
            std::string packet(6 + 2 * streams.size(), '\0');
            bool is_empty = true;
            for (std::size_t k = 0; k < streams.size(); ++k) {
                const std::string part = streams[k].substr(0, most - (round + k) % std::min<std::size_t>(most, 5));
                streams[k].erase(0, part.size());
                put16(packet, 6 + 2 * k, part.size());
                packet += part;
                is_empty = is_empty && part.empty();
            }
            if (is_empty) break;
            while (packet.size() % 4 != 0) packet += '\0';
            packet[0] = 1;
            put16(packet, 2, packet.size() - 1);
            put16(packet, 4, streams.size());
            section += packet;
        }
        put64(section, 8, section.size());
        put64(section, 16, physical(begin + 32));
        return section;
    }
};

}  // namespace ostraka::test
