// Zip archives in memory, read with minizip.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace ostraka::io {

/// Reads the parts of a zip archive in memory. A part may be at most 100 times as large as the archive (64 MB in small archives):
/// larger ones are refused before they are unpacked, since they are made to exhaust memory.
class ZipArchive {
public:
    /// `bytes` must outlive this object. `file`: for messages. Throws Error (input) if the bytes are no zip archive.
    ZipArchive(std::string_view bytes, std::string file);

    /// True if the archive has a part of this name, in whatever case.
    [[nodiscard]] bool has(const std::string& part) const;
    /// Passes the content of a part to `consume`, piece by piece; `consume` returns false to stop. Throws Error (input) if the
    /// part is missing, damaged or too large.
    void stream(const std::string& part, const std::function<bool(std::string_view)>& consume) const;
    /// The content of a part of at most `max_bytes` bytes. Throws Error (input) likewise.
    [[nodiscard]] std::string read(const std::string& part, std::size_t max_bytes) const;

private:
    struct Reading;
    std::string_view bytes_;
    std::string file_;
    std::shared_ptr<Reading> reading_;
};

}  // namespace ostraka::io
