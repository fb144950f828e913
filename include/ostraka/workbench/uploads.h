// Files that a page sends to the session, before an operation reads them (doc/workbench.md, "Scans dropped onto the page").
#pragma once

#include "ostraka/files/file.h"

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

/// Limits of uploads.
struct UploadLimits {
    std::size_t files = 2000;                    ///< max number of files sent together
    std::uintmax_t file_bytes = 4'000'000'000;   ///< max size of a file
    std::uintmax_t total_bytes = 8'000'000'000;  ///< max size of files sent together
    std::uintmax_t free_bytes = 500'000'000;     ///< space that must remain on the disk
};

/// A file that a page announces.
struct AnnouncedFile {
    std::string name;         ///< path below the folder of the files sent together, with '/'
    std::uintmax_t size = 0;  ///< size in bytes
};

/// The folder "uploads" of a session. Files sent together are in one folder of it. All functions may be called from any thread.
class Uploads {
public:
    /// `session`: folder of the session.
    explicit Uploads(const Path& session, const UploadLimits& limits = {});

    /// Announces files that are sent together, and makes their folder. Returns its name, such as "u001". Throws Error (usage) for
    /// names that are not plain relative paths or are given twice; Error (input) if the files are too many or too large; Error
    /// (failure) if the disk has not enough space.
    std::string announce(const std::vector<AnnouncedFile>& files);

    /// A file to be received.
    struct Receiving {
        Path path;
        std::uintmax_t size = 0;
    };
    /// Begins to receive an announced file; none if it was not announced, or has begun before.
    std::optional<Receiving> begin(std::string_view batch, std::size_t file);

    /// Path of a received file in the folder of a session. Throws Error (usage) if there is no such file.
    static Path path_of(const Path& session, const std::string& batch, const std::string& name);
    /// Whether the text is the name of a folder of files sent together.
    static bool is_batch(std::string_view name);

private:
    Path folder_;
    UploadLimits limits_;
    std::mutex mutex_;
    std::map<std::string, std::vector<std::optional<Receiving>>, std::less<>> announced_;  ///< files not begun yet
    std::size_t last_ = 0;                                                                 ///< number of the last folder
};

/// Indices of the announced files that `import` reads as scans: meshes and point clouds. Text files count as point clouds only if
/// there is no other scan, since folders of scans hold notes too.
std::vector<std::size_t> scans_among(const std::vector<AnnouncedFile>& files);

}  // namespace ostraka
