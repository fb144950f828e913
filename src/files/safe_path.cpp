#include "ostraka/files/safe_path.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

thread_local const WriteScope* scope_of_thread = nullptr;

/// The target of the first dangling link in a resolved path; the path itself if it has none.
Path target_of_dangling_link(const Path& canonical) {
    std::error_code code;
    Path prefix;
    for (auto component = canonical.begin(); component != canonical.end(); ++component) {
        prefix /= *component;
        if (!std::filesystem::is_symlink(prefix, code)) continue;
        Path target = prefix.parent_path() / std::filesystem::read_symlink(prefix, code);
        while (++component != canonical.end()) target /= *component;
        return target;
    }
    return canonical;
}

}  // namespace

Path resolved(const Path& path) {
    constexpr int max_links = 40;
    std::error_code code;
    Path current = std::filesystem::absolute(path, code);
    for (int links = 0; !code && links < max_links; ++links) {
        const Path canonical = std::filesystem::weakly_canonical(current, code);
        if (code) return {};
        current = target_of_dangling_link(canonical);
        if (current == canonical) return canonical.lexically_normal();
    }
    return {};
}

void require_file_name(const std::string& name, const std::string& where, const std::string& location) {
    if (name.find('\0') != std::string::npos)
        fail_input(where, fmt::format("at {}: the name contains a zero byte", location), "remove it from the name");
}

void require_plain_name(const std::string& name, const std::string& where, const std::string& location) {
    const bool is_plain = !name.empty() && name != "." && name != ".." && std::none_of(name.begin(), name.end(), [](char c) {
        return c == '/' || c == '\\' || static_cast<unsigned char>(c) < 32 || c == 127;
    });
    if (!is_plain)
        fail_input(where, fmt::format("at {}: '{}' is not a file name", location, printable(name, 100)),
                   "give a name without folders and control characters");
}

Path file_inside(const std::string& name, const Path& folder, const std::string& where, const std::string& location,
                 const std::string& folder_description, const std::string& remedy) {
    require_file_name(name, where, location);
    const Path path(name);
    if (path.is_absolute())
        fail_input(where, fmt::format("at {}: '{}' is not a relative path", location, printable(name, 200)), remedy);
    const Path home = folder.empty() ? Path(".") : folder;
    if (name.empty() || *path.lexically_normal().begin() == ".." || !is_inside(home / path, home))
        fail_input(where, fmt::format("at {}: '{}' leads out of {}", location, printable(name, 200), folder_description), remedy);
    return folder / path;
}

bool is_inside(const Path& path, const Path& folder) {
    const Path canonical = resolved(path), home = resolved(folder.empty() ? Path(".") : folder);
    if (canonical.empty() || home.empty()) return false;
    const Path relative = canonical.lexically_relative(home);
    return !relative.empty() && *relative.begin() != "..";
}

bool is_inside_any(const Path& path, const std::vector<Path>& folders) {
    return std::any_of(folders.begin(), folders.end(), [&](const Path& folder) { return is_inside(path, folder); });
}

void require_writable_inside(const Path& file, const Path& folder) {
    if (is_memory(file)) return;
    const std::string remedy = "remove it, or choose another folder";
    if (!is_inside(file, folder))
        fail_input(file.string(), fmt::format("is a link that leads out of '{}'", folder.string()), remedy);
    std::error_code code;
    const auto type = std::filesystem::status(file, code).type();
    using Type = std::filesystem::file_type;
    if (type != Type::not_found && type != Type::regular && type != Type::directory && type != Type::none)
        fail_input(file.string(), "is a device or a pipe", remedy);
}

WriteScope::WriteScope(Path folder) : folder_(std::move(folder)), outer_(scope_of_thread) { scope_of_thread = this; }
WriteScope::~WriteScope() { scope_of_thread = outer_; }

const WriteScope* WriteScope::current() { return scope_of_thread; }
WriteScope::ScopeGuard::ScopeGuard(const WriteScope* scope) : outer_(scope_of_thread) { scope_of_thread = scope; }
WriteScope::ScopeGuard::~ScopeGuard() { scope_of_thread = outer_; }

void WriteScope::check(const Path& file) {
    if (scope_of_thread != nullptr) require_writable_inside(file, scope_of_thread->folder_);
}

}  // namespace ostraka
