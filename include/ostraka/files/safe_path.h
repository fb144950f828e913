// Checks of paths read from files of unknown origin, so that such paths never lead out of the folders that the user named
// (doc/security.md).
#pragma once

#include "ostraka/files/file.h"

#include <string>
#include <vector>

namespace ostraka {

/// Throws Error (input) for a name with a zero byte, which no file can have. For the message: `where` is the file that contains
/// the name, `location` the position in that file.
void require_file_name(const std::string& name, const std::string& where, const std::string& location);

/// Throws Error (input) unless `name` is a single path component: not empty, not "." or "..", without separators and control
/// characters.
void require_plain_name(const std::string& name, const std::string& where, const std::string& location);

/// The path of `name`, which was read from a file in `folder`. Throws Error (input) with `remedy` if the name is absolute or
/// leads out of the folder, also through links. `folder_description` describes the folder in the message.
Path file_inside(const std::string& name, const Path& folder, const std::string& where, const std::string& location,
                 const std::string& folder_description, const std::string& remedy);

/// The absolute path with all links resolved, including dangling links (writing to a dangling link creates its target). The
/// result is empty if links form a cycle.
Path resolved(const Path& path);

/// True if the path, after resolving links, is the folder or lies inside the folder. The path need not exist; a path that cannot
/// be resolved gives false.
bool is_inside(const Path& path, const Path& folder);
/// True if the path lies inside at least one of the folders.
bool is_inside_any(const Path& path, const std::vector<Path>& folders);

/// Throws Error (input) if writing to `file` would leave `folder` through a link, or would write to a device or a pipe.
void require_writable_inside(const Path& file, const Path& folder);

/// Restricts writing to one folder. During the lifetime of this object, this thread and the parallel loops that it starts may
/// create files and folders only inside `folder` (after resolving links); creating any other file throws Error (input). Use a
/// WriteScope when writing to folders of unknown origin, which may contain links.
class WriteScope {
public:
    explicit WriteScope(Path folder);
    ~WriteScope();
    WriteScope(const WriteScope&) = delete;
    WriteScope& operator=(const WriteScope&) = delete;

    /// The WriteScope of this thread; null if there is none.
    static const WriteScope* current();
    /// Sets the scope of this thread (null: none) during the lifetime of this object.
    class ScopeGuard {
    public:
        explicit ScopeGuard(const WriteScope* scope);
        ~ScopeGuard();
        ScopeGuard(const ScopeGuard&) = delete;
        ScopeGuard& operator=(const ScopeGuard&) = delete;

    private:
        const WriteScope* outer_;
    };
    /// Throws Error (input) if the file lies outside the scope of this thread.
    static void check(const Path& file);

private:
    Path folder_;
    const WriteScope* outer_;
};

}  // namespace ostraka
