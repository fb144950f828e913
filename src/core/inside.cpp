#include "ostraka/core/inside.h"

#include "ostraka/core/error.h"

namespace ostraka {

void require_file_name(const std::string& name, const std::string& where, const std::string& at) {
    if (name.find('\0') != std::string::npos)
        fail_input(where, "at " + at + ": the name holds a character that no file name can", "mend it");
}

Path file_inside(const std::string& name, const Path& folder, const std::string& where, const std::string& at,
                 const std::string& whose, const std::string& remedy) {
    require_file_name(name, where, at);
    const Path path(name);
    const Path home_folder = folder.empty() ? Path(".") : folder;
    if (path.is_absolute()) fail_input(where, "at " + at + ": '" + name + "' is no relative name", remedy);
    const auto within = [](const Path& inner, const Path& outer) {
        const Path relative = inner.lexically_relative(outer);
        return !relative.empty() && *relative.begin() != "..";
    };
    std::error_code code, other;
    const Path home = std::filesystem::weakly_canonical(std::filesystem::absolute(home_folder), code);
    const Path place = std::filesystem::weakly_canonical(std::filesystem::absolute(home_folder / path), other);
    if (name.empty() || *path.lexically_normal().begin() == ".." || code || other || !within(place, home))
        fail_input(where, "at " + at + ": '" + name + "' leads out of " + whose, remedy);
    return folder / path;
}

}  // namespace ostraka
