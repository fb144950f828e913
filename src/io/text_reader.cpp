#include "io/text_reader.h"

#include "ostraka/core/error.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace ostraka::io {

void TextReader::to_line_end() {
    const void* line_end = position_ == end_ ? nullptr : std::memchr(position_, '\n', remaining());
    position_ = line_end == nullptr ? end_ : static_cast<const char*>(line_end);
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

double TextReader::number(const char* quantity) {
    if (line_done()) fail(fmt::format("the line ends where {} is expected", quantity), "the file may be cut off or damaged");
    const char* first = position_;
    if (*position_ == '+' && remaining() > 1 && position_[1] != '-') ++position_;
    double value = 0;
    auto [stop, code] = std::from_chars(position_, end_, value);
    if (code == std::errc::result_out_of_range) {
        // An underflow counts as zero; an overflow is no valid coordinate.
        long double wide_value = 0;
        const auto wide_result = std::from_chars(position_, end_, wide_value);
        if (wide_result.ec != std::errc() ||
            std::fabs(wide_value) > static_cast<long double>(std::numeric_limits<double>::max())) {
            position_ = first;
            fail(fmt::format("{} {} is out of the range of a double", quantity, in_quotes(word())), "correct or rescale it",
                 first);
        }
        value = static_cast<double>(wide_value);
        stop = wide_result.ptr;
        code = {};
    }
    const char* parsed = position_;
    position_ = stop;
    if (code != std::errc() || stop == parsed || !(at_word_end() || (comment_ != 0 && *position_ == comment_))) {
        position_ = first;
        fail(fmt::format("{} {} is not a number", quantity, in_quotes(word())), {}, first);
    }
    return value;
}

double TextReader::finite(const char* quantity) {
    skip_blanks();
    const char* first = position_;
    const double value = number(quantity);
    if (!std::isfinite(value)) {
        position_ = first;
        fail(fmt::format("{} {} is not finite", quantity, in_quotes(word())), "correct or remove the element", first);
    }
    return value;
}

std::int64_t TextReader::integer_part(const char* quantity) {
    const char* first = position_;
    if (position_ != end_ && *position_ == '+' && remaining() > 1 && position_[1] != '-') ++position_;
    std::int64_t value = 0;
    const auto [stop, code] = std::from_chars(position_, end_, value);
    if (code != std::errc()) {
        position_ = first;
        fail(fmt::format("{} {} is not a whole number that fits 64 bits", quantity, in_quotes(word())), {}, first);
    }
    position_ = stop;
    return value;
}

std::int64_t TextReader::integer(const char* quantity) {
    if (line_done()) fail(fmt::format("the line ends where {} is expected", quantity), "the file may be cut off or damaged");
    const char* first = position_;
    const std::int64_t value = integer_part(quantity);
    if (!at_word_end() && !(comment_ != 0 && *position_ == comment_)) {
        position_ = first;
        fail(fmt::format("{} {} is not a whole number", quantity, in_quotes(word())), {}, first);
    }
    return value;
}

void TextReader::fail(const std::string& problem, const std::string& remedy, const char* position) const {
    if (position == nullptr) position = position_;
    // Continued lines are counted: their line feeds were replaced by vertical tabs.
    const auto line = 1 + std::count_if(begin_, position, [](char c) { return c == '\n' || c == '\v'; });
    fail_input(fmt::format("{}, line {}", file_, line), problem, remedy);
}

std::string in_quotes(std::string_view word) {
    std::string text = "'";
    for (const char c : word.substr(0, 40)) text += c >= 32 && c < 127 ? c : '?';
    if (word.size() > 40) text += "...";
    return text + "'";
}

void normalise_text(std::string& text) {
    if (without_byte_order_mark(text).size() < text.size()) text.replace(0, 3, "   ");
    if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
}

}  // namespace ostraka::io
