// Paths found in files that somebody else may have written: they never lead out of the folders that the user named
// (doc/security.md).
#pragma once

#include "ostraka/core/file.h"

#include <string>
#include <vector>

namespace ostraka {

/// Throws Error (input) for a name that holds a zero byte, which no file can have. `where` is the file, `at` the place in it.
void require_file_name(const std::string& name, const std::string& where, const std::string& at);

/// Throws Error (input) unless `name` is one component of a path: not empty, "." or "..", without separators and control
/// characters.
void require_plain_name(const std::string& name, const std::string& where, const std::string& at);

/// Where `name`, found in a file of `folder`, leads. Throws Error (input) with `remedy` unless that is within the folder, also
/// over links: no absolute name, and none that climbs out of it. `whose` is the folder in the message.
Path file_inside(const std::string& name, const Path& folder, const std::string& where, const std::string& at,
                 const std::string& whose, const std::string& remedy);

/// The absolute path with links resolved, also those that lead to nothing yet: writing to one makes what it names. Empty where
/// that fails (a circle of links).
Path resolved(const Path& path);

/// Whether the path, links resolved, is the folder or lies in it. The path need not exist. False where it cannot be resolved.
bool is_inside(const Path& path, const Path& folder);
bool is_inside_any(const Path& path, const std::vector<Path>& folders);

/// Throws Error (input) where writing to `file` would leave `folder` over a link, or would write to a device or a pipe.
void require_writable_inside(const Path& file, const Path& folder);

/// While it lives, files and folders are made on this thread, and in parallel loops that it starts, within `folder` only, links
/// resolved: others are refused with Error (input). For work on folders that somebody else may have filled with links.
class WriteScope {
public:
    explicit WriteScope(Path folder);
    ~WriteScope();
    WriteScope(const WriteScope&) = delete;
    WriteScope& operator=(const WriteScope&) = delete;

    /// That of this thread, or none.
    static const WriteScope* current();
    /// Makes it (or none) that of this thread as long as the other one lives.
    class Within {
    public:
        explicit Within(const WriteScope* scope);
        ~Within();
        Within(const Within&) = delete;
        Within& operator=(const Within&) = delete;

    private:
        const WriteScope* outer_;
    };
    /// Throws Error (input) where the file would lie outside of the scope of this thread.
    static void check(const Path& file);

private:
    Path folder_;
    const WriteScope* outer_;
};

}  // namespace ostraka
