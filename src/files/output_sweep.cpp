#include "files/output_sweep.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/files/safe_path.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t sum_length = 64;

/// Whether the name is a single path component without line breaks.
bool is_plain_name(const std::string& name) {
    return !name.empty() && name != "." && name != ".." && name.find_first_of(std::string("/\\\n\0", 4)) == std::string::npos;
}

/// Reads lines "SHA-256, two blanks, name"; other lines are ignored.
std::map<std::string, std::string> read_list(const Path& list_file) {
    std::map<std::string, std::string> entries;
    std::error_code code;
    if (!fs::is_regular_file(list_file, code)) return entries;
    std::string text;
    try {
        text = read_file(list_file);
    } catch (const Error&) {
        return entries;
    }
    for (std::size_t position = 0; position < text.size();) {
        const std::string line(line_at(text, position));
        if (line.size() > sum_length + 2 && line.compare(sum_length, 2, "  ") == 0 && is_plain_name(line.substr(sum_length + 2)))
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

OutputSweep::OutputSweep(const Path& folder, const std::string& owner, const std::vector<std::pair<Path, Path>>& pending,
                         const std::vector<Path>& kept_inputs)
    : folder_(folder), list_(folder / (fmt::format(".{}.outputs", owner))) {
    std::error_code code;
    for (const auto& [temporary, file] : pending) {
        const Path parent = file.has_parent_path() ? file.parent_path() : Path(".");
        const std::string name = file.filename().string();
        if (is_plain_name(name) && fs::equivalent(parent, folder_, code)) written_[name] = sha256_of_file(temporary);
    }
    for (const auto& [name, sum] : read_list(list_)) {
        const Path file = folder_ / name;
        const bool is_kept = std::any_of(kept_inputs.begin(), kept_inputs.end(),
                                         [&](const Path& kept_file) { return fs::equivalent(kept_file, file, code); });
        if (!written_.contains(name) && !is_kept && is_unchanged(file, sum)) obsolete_[name] = sum;
    }
}

std::string OutputSweep::text() const {
    std::string text;
    for (const auto* entries : {&written_, &obsolete_})
        for (const auto& [name, sum] : *entries) text += fmt::format("{}  {}\n", sum, name);
    return text;
}

void OutputSweep::write_list() const {
    std::error_code code;
    if (written_.empty() && !fs::exists(list_, code)) return;
    require_writable_inside(list_, folder_);
    write_file(list_, text());
}

void OutputSweep::remove_obsolete() {
    if (obsolete_.empty()) return;
    std::error_code code;
    for (const auto& [name, sum] : obsolete_) fs::remove(folder_ / name, code);
    obsolete_.clear();
    OutputTransaction transaction;
    write_file(list_, text());
    transaction.commit();
}

}  // namespace ostraka
