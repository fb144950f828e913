// The body of a PLY file as a sequence of numbers, from text or from bytes of either order.
#pragma once

#include "io/ply_header.h"
#include "io/text_reader.h"
#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace ostraka::io {

/// Reads the elements of a text PLY file: one line of words per element.
class AsciiRows {
public:
    AsciiRows(std::string_view bytes, std::size_t start, const std::string& file) : reader_(bytes, file, 0) {
        reader_.set_position(bytes.data() + start);
        reader_.skip_space();
    }
    /// Starts to read an element; throws Error if the file ends.
    void begin(const PlyElement& element, std::size_t row) {
        if (element.properties.empty()) return;
        if (!reader_.skip_space())
            reader_.fail(fmt::format("the file ends at {} {} of {}", element.name, row, element.count), "the file is cut off");
    }
    /// Ends an element; throws Error if its line has further values.
    void end(const PlyElement& element, std::size_t row) {
        if (!reader_.line_done()) reader_.fail(fmt::format("{} {} has more values than the header declares", element.name, row));
    }
    double value(PlyType type) {
        if (is_real(type)) return reader_.number("a value");
        const std::int64_t integer = reader_.integer("a whole number");
        if (integer < -largest_whole || integer > largest_whole) reader_.fail("a whole number does not fit 32 bits");
        return static_cast<double>(integer);
    }
    /// Minimum number of bytes that `count` values take in the file.
    static std::size_t minimum(PlyType, std::size_t count) { return 2 * count; }
    void skip(PlyType, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i)
            if (reader_.word().empty()) reader_.fail("the line ends inside a list", "the file may be cut off or damaged");
    }
    [[nodiscard]] std::size_t remaining() const { return reader_.remaining() + 1; }  // the last line end may be missing
    [[noreturn]] void fail(const std::string& problem, const std::string& remedy = {}) { reader_.fail(problem, remedy); }
    bool only_space_left() { return !reader_.skip_space(); }  ///< true if nothing but blanks follows

private:
    static constexpr std::int64_t largest_whole = 0xFFFFFFFF;
    TextReader reader_;
};

/// Reads the elements of a binary PLY file; `swapped` is true if the byte order of the file is not that of the machine.
template <bool swapped>
class BinaryRows {
public:
    BinaryRows(std::string_view bytes, std::size_t start, const std::string& file)
        : begin_(bytes.data()), position_(bytes.data() + start), end_(bytes.data() + bytes.size()), file_(file) {}
    void begin(const PlyElement& element, std::size_t row) {
        element_ = &element;
        row_ = row;
    }
    void end(const PlyElement&, std::size_t) {}
    double value(PlyType type) {
        switch (type) {
            case PlyType::int8:
                return load<std::int8_t>();
            case PlyType::uint8:
                return load<std::uint8_t>();
            case PlyType::int16:
                return load<std::int16_t>();
            case PlyType::uint16:
                return load<std::uint16_t>();
            case PlyType::int32:
                return load<std::int32_t>();
            case PlyType::uint32:
                return load<std::uint32_t>();
            case PlyType::float32:
                return static_cast<double>(load<float>());
            case PlyType::float64:
                return load<double>();
        }
        return 0;
    }
    static std::size_t minimum(PlyType type, std::size_t count) { return size_of(type) * count; }
    void skip(PlyType type, std::size_t count) {
        if (minimum(type, count) > remaining()) cut_off();
        position_ += minimum(type, count);
    }
    [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - position_); }
    [[noreturn]] void fail(const std::string& problem, const std::string& remedy = {}) {
        fail_input(fmt::format("{}, byte {}", file_, position_ - begin_), problem, remedy);
    }
    bool only_space_left() { return position_ == end_; }

private:
    template <class T>
    T load() {
        if (remaining() < sizeof(T)) cut_off();
        std::array<char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), position_, sizeof(T));
        position_ += sizeof(T);
        if constexpr (swapped) std::reverse(bytes.begin(), bytes.end());
        return std::bit_cast<T>(bytes);
    }
    [[noreturn]] void cut_off() {
        fail(fmt::format("the file ends inside {} {} of {}", element_->name, row_, element_->count), "the file is cut off");
    }

    const char* begin_;
    const char* position_;
    const char* end_;
    std::string file_;
    const PlyElement* element_ = nullptr;
    std::size_t row_ = 0;
};

}  // namespace ostraka::io
