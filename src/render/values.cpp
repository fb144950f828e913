#include "ostraka/render/values.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/files/npy.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <limits>

namespace ostraka {

namespace {
std::vector<double> parse_npy(std::string_view bytes, const std::string& where) {
    const NpyView view = view_npy(bytes, where);
    if (view.columns() != 1)
        fail_input(where, fmt::format("contains an array of {} columns", view.columns()),
                   "save a one-dimensional array with one number per element");
    std::vector<double> values(view.count());
    view.copy_to(values.data());
    return values;
}

std::vector<double> parse_lines(std::string_view text, const std::string& where) {
    std::vector<double> values;
    std::size_t line = 0;
    while (!text.empty()) {
        ++line;
        const auto end = text.find('\n');
        std::string_view words = trimmed(text.substr(0, end));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (words.empty() || words.front() == '#') continue;
        if (words.front() == '+') words.remove_prefix(1);
        double value = 0;
        const auto [parse_end, code] = std::from_chars(words.data(), words.data() + words.size(), value);
        if (parse_end != words.data() + words.size() || (code != std::errc() && code != std::errc::result_out_of_range))
            fail_input(fmt::format("{}, line {}", where, line), "is not a single number",
                       "write one number per line, nan where there is no value");
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
    if (extension(file) == ".npy") {
        (void)write_npy(file, values, {values.size()});
        return;
    }
    std::string bytes;
    char text[32];
    for (const double value : values) {
        if (std::isnan(value)) bytes += "nan";
        else bytes.append(text, std::to_chars(text, text + sizeof text, value).ptr);
        bytes += '\n';
    }
    write_file(file, bytes);
}

}  // namespace ostraka
