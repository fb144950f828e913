// Buffered writing of text or bytes to an atomic file.
#pragma once

#include "ostraka/core/progress.h"
#include "ostraka/files/file.h"

#include <charconv>
#include <string>

namespace ostraka::io {

/// Collects text or bytes and writes them in blocks to an atomic file.
class TextWriter {
public:
    explicit TextWriter(const Path& file) : file_(file) { buffer_.reserve(block + 512); }

    void text(std::string_view words) {
        buffer_.append(words);
        flush_if_full();
    }
    void character(char c) { buffer_.push_back(c); }  ///< appends one character
    /// Writes a number with the shortest digits that read back to the same number.
    template <class T>
    void number(T value) {
        char digits[32];
        const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
        buffer_.append(digits, end);
    }
    /// Writes numbers, each with a blank in front.
    template <class T>
    void numbers(std::initializer_list<T> values) {
        for (const T value : values) {
            character(' ');
            number(value);
        }
    }
    /// Writes numbers separated by blanks, then `end`.
    template <class T>
    void row(std::initializer_list<T> values, std::string_view end = "\n") {
        for (const T& value : values) {
            if (&value != values.begin()) character(' ');
            number(value);
        }
        text(end);
    }
    /// Writes the bytes of a value; the machine is little-endian (checked at compile time).
    template <class T>
    void bytes(const T& value) {
        buffer_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void end_line() {
        character('\n');
        flush_if_full();
    }
    void flush_if_full() {
        if (buffer_.size() >= block) flush();
    }
    void commit() {
        flush();
        file_.commit();
    }

private:
    static constexpr std::size_t block = 1 << 20;
    void flush() {
        check_cancelled();
        file_.write(buffer_);
        buffer_.clear();
    }
    AtomicFile file_;
    std::string buffer_;
};

/// A comment as one line: control characters become blanks.
inline std::string one_line(std::string_view comment) {
    std::string line(comment);
    for (char& c : line)
        if (static_cast<unsigned char>(c) < 32) c = ' ';
    return line;
}

}  // namespace ostraka::io
