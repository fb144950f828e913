#include "output_sweep.h"

#include "ostraka/core/error.h"
#include "ostraka/core/safe_path.h"
#include "ostraka/core/text.h"

#include <algorithm>

namespace ostraka {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t sum_length = 64;

/// Whether the name is a single path component without line breaks.
bool plain(const std::string& name) {
    return !name.empty() && name != "." && name != ".." && name.find_first_of(std::string("/\\\n\0", 4)) == std::string::npos;
}

/// Reads lines "SHA-256, two blanks, name"; other lines are ignored.
std::map<std::string, std::string> read_list(const Path& list) {
    std::map<std::string, std::string> entries;
    std::error_code code;
    if (!fs::is_regular_file(list, code)) return entries;
    std::string text;
    try {
        text = read_file(list);
    } catch (const Error&) {
        return entries;
    }
    for (std::size_t at = 0; at < text.size();) {
        const std::string line(line_at(text, at));
        if (line.size() > sum_length + 2 && line.compare(sum_length, 2, "  ") == 0 && plain(line.substr(sum_length + 2)))
            entries[line.substr(sum_length + 2)] = line.substr(0, sum_length);
    }
    return entries;
}

bool is_unchanged(const Path& file, const std::string& sum) {
    std::error_code code;
    if (fs::symlink_status(file, code).type() != fs::file_type::regular) return false;
    try {
        return sha256_of_file(file) == sum;
    } catch (const Error&) {
        return false;
    }
}

}  // namespace

OutputSweep::OutputSweep(const Path& folder, const std::string& owner, const std::vector<std::pair<Path, Path>>& waiting,
                         const std::vector<Path>& kept)
    : folder_(folder), list_(folder / ("." + owner + ".outputs")) {
    std::error_code code;
    for (const auto& [temporary, file] : waiting) {
        const Path parent = file.has_parent_path() ? file.parent_path() : Path(".");
        const std::string name = file.filename().string();
        if (plain(name) && fs::equivalent(parent, folder_, code)) now_[name] = sha256_of_file(temporary);
    }
    for (const auto& [name, sum] : read_list(list_)) {
        const Path file = folder_ / name;
        const bool stays =
            std::any_of(kept.begin(), kept.end(), [&](const Path& one) { return fs::equivalent(one, file, code); });
        if (!now_.contains(name) && !stays && is_unchanged(file, sum)) rest_[name] = sum;
    }
}

std::string OutputSweep::text() const {
    std::string text;
    for (const auto* list : {&now_, &rest_})
        for (const auto& [name, sum] : *list) text += sum + "  " + name + "\n";
    return text;
}

void OutputSweep::write_list() const {
    std::error_code code;
    if (now_.empty() && !fs::exists(list_, code)) return;
    require_writable_inside(list_, folder_);
    write_file(list_, text());
}

void OutputSweep::remove_rest() {
    if (rest_.empty()) return;
    std::error_code code;
    for (const auto& [name, sum] : rest_) fs::remove(folder_ / name, code);
    rest_.clear();
    OutputTransaction own;
    write_file(list_, text());
    own.commit();
}

}  // namespace ostraka
