#include "ostraka/render/values.h"

#include "ostraka/core/error.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace ostraka {

namespace {
/// The text behind `'key':` in the header of a NumPy file, up to the end of the header.
std::string_view entry(std::string_view header, const std::string& key, const std::string& where) {
    const auto place = header.find("'" + key + "'");
    const auto colon = place == std::string_view::npos ? place : header.find(':', place);
    if (colon == std::string_view::npos) fail_input(where, "its NumPy header lacks '" + key + "'");
    auto rest = header.substr(colon + 1);
    rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
    return rest;
}

std::uint64_t element_count(std::string_view shape, const std::string& where) {
    constexpr const char* remedy = "save an array of one dimension, one number an element";
    if (shape.empty() || shape.front() != '(') fail_input(where, "its NumPy shape cannot be read", remedy);
    std::vector<std::uint64_t> sizes;
    const char *place = shape.data() + 1, *const end = shape.data() + shape.size();
    while (place != end && *place != ')') {
        if (*place == ' ' || *place == ',') {
            ++place;
            continue;
        }
        std::uint64_t size = 0;
        const auto [next, code] = std::from_chars(place, end, size);
        if (code != std::errc() || sizes.size() > 2) fail_input(where, "its NumPy shape cannot be read", remedy);
        sizes.push_back(size);
        place = next;
    }
    if (sizes.size() == 2 && sizes[1] == 1) sizes.pop_back();
    if (sizes.size() != 1) fail_input(where, "holds an array of " + std::to_string(sizes.size()) + " dimensions", remedy);
    return sizes[0];
}

template <class Number>
void append(std::vector<double>& values, std::string_view bytes) {
    for (std::size_t i = 0; i + sizeof(Number) <= bytes.size(); i += sizeof(Number)) {
        Number number;
        std::memcpy(&number, bytes.data() + i, sizeof number);
        values.push_back(static_cast<double>(number));
    }
}

std::vector<double> parse_npy(std::string_view bytes, const std::string& where) {
    static_assert(std::endian::native == std::endian::little);
    const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i])); };
    if (bytes.size() < 12 || bytes.substr(0, 6) != "\x93NUMPY")
        fail_input(where, "is not a NumPy file", "save it with numpy.save");
    const bool short_header = byte(6) == 1;
    const std::size_t length = short_header ? byte(8) | byte(9) << 8 : byte(8) | byte(9) << 8 | byte(10) << 16 | byte(11) << 24;
    const std::size_t begin = short_header ? 10 : 12;
    if (length > bytes.size() - begin) fail_input(where, "ends within its NumPy header");
    const std::string_view header = bytes.substr(begin, length), data = bytes.substr(begin + length);
    const auto type_text = entry(header, "descr", where);
    const auto type = type_text.substr(0, std::min<std::size_t>(5, type_text.size()));  // with its quotes
    const std::uint64_t count = element_count(entry(header, "shape", where), where);
    struct Kind {
        std::string_view name;
        std::size_t size;
        void (*append)(std::vector<double>&, std::string_view);
    };
    static constexpr Kind kinds[] = {
        {"'<f8'", 8, &append<double>},        {"'<f4'", 4, &append<float>},         {"'<i8'", 8, &append<std::int64_t>},
        {"'<i4'", 4, &append<std::int32_t>},  {"'<i2'", 2, &append<std::int16_t>},  {"'|i1'", 1, &append<std::int8_t>},
        {"'<u8'", 8, &append<std::uint64_t>}, {"'<u4'", 4, &append<std::uint32_t>}, {"'<u2'", 2, &append<std::uint16_t>},
        {"'|u1'", 1, &append<std::uint8_t>},  {"'|b1'", 1, &append<std::uint8_t>}};
    for (const Kind& kind : kinds) {
        if (kind.name != type) continue;
        if (count != data.size() / kind.size || data.size() % kind.size != 0)
            fail_input(where,
                       "names " + std::to_string(count) + " numbers and holds " + std::to_string(data.size()) + " bytes of them");
        std::vector<double> values;
        values.reserve(static_cast<std::size_t>(count));
        kind.append(values, data);
        return values;
    }
    fail_input(where, "holds numbers of the kind " + std::string(type), "save little-endian floats or integers");
}

std::vector<double> parse_lines(std::string_view text, const std::string& where) {
    std::vector<double> values;
    std::size_t line = 0;
    while (!text.empty()) {
        ++line;
        const auto end = text.find('\n');
        std::string_view words = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        constexpr std::string_view blanks = " \t\r";
        words.remove_prefix(std::min(words.find_first_not_of(blanks), words.size()));
        words = words.substr(0, words.find_last_not_of(blanks) + 1);
        if (words.empty() || words.front() == '#') continue;
        if (words.front() == '+') words.remove_prefix(1);
        double value = 0;
        const auto [rest, code] = std::from_chars(words.data(), words.data() + words.size(), value);
        if (rest != words.data() + words.size() || (code != std::errc() && code != std::errc::result_out_of_range))
            fail_input(where + ", line " + std::to_string(line), "is not one number",
                       "write one number a line, nan where there is none");
        if (code == std::errc::result_out_of_range) value = std::numeric_limits<double>::quiet_NaN();
        values.push_back(value);
    }
    return values;
}
}  // namespace

std::vector<double> read_values(const Path& file) {
    const std::string bytes = read_file(file);
    return extension(file) == ".npy" ? parse_npy(bytes, file.string()) : parse_lines(bytes, file.string());
}

void write_values(const Path& file, const std::vector<double>& values) {
    std::string bytes;
    if (extension(file) == ".npy") {
        std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + std::to_string(values.size()) + ",), }";
        header.resize((header.size() + 11 + 63) / 64 * 64 - 11, ' ');  // data start at a multiple of 64
        header += '\n';
        bytes.assign("\x93NUMPY\x01\x00", 8);
        bytes += static_cast<char>(header.size() & 255);
        bytes += static_cast<char>(header.size() >> 8);
        bytes += header;
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
    } else {
        char text[32];
        for (const double value : values) {
            if (std::isnan(value)) bytes += "nan";
            else bytes.append(text, std::to_chars(text, text + sizeof text, value).ptr);
            bytes += '\n';
        }
    }
    write_file(file, bytes);
}

}  // namespace ostraka
