// Parser for the text of a mesh file: lines, words and numbers, with errors that name file and line.
#pragma once

#include "ostraka/core/progress.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace ostraka::io {

/// Reads words separated by blanks (space, tab, carriage return, vertical tab) on lines that end with a line feed.
/// `comment` is the character that starts a comment up to the end of its line, 0 for none.
class TextReader {
public:
    TextReader(std::string_view text, std::string file, char comment)
        : begin_(text.data()),
          position_(text.data()),
          end_(text.data() + text.size()),
          file_(std::move(file)),
          comment_(comment) {}

    /// Skips the rest of the current line and moves to the first word of the next non-empty line. Returns false at the end of the
    /// text.
    bool next_line();
    /// Skips blanks, comments and line ends. Returns false at the end of the text.
    bool skip_space();
    /// True if there are no more words on the current line.
    bool line_done() {
        skip_blanks();
        return position_ == end_ || *position_ == '\n' || (comment_ != 0 && *position_ == comment_);
    }
    /// Reads the next word of the current line; empty if there is none.
    std::string_view word();
    /// The remaining text of the current line up to the line's end or a comment, without trailing blanks.
    std::string_view rest_of_line();

    /// Reads the next word of the current line as a number. Throws Error if the word is missing, malformed, too large for a
    /// double, infinite or NaN; `quantity` names the expected number in the message.
    double finite(const char* quantity);
    /// Reads the next word of the current line as a number that may be infinite or NaN (for colours, which their reader checks).
    double number(const char* quantity);
    /// Reads the next word of the current line as a 64-bit integer.
    std::int64_t integer(const char* quantity);
    /// Reads an integer at the current position; blanks before the integer are not skipped, and any character may follow the
    /// integer.
    std::int64_t integer_part(const char* quantity);
    /// Consumes the next character if it is `c`, and returns true if so.
    bool take(char c) {
        if (position_ == end_ || *position_ != c) return false;
        ++position_;
        return true;
    }
    /// True if a digit or a sign is at the current position.
    [[nodiscard]] bool at_integer() const {
        return position_ != end_ && ((*position_ >= '0' && *position_ <= '9') || *position_ == '-' || *position_ == '+');
    }
    /// True if a word ends at the current position.
    [[nodiscard]] bool at_word_end() const { return position_ == end_ || is_blank(*position_) || *position_ == '\n'; }

    [[nodiscard]] const char* position() const { return position_; }
    void set_position(const char* position) { position_ = position; }
    /// Number of bytes left.
    [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - position_); }
    [[nodiscard]] const std::string& file() const { return file_; }

    /// Throws Error (input) with the file and the line at `position` (default: the current position).
    [[noreturn]] void fail(const std::string& problem, const std::string& remedy = {}, const char* position = nullptr) const;

    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

private:
    void skip_blanks() {
        while (position_ != end_ && is_blank(*position_)) ++position_;
    }
    void to_line_end();

    const char* begin_;
    const char* position_;
    const char* end_;
    std::string file_;
    char comment_;
    bool started_ = false;
    CancelCheck check_;
};

/// A word in quotes for a message: printable characters only, at most 40.
std::string in_quotes(std::string_view word);

/// The text of a file without the byte order mark of UTF-8 at its beginning.
inline std::string_view without_byte_order_mark(std::string_view bytes) {
    return bytes.starts_with("\xEF\xBB\xBF") ? bytes.substr(3) : bytes;
}

/// Replaces carriage returns by line feeds if the text has no line feeds, and a byte order mark by blanks.
void normalise_text(std::string& text);

}  // namespace ostraka::io
