#include "workflow/file_pattern.h"

#include "ostraka/core/progress.h"

#include <fnmatch.h>

#include <algorithm>
#include <set>

namespace ostraka {

Path before_wildcards(const Path& pattern) {
    Path folder;
    for (const Path& part : pattern) {
        if (part.string().find_first_of("*?[") != std::string::npos) break;
        folder /= part;
    }
    return folder.empty() ? Path(".") : folder;
}

namespace {

/// Sorted names in a folder that match the pattern.
std::vector<std::string> fitting_names(const Path& folder, const std::string& pattern) {
    std::vector<std::string> names;
    std::error_code code;
    for (std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, code), end; !code && entry != end;
         entry.increment(code)) {
        std::string name = entry->path().filename().string();
        if (!name.starts_with('.') && ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0) names.push_back(std::move(name));
    }
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

std::vector<Path> matching_files(const Path& pattern, const std::function<bool(const Path&)>& may_enter) {
    std::vector<Path> matches{pattern.root_path()};
    const auto is_pattern = [](const std::string& part) { return part.find_first_of("*?") != std::string::npos; };
    const Path relative = pattern.relative_path();
    std::size_t remaining_parts = static_cast<std::size_t>(std::distance(relative.begin(), relative.end()));
    for (const Path& part : relative) {
        --remaining_parts;
        std::vector<Path> next;
        std::set<Path> searched_folders;  // folders with links resolved, so that each is searched once
        for (const Path& folder : matches) {
            check_cancelled();
            if (!is_pattern(part.string())) {
                next.push_back(folder / part);
                continue;
            }
            for (const std::string& name : fitting_names(folder, part.string())) {
                const Path path = folder / name;
                std::error_code code;
                if (remaining_parts == 0 ? std::filesystem::is_regular_file(path, code)
                                         : std::filesystem::is_directory(path, code) && (!may_enter || may_enter(path)) &&
                                               searched_folders.insert(std::filesystem::weakly_canonical(path, code)).second)
                    next.push_back(path);
            }
        }
        matches = std::move(next);
    }
    std::erase_if(matches, [](const Path& file) { return !file_exists(file); });
    std::sort(matches.begin(), matches.end());
    return matches;
}

}  // namespace ostraka
