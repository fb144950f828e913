// Lines of numbers.
#include "point_cloud/cloud_formats.h"

#include "ostraka/core/text.h"

#include <algorithm>
#include <charconv>
#include <limits>

namespace ostraka::clouds {

namespace {

bool is_separator(char c) { return c == ' ' || c == '\t' || c == ';' || c == '\r' || c == '\v' || c == '\f' || c == ','; }

/// Parses the number at `position` and moves behind it; false if there is none.
bool number_at(const char*& position, const char* end, double& value) {
    if (*position == '+' && position + 1 != end) ++position;
    auto [stop, code] = std::from_chars(position, end, value);
    if (code == std::errc::result_out_of_range) {  // an underflow counts as zero, an overflow as not finite
        long double wide = 0;
        const auto result = std::from_chars(position, end, wide);
        value = result.ec == std::errc() ? static_cast<double>(wide) : std::numeric_limits<double>::infinity();
        stop = result.ptr;
    } else if (code != std::errc()) {
        return false;
    }
    position = stop;
    return true;
}

}  // namespace

CloudLines::CloudLines(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {
    if (text_.starts_with("\xEF\xBB\xBF")) position_ = 3;
}

bool CloudLines::next() {
    while (position_ < text_.size()) {
        std::size_t end = text_.find_first_of("\r\n", position_);
        if (end == std::string_view::npos) end = text_.size();
        line_ = trimmed(text_.substr(position_, end - position_));
        const bool is_pair = end + 1 < text_.size() && text_[end] == '\r' && text_[end + 1] == '\n';
        position_ = std::min(end + (is_pair ? 2 : 1), text_.size());
        ++number_;
        if (!line_.empty()) return true;
    }
    line_ = {};
    return false;
}

std::string CloudLines::place() const { return file_ + ", line " + std::to_string(number_); }

bool CloudLines::numbers(std::vector<double>& values, bool decimal_comma) {
    values.clear();
    std::string replaced;
    std::string_view line = line_;
    if (decimal_comma) {
        replaced = line_;
        for (char& c : replaced)
            if (c == ',') c = '.';
        line = replaced;
    }
    const char *position = line.data(), *end = position + line.size();
    while (true) {
        while (position != end && is_separator(*position)) ++position;
        if (position == end) return true;
        double value = 0;
        if (!number_at(position, end, value)) return false;
        if (position != end && !is_separator(*position)) return false;
        values.push_back(value);
        if (values.size() > 1000) return false;
    }
}

}  // namespace ostraka::clouds
