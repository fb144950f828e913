#include "text_reader.h"

#include "ostraka/core/error.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace ostraka::io {

void TextReader::to_line_end() {
    const void* found = position_ == end_ ? nullptr : std::memchr(position_, '\n', remaining());
    position_ = found == nullptr ? end_ : static_cast<const char*>(found);
}

bool TextReader::next_line() {
    if (started_) to_line_end();
    started_ = true;
    return skip_space();
}

bool TextReader::skip_space() {
    check_();
    started_ = true;
    for (;;) {
        skip_blanks();
        if (position_ == end_) return false;
        if (*position_ == '\n') ++position_;
        else if (comment_ != 0 && *position_ == comment_) to_line_end();
        else return true;
    }
}

std::string_view TextReader::word() {
    if (line_done()) return {};
    const char* first = position_;
    while (!at_word_end() && !(comment_ != 0 && *position_ == comment_)) ++position_;
    return {first, static_cast<std::size_t>(position_ - first)};
}

std::string_view TextReader::rest_of_line() {
    skip_blanks();
    const char* first = position_;
    while (!line_done()) word();
    const char* last = position_;
    while (last != first && is_blank(last[-1])) --last;
    return {first, static_cast<std::size_t>(last - first)};
}

double TextReader::number(const char* what) {
    if (line_done()) fail(std::string("the line ends where ") + what + " is expected", "the file may be cut off or damaged");
    const char* first = position_;
    if (*position_ == '+' && remaining() > 1 && position_[1] != '-') ++position_;
    double value = 0;
    auto [stop, code] = std::from_chars(position_, end_, value);
    if (code == std::errc::result_out_of_range) {
        // An underflow counts as zero; an overflow is no valid coordinate.
        long double wide = 0;
        const auto again = std::from_chars(position_, end_, wide);
        if (again.ec != std::errc() || std::fabs(wide) > static_cast<long double>(std::numeric_limits<double>::max())) {
            position_ = first;
            fail(std::string(what) + " " + in_quotes(word()) + " is out of the range of a double", "correct or rescale it",
                 first);
        }
        value = static_cast<double>(wide);
        stop = again.ptr;
        code = {};
    }
    const char* parsed = position_;
    position_ = stop;
    if (code != std::errc() || stop == parsed || !(at_word_end() || (comment_ != 0 && *position_ == comment_))) {
        position_ = first;
        fail(std::string(what) + " " + in_quotes(word()) + " is not a number", {}, first);
    }
    return value;
}

double TextReader::finite(const char* what) {
    skip_blanks();
    const char* first = position_;
    const double value = number(what);
    if (!std::isfinite(value)) {
        position_ = first;
        fail(std::string(what) + " " + in_quotes(word()) + " is not finite", "correct or remove the element", first);
    }
    return value;
}

std::int64_t TextReader::integer_part(const char* what) {
    const char* first = position_;
    if (position_ != end_ && *position_ == '+' && remaining() > 1 && position_[1] != '-') ++position_;
    std::int64_t value = 0;
    const auto [stop, code] = std::from_chars(position_, end_, value);
    if (code != std::errc()) {
        position_ = first;
        fail(std::string(what) + " " + in_quotes(word()) + " is not a whole number that fits 64 bits", {}, first);
    }
    position_ = stop;
    return value;
}

std::int64_t TextReader::integer(const char* what) {
    if (line_done()) fail(std::string("the line ends where ") + what + " is expected", "the file may be cut off or damaged");
    const char* first = position_;
    const std::int64_t value = integer_part(what);
    if (!at_word_end() && !(comment_ != 0 && *position_ == comment_)) {
        position_ = first;
        fail(std::string(what) + " " + in_quotes(word()) + " is not a whole number", {}, first);
    }
    return value;
}

void TextReader::fail(const std::string& what, const std::string& remedy, const char* at) const {
    if (at == nullptr) at = position_;
    // Continued lines are counted: their line feeds were replaced by vertical tabs.
    const auto line = 1 + std::count_if(begin_, at, [](char c) { return c == '\n' || c == '\v'; });
    fail_input(file_ + ", line " + std::to_string(line), what, remedy);
}

std::string in_quotes(std::string_view word) {
    std::string text = "'";
    for (const char c : word.substr(0, 40)) text += c >= 32 && c < 127 ? c : '?';
    if (word.size() > 40) text += "...";
    return text + "'";
}

void normalise_text(std::string& text) {
    if (text.compare(0, 3, "\xEF\xBB\xBF") == 0) text.replace(0, 3, "   ");
    if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
}

}  // namespace ostraka::io
