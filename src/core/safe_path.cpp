#include "ostraka/core/safe_path.h"

#include "ostraka/core/error.h"
#include "ostraka/core/words.h"

#include <algorithm>

namespace ostraka {

namespace {

thread_local const WriteScope* scope_of_thread = nullptr;

/// The target of the first dangling link in a resolved path; the path itself if it has none.
Path behind_dangling_link(const Path& place) {
    std::error_code code;
    Path begun;
    for (auto part = place.begin(); part != place.end(); ++part) {
        begun /= *part;
        if (!std::filesystem::is_symlink(begun, code)) continue;
        Path target = begun.parent_path() / std::filesystem::read_symlink(begun, code);
        while (++part != place.end()) target /= *part;
        return target;
    }
    return place;
}

}  // namespace

Path resolved(const Path& path) {
    constexpr int most_links = 40;
    std::error_code code;
    Path whole = std::filesystem::absolute(path, code);
    for (int links = 0; !code && links < most_links; ++links) {
        const Path place = std::filesystem::weakly_canonical(whole, code);
        if (code) return {};
        whole = behind_dangling_link(place);
        if (whole == place) return place.lexically_normal();
    }
    return {};
}

void require_file_name(const std::string& name, const std::string& where, const std::string& at) {
    if (name.find('\0') != std::string::npos)
        fail_input(where, "at " + at + ": the name holds a zero byte", "remove it from the name");
}

void require_plain_name(const std::string& name, const std::string& where, const std::string& at) {
    const bool is_plain = !name.empty() && name != "." && name != ".." && std::none_of(name.begin(), name.end(), [](char c) {
        return c == '/' || c == '\\' || static_cast<unsigned char>(c) < 32 || c == 127;
    });
    if (!is_plain)
        fail_input(where, "at " + at + ": '" + printable(name, 100) + "' is no name of a file",
                   "give a name without folders and control characters");
}

Path file_inside(const std::string& name, const Path& folder, const std::string& where, const std::string& at,
                 const std::string& whose, const std::string& remedy) {
    require_file_name(name, where, at);
    const Path path(name);
    if (path.is_absolute()) fail_input(where, "at " + at + ": '" + printable(name, 200) + "' is no relative name", remedy);
    const Path home = folder.empty() ? Path(".") : folder;
    if (name.empty() || *path.lexically_normal().begin() == ".." || !is_inside(home / path, home))
        fail_input(where, "at " + at + ": '" + printable(name, 200) + "' leads out of " + whose, remedy);
    return folder / path;
}

bool is_inside(const Path& path, const Path& folder) {
    const Path place = resolved(path), home = resolved(folder.empty() ? Path(".") : folder);
    if (place.empty() || home.empty()) return false;
    const Path relative = place.lexically_relative(home);
    return !relative.empty() && *relative.begin() != "..";
}

bool is_inside_any(const Path& path, const std::vector<Path>& folders) {
    return std::any_of(folders.begin(), folders.end(), [&](const Path& folder) { return is_inside(path, folder); });
}

void require_writable_inside(const Path& file, const Path& folder) {
    if (is_memory(file)) return;
    const std::string remedy = "remove it, or name another folder";
    if (!is_inside(file, folder)) fail_input(file.string(), "is a link that leads out of '" + folder.string() + "'", remedy);
    std::error_code code;
    const auto type = std::filesystem::status(file, code).type();
    using Type = std::filesystem::file_type;
    if (type != Type::not_found && type != Type::regular && type != Type::directory && type != Type::none)
        fail_input(file.string(), "is a device or a pipe", remedy);
}

WriteScope::WriteScope(Path folder) : folder_(std::move(folder)), outer_(scope_of_thread) { scope_of_thread = this; }
WriteScope::~WriteScope() { scope_of_thread = outer_; }

const WriteScope* WriteScope::current() { return scope_of_thread; }
WriteScope::Within::Within(const WriteScope* scope) : outer_(scope_of_thread) { scope_of_thread = scope; }
WriteScope::Within::~Within() { scope_of_thread = outer_; }

void WriteScope::check(const Path& file) {
    if (scope_of_thread != nullptr) require_writable_inside(file, scope_of_thread->folder_);
}

}  // namespace ostraka
